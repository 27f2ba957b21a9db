"""The unit of length in which an arm is solved: the metre, or one of its own.

The thresholds of the solvers are meant for arms of about a metre. Out of that range a chain's
lengths are divided by a power of two, which rounds nothing, so that an arm of micrometres and one
of a thousand kilometres are solved as the one of a metre is.
"""

from __future__ import annotations

import math

from dh2urdf.chain import SerialChain
from dh2urdf.transforms import Array

__all__ = ["in_own_unit", "lengths_in"]

NORMAL = (2.0**-4, 2.0**4)
"""Lengths [m] of arms whose unit is the metre."""

RIGID = 1e-6
"""Length of an arm, relative to the travel of its slides, below which the travel is its size."""


def in_own_unit(chain: SerialChain) -> SerialChain:
    """The chain with its lengths in a unit that makes it 1 to 2 long; itself if it is normal."""
    length = chain.length if chain.length > RIGID * chain.size else chain.size
    if NORMAL[0] <= length <= NORMAL[1]:
        return chain
    return chain.in_unit(2.0 ** math.floor(math.log2(length)))


def lengths_in(Ts: Array, unit: float) -> Array:
    """Poses Ts (..., 4, 4) with their positions in a unit [m]."""
    out = Ts.copy()
    out[..., :3, 3] /= unit
    return out
