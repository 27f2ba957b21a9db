"""Any arm of six joints, two slides at most: elimination, roots on arcs, Newton, a count.

`poses` is the solver (after Raghavan and Roth 1993), `arm` the record on which everything works;
`elimination` and `resultant` make a polynomial in the hidden joint, `roots` finds its real roots
by `arc_samples` and `arc_roots`; `follow` leads from a root to solutions, which `listing` keeps
apart, and `trials` says when all are found. Where two joints slide `two_slides` is in place of
both eliminations, and `joints_of_slides` leads from its roots to seeds.
"""

from dh2urdf.kernels.general_6r.arc_samples import ARC, tables_of
from dh2urdf.kernels.general_6r.arm import ARM_6R, MOST, WORK, record, root_order, root_work
from dh2urdf.kernels.general_6r.elimination import (
    HALF_SQRT3,
    INV_SQRT3,
    SQRT2,
    invert,
    line_functions,
    reduce_right,
    right_coefficients,
)
from dh2urdf.kernels.general_6r.follow import keep_lane, polish_lanes
from dh2urdf.kernels.general_6r.listing import SINGULAR, at_root, how_many_below, list_solution
from dh2urdf.kernels.general_6r.poses import (
    Arms,
    finish_general_6r,
    make_ready,
    solve_general_6r,
    solve_pose,
)
from dh2urdf.kernels.general_6r.resultant import (
    LEFT,
    finish_reduction,
    outer_joints,
    reduce_half,
    split_pairs,
    two_joints,
)
from dh2urdf.kernels.general_6r.roots import PAIRS, add_roots, nudge, place_samples
from dh2urdf.kernels.general_6r.trials import (
    CROWDED,
    CROWDED_ATTEMPTS,
    begin_trial,
    is_last,
    roots_meet,
)
