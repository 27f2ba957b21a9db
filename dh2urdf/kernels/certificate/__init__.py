"""The certificate: candidates of any solver become solutions of the exact chain, or nothing.

`certify` accepts what reaches the target and keeps each solution once; `finish` unites solutions
that the residual cannot tell apart (``FLAT``), finds the joints that move freely, for a pose, for
a batch and for what a solver of the reversed chain found, by the `walk` that families are named
for; `arrange` turns solutions to a seed; `numeric` searches from any start, `valley` along what
hardly moves the tool, in the singular vectors of `directions`; `together` turns joints that move
by values together.
"""

from dh2urdf.kernels.certificate.arrange import (
    arrange_near,
    arrange_plain,
    distance2,
    measure,
    measure_all,
    measure_and_sort,
    settle_on_bounds,
    swap,
    turn_all,
    turn_by,
    turn_one,
    turn_to,
)
from dh2urdf.kernels.certificate.certify import (
    ACCEPT,
    CLUSTER,
    EXACT,
    NO_JOINT,
    ROUNDING,
    TWO_PI,
    bring_back,
    certify_pose,
    copy_rows,
    finish_pose,
    is_known,
    move,
    principal,
    same,
    turn_inside,
)
from dh2urdf.kernels.certificate.directions import add_step, look, look_at_some
from dh2urdf.kernels.certificate.finish import (
    finish_all,
    finish_batch,
    finish_families,
    is_singular,
    merge_solutions,
    name_batch,
    name_families,
    null_direction,
    reverse_joints,
    side_by_side,
    turn_back,
)
from dh2urdf.kernels.certificate.levenberg import approach
from dh2urdf.kernels.certificate.numeric import Coupled, find_solutions
from dh2urdf.kernels.certificate.together import arrange_together, turn_together, values_of_batch
from dh2urdf.kernels.certificate.valley import MOST_POINTS, follow_valleys, search_valleys
