"""Six turning joints, three neighbouring axes parallel: UR and its kin (Elias and Wen; EAIK).

`poses` is the solver: `plane` looks at the arm in the plane in which the three turn, and at what
rounding leaves where axis 5 is in line with them; `pairs` finds the joints outside them.
`blocks` is the same for the UR geometry, many poses side by side; `five` that for five joints.
"""

from dh2urdf.kernels.parallel_axes.blocks import solve_common_parallel
from dh2urdf.kernels.parallel_axes.five import solve_five_joints, solve_five_parallel
from dh2urdf.kernels.parallel_axes.pairs import outer_pairs
from dh2urdf.kernels.parallel_axes.plane import last_joint
from dh2urdf.kernels.parallel_axes.poses import (
    add_pairs,
    make_scratch,
    slope_of_last,
    solve_three_parallel,
)
