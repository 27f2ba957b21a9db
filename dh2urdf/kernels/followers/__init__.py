"""Arms with a joint whose followers move with it, six values: one polynomial in the leader's turn.

`poses` is the solver, `arm` the record on which everything works; `elimination` makes six equations
for each value of the leader, `roots` the polynomial's values and its real roots, `follow` leads
from those to solutions.
"""

from dh2urdf.kernels.followers.arm import ALWAYS, FOLLOWERS_16, FOLLOWERS_48, MOTIONS
from dh2urdf.kernels.followers.poses import (
    finish_followers_16,
    finish_followers_48,
    try_followers_16,
    try_followers_48,
)
from dh2urdf.kernels.followers.roots import sample_followers
