"""Joints to spare: one of seven held or swept, and motions that leave the tool where it is.

`held_wrist` solves with a joint held, `held_wrist_blocks` does so for many poses side by side
(`held_wrist_load`, `held_wrist_arms` are its steps) and gathers the solutions of many values;
`self_motion` walks along solutions, `paths` shortens a path.
"""

from dh2urdf.kernels.redundant.held_wrist import points_on_curves, solve_held_wrist
from dh2urdf.kernels.redundant.held_wrist_blocks import gather_samples, solve_held_blocks
from dh2urdf.kernels.redundant.paths import onward, shorten
from dh2urdf.kernels.redundant.self_motion import enter_limits, nearest_members, walk_family
