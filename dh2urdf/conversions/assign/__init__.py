"""From joint axes to a DH table: the frame assignment of lecture notes section 4.

`assigned_table` is the whole, `frame_assignment` the steps: `axis_pairs` (the cases and their
common normal), `frame_directions`, `frame_ends` (frames 0 and n), `prismatic_axes`; `snap`
sets numbers right, `explain` says why, `convention` changes it.
"""

from dh2urdf.conversions.assign.assigned_table import (
    chain_to_dh,
    flip_signs,
    tidy_angle,
    tidy_length,
    tidy_origin,
)
from dh2urdf.conversions.assign.axis_pairs import AxisCase, classify
from dh2urdf.conversions.assign.convention import in_convention, to_convention
from dh2urdf.conversions.assign.explain import FrameStep, explain_frames
from dh2urdf.conversions.assign.frame_assignment import XRule, references
from dh2urdf.conversions.assign.snap import (
    Change,
    near_misses,
    snap_chain,
    snap_table,
    snap_tolerance,
)
