"""Poses of six values in doubt: what else solves them, and one member of each family of solutions.

`search` goes from many starts, and beside what is found; `members` keeps one of each family;
`poses` does it all, one pose after the other, for solvers whose counts say that they are not sure,
`known` where solutions are known, `closed_forms` where candidates lead along valleys, too.
"""

from dh2urdf.kernels.in_doubt.closed_forms import (
    FOUND,
    VALLEYS,
    follow_candidates,
    widen_parallel,
    widen_wrists,
)
from dh2urdf.kernels.in_doubt.known import search_known
from dh2urdf.kernels.in_doubt.members import MOST_STEPS
from dh2urdf.kernels.in_doubt.poses import (
    IN_DOUBT,
    referee_doubtful,
    search_doubtful,
    search_poses,
    unite_families,
)
