"""A plugin (``-p tests.helpers.nan_empty``): `np.empty` holds NaN, or the least integer.

Whoever reads what nobody wrote then gets a wrong answer or a warning, in Python and in kernels,
compiled or not. Compiled ones need a cache of their own: ``NUMBA_CACHE_DIR``.
"""

import numpy as np
import numpy.ma  # reads the docstring of np.empty
from numba import njit, types
from numba.extending import overload

EMPTY = np.empty


def filled(shape, dtype=float, *args, **kwargs):
    """What ``np.empty`` gives, filled with what no one may read."""
    array = EMPTY(shape, dtype, *args, **kwargs)
    if array.dtype.kind == "f":
        array.fill(np.nan)
    elif array.dtype.kind == "i":
        array.fill(np.iinfo(array.dtype).min)
    return array


@overload(filled)
def compiled(shape, dtype=float):
    """The same for kernels: floats and integers of 64 bits; the rest as it is."""
    kind = getattr(dtype, "dtype", types.float64)
    if kind not in {types.float64, types.int64}:
        return lambda shape, dtype=float: EMPTY(shape, dtype)
    poison = np.nan if kind == types.float64 else np.iinfo(np.int64).min

    def poisoned(shape, dtype=float):
        array = EMPTY(shape, dtype)
        array[...] = poison
        return array

    return poisoned


@njit
def first():
    """Compile something, for which Numba loads libraries that want the true ``np.empty``."""
    return np.zeros(1).sum()


first()
np.empty = filled
