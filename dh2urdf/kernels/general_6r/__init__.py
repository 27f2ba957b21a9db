"""Any arm of six turning joints: elimination, roots on arcs of the circle, Newton, a count.

`poses` is the solver, `arm` what it knows of an arm; `elimination` and `resultant` make a
polynomial in the hidden joint, `roots` and `arc_roots` find its real roots, `follow` and
`loop_angles` lead from a root to solutions.
"""

from dh2urdf.kernels.general_6r.poses import (
    Arm,
    plan_general_6r,
    replan_general_6r,
    solve_general_6r,
)
