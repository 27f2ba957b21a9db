"""Arms nearly of a closed-form family, rounded or calibrated: the drawing's solutions are seeds.

`poses` is the solver; `beside` looks for solutions close to solutions, where singularities meet.
"""

from dh2urdf.kernels.nearly.beside import search_beside
from dh2urdf.kernels.nearly.poses import add_candidates, solve_near_parallel, solve_near_wrist
