"""Six turning joints, axes 2 and 3 parallel, 4 meets 5 or 5 meets 6: one polynomial of degree 8.

`polynomial` has the arm's lines and the polynomial in joint 1, `branches` leads from a root to
seeds, `poses` is the solver.
"""

from dh2urdf.kernels.two_parallel.polynomial import TwoParallel
from dh2urdf.kernels.two_parallel.poses import solve_two_parallel
