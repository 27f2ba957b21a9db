"""Numbers: elementary functions, trigonometric equations, lanes.

Read `elementary` first (sine and cosine, arctangent, ..., the same bits on every machine), then
`double_roots` (equations that closed forms end in, and when two roots are one), `trig`
(trigonometric polynomials), `circles` (two equations in two angles), `dual_quaternions`, `lanes`
(QR of many 6 x 6 systems side by side), `poses` (checks of many poses), `products` (of matrices).
"""

from dh2urdf.engine import entry, side_by_side
from dh2urdf.kernels.numbers.circles import circle_pair
from dh2urdf.kernels.numbers.double_roots import elbow_angle, linear_trig, root_of_gap
from dh2urdf.kernels.numbers.dual_quaternions import (
    dual_conjugate,
    dual_of_pose,
    dual_product,
    dual_times_joint,
)
from dh2urdf.kernels.numbers.elementary import asin, atan2, few_turns, hypot, sincos
from dh2urdf.kernels.numbers.lanes import COLUMN, LANES, null_vectors, reduce_columns, solve_upper
from dh2urdf.kernels.numbers.poses import any_family, first_bad_pose, is_pose, pad_solutions
from dh2urdf.kernels.numbers.products import multiply
from dh2urdf.kernels.numbers.trig import add_square, arctangent, trig_roots
