"""A plugin (``-p tests.helpers.nan_empty``): `np.empty` holds NaN, or the least integer.

Whoever reads what nobody wrote then gets a wrong answer or a warning, in Python and in kernels that
run interpreted.
"""

import numpy as np
import numpy.ma  # reads the docstring of np.empty

EMPTY = np.empty


def filled(shape, dtype=float, *args, **kwargs):
    """What ``np.empty`` gives, filled with what no one may read."""
    array = EMPTY(shape, dtype, *args, **kwargs)
    if array.dtype.kind == "f":
        array.fill(np.nan)
    elif array.dtype.kind == "i":
        array.fill(np.iinfo(array.dtype).min)
    return array


np.empty = filled
