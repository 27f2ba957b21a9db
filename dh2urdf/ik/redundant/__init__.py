"""Joints to spare: held at a value, swept, or free; arms that hardly move in some direction.

`held_values` picks the solver with joints held (`held_wrist` is the fastest one), `special_values`
are those at which it is another, `swept` solves at many values of one joint, `self_motion` moves
between them, `held_at_rest` holds idle joints, `searched` helps arms with weak directions.
"""

from dh2urdf.ik.redundant.held_at_rest import RedundantChain
from dh2urdf.ik.redundant.held_values import select_held
from dh2urdf.ik.redundant.searched import SearchedSolver, nearly_reaching
from dh2urdf.ik.redundant.self_motion import (
    MOST_MEMBERS,
    nearest_members,
    reach_intervals,
    run,
    sample_values,
    towards_seed,
)
from dh2urdf.ik.redundant.special_values import at_any_value
from dh2urdf.ik.redundant.swept import SweptJoint
