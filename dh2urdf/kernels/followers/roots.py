"""The polynomial in the leader's turn: its values as determinants, and its real roots."""

from typing import Annotated, Any

from dh2urdf.kernels.certificate import TWO_PI
from dh2urdf.kernels.followers.arm import ALWAYS, FOLLOWERS_48
from dh2urdf.kernels.followers.elimination import TERMS, eliminate, six_equations
from dh2urdf.kernels.general_6r import (
    PAIRS,
    add_roots,
    finish_reduction,
    place_samples,
    reduce_half,
)
from dh2urdf.kernels.numbers import COLUMN, LANES, atan2, entry, side_by_side
from dh2urdf.kernels.rigid import load_pose, times_link
from dh2urdf.kernels.shapes import Floats, Poses

TINY = 1e-30
"""Keeps a sample at such a root finite."""


def place_target(T, arm):
    """Set the target T (4, 4), and close the chain with it."""
    ends, C, size = arm["ends"], arm["chain"][arm["motions"] - 1], arm["size"]
    arm["target"][:] = T[:3]
    r = times_link(times_link(load_pose(ends[0]), T), ends[1])
    C[0, 0], C[0, 1], C[0, 2], C[0, 3] = r[0], r[1], r[2], r[3] / size
    C[1, 0], C[1, 1], C[1, 2], C[1, 3] = r[4], r[5], r[6], r[7] / size
    C[2, 0], C[2, 1], C[2, 2], C[2, 3] = r[8], r[9], r[10], r[11] / size


def block_resultants(n, arm):
    """Determinants at n values of the leader, in ``block``; W (6 x 6 lanes) is left triangular."""
    A, W, V, beta, values = arm["A"], arm["W"], arm["V"], arm["beta"], arm["determinants"]
    equations = arm["equations"]
    six_equations(n, arm)
    values[:] = 1.0
    for half in range(2):
        for term in range(TERMS):
            block, j = term // 3, term % 3
            column = (term if half == 0 else 3 * (2 - block) + j) * COLUMN
            for r in range(6):
                a, e = column + r * LANES, (TERMS * r + term) * LANES
                for k in side_by_side(n):
                    A[a + k] = equations[e + k]
        reduce_half(half, n, A, W, values, V, beta)
    finish_reduction(n, W, values, V, beta)


def _divide(e, n, arm):
    """Divide n determinants by the roots that elimination e has at every pose."""
    values, block = arm["determinants"], arm["block"]
    for i in range(ALWAYS):
        cosine, sine = arm["always"][e, i, 0], arm["always"][e, i, 1]
        for _ in range(int(arm["always"][e, i, 2])):
            for k in side_by_side(n):
                x, y = block[0, k] - cosine, block[1, k] - sine
                values[k] /= x * x + y * y + TINY


def sample_resultants(e, arm):
    """The polynomial at all values of the leader in ``hidden``."""
    hidden, determinant = arm["hidden"], arm["determinant"]
    lanes = hidden.shape[1]
    for first in range(0, lanes, LANES):
        n = min(LANES, lanes - first)
        for k in side_by_side(n):
            arm["block"][0, k], arm["block"][1, k] = hidden[0, first + k], hidden[1, first + k]
        block_resultants(n, arm)
        _divide(e, n, arm)
        for k in side_by_side(n):
            determinant[first + k] = arm["determinants"][k]


def find_roots(e, arm):
    """Roots of the polynomial of elimination e, as by `add_roots`."""
    always = arm["always"][e, 0]
    count, k, start = 0, 0, 0.0
    if always[2] > 0.0:  # as far as may be from where it is divided by next to nothing
        start = atan2(always[1], always[0]) + 0.5 * TWO_PI / arm["hidden"].shape[1]
    while count >= 0 and (k == 0 or k <= arm["spans"][0, 0]):
        middle, half_tan = place_samples(k, start, arm)
        sample_resultants(e, arm)
        count = add_roots(k, middle, half_tan, PAIRS, count, arm)
        k += 1
    return count


@entry(n=6)
def sample_followers(
    arms: Annotated[Any, FOLLOWERS_48, "followers_48", 1],
    Ts: Poses,
    values: Annotated[Floats, "poses", 104],
):
    """The first elimination's polynomial all around the circle, for poses Ts (m, 4, 4)."""
    arm = arms[0]
    for m in range(Ts.shape[0]):
        place_target(Ts[m], arm)
        eliminate(0, arm)
        place_samples(0, 0.0, arm)
        sample_resultants(0, arm)
        values[m] = arm["determinant"]
