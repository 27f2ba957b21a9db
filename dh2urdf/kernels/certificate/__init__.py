"""The certificate: candidates of any solver become solutions of the exact chain, or nothing.

`newton` is Newton's method and the residual; `certify` accepts what reaches the target and keeps
each solution once; `singular_families` finds the joints that move freely; `finish` does the latter
for a pose and for a batch, and for what a solver of the reversed chain found, after it has united
solutions that the residual cannot tell apart (``FLAT``); `arrange` turns solutions to a seed.
`damped` and `numeric` are least squares from any start, `newton_6r` is Newton in lanes.
"""

from dh2urdf.kernels.certificate.arrange import measure_all, measure_and_sort, turn_to
from dh2urdf.kernels.certificate.certify import (
    ACCEPT,
    ANYWHERE,
    CLUSTER,
    ROUNDING,
    TWO_PI,
    copy_rows,
    finish_pose,
    is_known,
    move,
    principal,
    same,
    turn_inside,
)
from dh2urdf.kernels.certificate.damped import (
    POSE,
    add_transposed,
    error_and_jacobian,
    make_damped,
    restore,
    solve_damped,
)
from dh2urdf.kernels.certificate.finish import (
    finish_batch,
    finish_families,
    invert_pose,
    invert_poses,
    merge_families,
    reverse_joints,
    turn_back,
)
from dh2urdf.kernels.certificate.newton import (
    MAX_TURN,
    POLISH,
    normal_equations,
    polish,
    pose_residual,
    work_array,
)
from dh2urdf.kernels.certificate.newton_6r import chain_frames, newton_step, pose_error
from dh2urdf.kernels.certificate.numeric import find_solutions
from dh2urdf.kernels.certificate.singular_families import free_joints, null_direction
