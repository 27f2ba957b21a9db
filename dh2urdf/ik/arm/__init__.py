"""What is known of an arm before any pose: its axes, its limits, the solver that it gets.

`shared_tolerances` has thresholds that rooms share; `task` says what of a pose is asked, and how a
chain moves in it; `solver` what a solver is, `solver_order` picks one; `geometry` looks at axes,
`singular_families` at joints that move freely; `chains` makes chains of a chain, `limits` full
turns; `in_doubt` searches poses that a solver is not sure of; `given` checks what callers give.
"""

from dh2urdf.ik.arm.chains import hold, in_own_unit, lengths_in, part, without_end
from dh2urdf.ik.arm.geometry import AxisLines, DHForm, form_of, lines_of, pose_along, row_motion
from dh2urdf.ik.arm.given import as_configuration, as_tolerance, many_poses, one_pose
from dh2urdf.ik.arm.in_doubt import (
    WIDTH,
    drop_dull_members,
    far,
    from_starts,
    keep_known,
    keep_most_apart,
    keep_sharp,
    room_in_doubt,
    search_in_doubt,
    starts_of,
    unite_families,
)
from dh2urdf.ik.arm.limits import (
    TWO_PI,
    all_turns,
    inside,
    middle,
    near_ranges,
    plain_ranges,
    seed_gaps,
    turn_counts,
    turned_to,
)
from dh2urdf.ik.arm.shared_tolerances import (
    ACCEPT,
    ALMOST,
    FAMILY_RANK,
    INTERVAL_END,
    LIMIT_SLACK,
    NEAR,
    NEARLY_SINGULAR,
    NOISE_MOTION,
    NOMINAL,
    PATH_JUMP,
    REGULAR,
    SHARP,
    SLACK,
    SLACK_OF_NEAR,
    SLACK_OF_NOISE,
    SNAP,
    SPARE_RANK,
)
from dh2urdf.ik.arm.singular_families import Family, beside_seed, coupled, slide_to_seed
from dh2urdf.ik.arm.solver import (
    BRANCH_WORDS,
    NONE,
    BatchKernel,
    BranchWords,
    HeldSolver,
    IntArray,
    Others,
    Outputs,
    Room,
    Solver,
    SolverBase,
    branch_words_of,
)
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.arm.task import (
    TRIALS,
    Task,
    moving_joints,
    random_configurations,
    scaled_jacobian,
    spare_joints,
    task_error,
    task_jacobian,
    tips_at,
)
