"""Any arm of six turning joints: elimination, roots on arcs of the circle, Newton, a count.

`poses` is the solver (after Raghavan and Roth 1993), `arm` the record on which everything works;
`elimination` and `resultant` make a polynomial in the hidden joint, `roots` finds its real roots
by `arc_samples` and `arc_roots`; `follow` leads from a root to solutions.
"""

from dh2urdf.kernels.general_6r.arc_samples import ARC
from dh2urdf.kernels.general_6r.arm import ARM_6R, MOST
from dh2urdf.kernels.general_6r.follow import SINGULAR, how_many_below, keep_lane, polish_lanes
from dh2urdf.kernels.general_6r.poses import Arms, finish_general_6r, solve_general_6r
from dh2urdf.kernels.general_6r.roots import PAIRS, add_roots, nudge, place_samples
