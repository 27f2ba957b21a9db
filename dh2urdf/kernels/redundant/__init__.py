"""Joints to spare: one of seven held or swept, and motions that leave the tool where it is.

`held_wrist` solves with a joint held, and gathers the solutions of many values, `held_wrist_place`
says where its wrist is put; `held_wrist_blocks` solves many poses side by side, from what
`held_wrist_load` makes of them, `sweeps` one pose at many values; `self_motion` walks along
solutions, `starts` says from where and `nearest` where to, `one_family` which of them are on one,
`curves` finds all curves of them, `paths` shortens a path; `families` brings singular ones into
the limits.
"""

from dh2urdf.kernels.redundant.curves import DULL, add_curves
from dh2urdf.kernels.redundant.families import families_inside
from dh2urdf.kernels.redundant.held_wrist import gather_samples, repeat_pose, solve_held_wrist
from dh2urdf.kernels.redundant.held_wrist_blocks import solve_held_blocks
from dh2urdf.kernels.redundant.nearest import (
    INNER,
    MEMBERS,
    Starts,
    arrange_members,
    enter_all,
    nearest_of,
    spread,
    start_beside,
)
from dh2urdf.kernels.redundant.one_family import WELL, members_among, on_one_family
from dh2urdf.kernels.redundant.paths import onward, shorten
from dh2urdf.kernels.redundant.self_motion import HELD, nearest_members, walk_family
from dh2urdf.kernels.redundant.starts import MOST_STARTS, find_starts
from dh2urdf.kernels.redundant.sweeps import WALKED, sweep_pose
