"""Newton's method on the exact chain, and the residual that it works on.

`steps` bring candidates to the pose, `damped` are least squares for any number of joints and any
task, `lanes` is the same for six turning joints, many seeds side by side.
"""

from dh2urdf.kernels.newton.damped import (
    POSE,
    STAYING,
    add_transposed,
    error_and_jacobian,
    make_damped,
    restore,
    solve_damped,
)
from dh2urdf.kernels.newton.lanes import chain_frames, newton_step, pose_error
from dh2urdf.kernels.newton.steps import (
    MAX_TURN,
    POLISH,
    damped_step,
    factor,
    normal_equations,
    polish,
    pose_residual,
    substitute,
    turn_between,
    way_between,
    work_array,
)
