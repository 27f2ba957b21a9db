"""Joint limits and full turns: which of the angles q + 2 pi k is meant."""

import itertools
import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm.shared_tolerances import LIMIT_SLACK
from dh2urdf.kernels.certificate import CLUSTER, turn_to
from dh2urdf.transforms import Array

TWO_PI = 2.0 * math.pi


def inside(chain: SerialChain, q: Array) -> NDArray[np.bool_]:
    """Whether configurations q (..., n) keep all limits, shape (...)."""
    out: NDArray[np.bool_] = np.all(
        (q >= chain.lower - LIMIT_SLACK) & (q <= chain.upper + LIMIT_SLACK), axis=-1
    )
    return out


class Ranges(Protocol):
    """What has limits: a chain, or a robot with those of its values."""

    @property
    def lower(self) -> Array:
        """Lower bounds (n,)."""

    @property
    def upper(self) -> Array:
        """Upper bounds (n,)."""


def middle(arm: Ranges) -> Array:
    """Middle of each range; where a bound is infinite, the allowed value nearest to zero."""
    both = np.isfinite(arm.lower) & np.isfinite(arm.upper)
    nearest = np.clip(0.0, arm.lower, arm.upper)
    lower, upper = np.where(both, arm.lower, 0.0), np.where(both, arm.upper, 0.0)
    return np.where(both, 0.5 * (lower + upper), nearest)


def near_ranges(chain: SerialChain) -> tuple[Array, Array]:
    """What of each range is within half a turn, or the arm's size, of zero; else its near end."""
    span = np.where(chain.prismatic, chain.size, np.pi)
    low = np.maximum(chain.lower, np.minimum(-span, chain.upper - span))
    return low, np.minimum(chain.upper, np.maximum(span, chain.lower + span))


def plain_ranges(chain: SerialChain) -> bool:
    """Whether every joint has both of its limits or neither, and no value is turns away."""
    whole = np.isfinite(chain.lower) == np.isfinite(chain.upper)
    return bool((whole & (np.abs(middle(chain)) < TWO_PI)).all())


def turned_to(chain: SerialChain, q: Array, reference: Array, within_limits: bool = True) -> Array:
    """Configurations q (..., n) with each angle in the turn nearest to the reference.

    Within limits, a turn inside goes before a nearer one outside; where no turn is inside, the
    nearest one is kept. The reference (..., n) is broadcast to the same shape.
    """
    if not within_limits:
        turns = np.rint((reference - q) / TWO_PI)
        return q + TWO_PI * np.where(chain.prismatic, 0.0, turns)
    shape = np.broadcast_shapes(q.shape, reference.shape)
    out = np.array(np.broadcast_to(q, shape), order="C")
    goal = np.ascontiguousarray(np.broadcast_to(reference, shape))
    turn_to(
        chain.tables[1][: chain.n], LIMIT_SLACK, goal.reshape(-1, chain.n), out.reshape(-1, chain.n)
    )
    return out


def seed_gaps(chain: SerialChain, q: Array, seed: Array) -> Array:
    """How far each joint of q (k, n) is from a seed (n,) [rad] or [m], shape (k, n).

    Angles are measured on the circle: a full turn apart is no distance.
    """
    gap = q - seed
    gap -= np.where(chain.prismatic, 0.0, TWO_PI * np.rint(gap / TWO_PI))
    return np.abs(gap)


def _turns(chain: SerialChain, q: Array) -> tuple[Array, Array]:
    """First and last full turn of configurations q (..., n) inside the limits, shape (..., n).

    A joint without both bounds has infinitely many turns; it keeps the one it has. Where rounding
    took the root of a singular solution over a bound, by ``CLUSTER`` at most, that is inside.
    """
    fixed = chain.prismatic | ~np.isfinite(chain.lower) | ~np.isfinite(chain.upper)
    lower, upper = np.where(fixed, q, chain.lower), np.where(fixed, q, chain.upper)
    first = np.ceil((lower - CLUSTER - q) / TWO_PI)
    last = np.floor((upper + CLUSTER - q) / TWO_PI)
    return first, last


def turn_counts(chain: SerialChain, q: Array) -> Array:
    """How many turns of configurations q (..., n) are inside the limits, shape (...)."""
    first, last = _turns(chain, q)
    counts: Array = np.prod(np.maximum(last - first + 1.0, 0.0), axis=-1)
    return counts


def all_turns(chain: SerialChain, q: Array) -> Array:
    """Every turn of one configuration q (n,) inside the limits, shape (k, n)."""
    turns = [np.arange(a, b + 1.0) for a, b in zip(*_turns(chain, q), strict=True)]
    choices = [value + TWO_PI * k for value, k in zip(q, turns, strict=True)]
    every = np.array(list(itertools.product(*choices)), float).reshape(-1, chain.n)
    on = np.clip(every, chain.lower, chain.upper)  # what rounding took over a limit
    return np.where(np.abs(on - every) <= CLUSTER, on, every)
