"""Thousands of numbers as text: for each the shortest that reads back as the same float.

``repr`` does that for one at a time, and takes eight times as long. A number x from 1e-4 up to 1e4
has 17 digits, V = x 10^k with k <= 20; 10^k is a float, and two floats hold the product (Dekker
1971). Of V rounded to 15, 16 and 17 digits the first that is nearer to x than half of its spacing
is the shortest text: a float holds any 15 digits, and 17 hold any float.

Text stands in rows of words of four bytes, of which those that are 0 are left out in the end.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from dh2urdf.transforms import Array

Words = NDArray[np.uint32]
Whole = NDArray[np.int64]

LEAST, MOST = 1e-4, 1e4
"""Sizes of the numbers that are not left to ``repr``."""

_DECADES = np.array([1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3])
_SCALES: Array = 10.0 ** np.arange(20.0, 12.0, -1.0)
_ONES = np.array([0] * 4 + [10**k for k in range(16, 12, -1)])
"""For each decade 10^k, and the same as a whole number where there is a whole part."""

_SHIFTS = np.array([1] * 4 + [10, 100, 1_000, 10_000])
"""What makes 17 decimals of those behind the whole part."""

_SPLIT = 134_217_729.0
"""2^27 + 1, which parts a float into halves of 26 bits."""


def _table(texts: list[str]) -> Words:
    """Texts of up to four bytes, a word each."""
    return np.array(texts, "S4").view(np.uint32)


_WHOLE, _FOUR, _CUT = (
    _table([form(k) for k in range(10_000)])
    for form in (str, "{:04d}".format, lambda k: f"{k:04d}".rstrip("0"))
)
_GROUPS = np.concatenate([_FOUR, _CUT])
"""Four decimals, and the same without the zeros at their end."""

_FIRST = _table([f"{'0' * zeros}{k}" for zeros in (3, 2, 1, 0) for k in range(10)])
"""The first digit behind the point that is not 0, and the zeros before it."""

_SIGN, (_COMMA, _POINT) = _table([",", ",-"]), _table([",", "."])


def _halves(x: Array) -> tuple[Array, Array]:
    """Two numbers of 26 bits whose sum is x."""
    c = _SPLIT * x
    high = c - (c - x)
    return high, x - high


_SCALE_HIGH, _SCALE_LOW = _halves(_SCALES)


def _digits(x: Array, decade: NDArray[np.intp]) -> Whole:
    """17 digits of numbers from 1e-4 up to 1e4, with zeros behind those that are needed."""
    scale, s_high, s_low = _SCALES[decade], _SCALE_HIGH[decade], _SCALE_LOW[decade]
    product, (high, low) = x * scale, _halves(x)
    error = ((high * s_high - product) + high * s_low + low * s_high) + low * s_low
    near = np.rint(error)
    digits = product.astype(np.int64) + near.astype(np.int64)
    hundreds = digits // 100 * 100
    behind = (digits - hundreds).astype(np.float64) + (error - near)
    allowed = 0.5 * np.spacing(x) * scale
    for unit in (10.0, 100.0):
        rounded = np.rint(behind / unit) * unit
        fits = np.abs(rounded - behind) < allowed
        digits = np.where(fits, hundreds + rounded.astype(np.int64), digits)
    return digits


def number_words(values: Array) -> Words:
    """A comma and the text of each number, shape (..., 8); of NaN the comma alone."""
    size = np.abs(values)
    usual = (size >= LEAST) & (size < MOST)
    x = np.where(usual, size, 1.0)
    decade = np.searchsorted(_DECADES, x, "right")
    whole = x.astype(np.int64)
    decimals = (_digits(x, decade) - whole * _ONES[decade]) * _SHIFTS[decade]
    first = decimals // 10**16
    rest = decimals - first * 10**16
    high = rest // 10**8
    low = (rest - high * 10**8).astype(np.uint32)
    a, b = np.divmod(high.astype(np.uint32), 10_000)
    c, d = np.divmod(low, 10_000)
    out = np.empty((*values.shape, 8), np.uint32)
    out[..., 0] = _SIGN[np.signbit(values).view(np.uint8)]
    out[..., 1] = _WHOLE[whole * usual]
    out[..., 2] = _POINT
    out[..., 3] = _FIRST[np.minimum(decade, 3) * 10 + first]
    out[..., 4] = _GROUPS[a + 10_000 * ((b == 0) & (low == 0))]
    out[..., 5] = _GROUPS[b + 10_000 * (low == 0)]
    out[..., 6] = _GROUPS[c + 10_000 * (d == 0)]
    out[..., 7] = _CUT[d]
    for i in np.argwhere(~usual & (size != 0.0)):
        value = float(values[tuple(i)])
        text = "" if np.isnan(value) else repr(value)
        out[tuple(i)] = np.array([f",{text}"], "S32").view(np.uint32)
    return out


def whole_words(values: Whole) -> Words:
    """A comma and the text of numbers from 0 up to 10^8, shape (k, 3)."""
    high, low = np.divmod(values, 10_000)
    lower = np.where(high > 0, _FOUR[low], _WHOLE[low])
    upper = np.where(high > 0, _WHOLE[high], 0)
    return np.stack([np.full(len(values), _COMMA), upper, lower], axis=1).astype(np.uint32)


def few_words(keys: Whole, text: Callable[[int], str]) -> Words:
    """A text for each key, shape (k, words); asked for by where each different one is first."""
    _, first, where = np.unique(keys, return_index=True, return_inverse=True)
    texts = np.array([text(i).encode() for i in first.tolist()] or [b""])
    width = -(-texts.dtype.itemsize // 4)
    return texts.astype(f"S{4 * width}").view(np.uint32).reshape(-1, width)[where]


def text_of(columns: Sequence[Words]) -> bytes:
    """The lines of columns (k, words), whose bytes that are not 0 stand in a row."""
    rows = np.concatenate(columns, axis=1)
    return rows.tobytes().translate(None, b"\0")
