"""Arms whose last three axes meet: position, then orientation (Pieper 1968, lecture notes 8.3).

`poses` is the solver, with the wrist's ZYZ angles; `position_arm` puts the wrist centre by the
common three turning joints, `position_any` by any three that turn or slide. `common` is the same
for common arms, many poses side by side.
"""

from dh2urdf.kernels.spherical_wrist.common import solve_common_wrist
from dh2urdf.kernels.spherical_wrist.poses import (
    add_wrist,
    append_wrist,
    make_scratch,
    middle_angle,
    solve_wrist_arm,
)
from dh2urdf.kernels.spherical_wrist.position_any import elbow_on_axis, place_wrist
from dh2urdf.kernels.spherical_wrist.position_arm import (
    FREE,
    NICE,
    SHOULDER_FREE,
    UPPER_FREE,
    planar,
    tool_to_wrist,
)
