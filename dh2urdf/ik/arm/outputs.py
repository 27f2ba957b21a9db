"""The arrays that a solver fills: one record, made by whoever asks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array

IntArray = NDArray[np.int64]


class Outputs(NamedTuple):
    """Solutions of m poses, a row for each, in the order in which kernels take them.

    Attributes
    ----------
    q : array, shape (m, kmax, n)
        Solutions in the first ``counts[i]`` rows; the others may hold anything.
    residual : array, shape (m, kmax)
    counts : int64 array, shape (m,)
    branch : int64 array, shape (m, kmax)
        Bits of the branch; -1 where the family has none.
    free : int64 array, shape (m, kmax)
        Bits of the joints that are free along a singular family.
    """

    q: Array
    residual: Array
    counts: IntArray
    branch: IntArray
    free: IntArray

    @classmethod
    def of(cls, m: int, kmax: int, n: int) -> Outputs:
        """Arrays for m poses, nothing in them."""
        codes = np.zeros((2, m, kmax), np.int64)
        return cls(
            np.empty((m, kmax, n)), np.empty((m, kmax)), np.zeros(m, np.int64), codes[0], codes[1]
        )

    def rows(self, index: slice | IntArray) -> Outputs:
        """Those of some poses: views by a slice, copies by indices."""
        return Outputs._make(array[index] for array in self)
