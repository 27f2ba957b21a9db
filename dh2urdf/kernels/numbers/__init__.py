"""Numbers: how kernels are compiled, trigonometric equations, lanes.

Read `compiled` first (options of all kernels), then `trig` (equations that closed forms end in),
`circles` (two equations in two angles), `dual_quaternions`, `lanes` (QR of many 6 x 6 systems
side by side), `poses` (checks of many poses).
"""

from dh2urdf.kernels.numbers.circles import circle_pair
from dh2urdf.kernels.numbers.compiled import (
    block_kernel,
    helper_kernel,
    inlined_kernel,
    inner_kernel,
    kernel,
    lane_kernel,
)
from dh2urdf.kernels.numbers.dual_quaternions import (
    dual_conjugate,
    dual_of_pose,
    dual_product,
    dual_times_joint,
)
from dh2urdf.kernels.numbers.lanes import (
    COLUMN,
    LANES,
    MASK,
    entry_kernel,
    inlined,
    null_vectors,
    reduce_columns,
    solve_upper,
    vector_kernel,
)
from dh2urdf.kernels.numbers.poses import first_bad_pose, pad_solutions
from dh2urdf.kernels.numbers.trig import (
    add_square,
    arctangent,
    elbow_angle,
    linear_trig,
    root_of_gap,
    trig_roots,
)
