"""The doors by which arguments come in: one for each kind, with one message for each fault.

A message names the argument, what was found and what is allowed.
"""

from __future__ import annotations

import operator
from collections.abc import Collection
from typing import Any, cast

import numpy as np
from numpy import ndarray
from numpy.typing import NDArray

from dh2urdf.bounds import TEXT_CHARACTERS
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError

__all__ = [
    "choice",
    "finite_array",
    "flag",
    "found",
    "generator",
    "instance",
    "integer",
    "number",
    "real_array",
    "text",
]

Array = NDArray[np.float64]

FLOAT = np.dtype(np.float64)

NO_NUMBERS = str, bytes, bool, complex, np.datetime64, np.timedelta64


def found(value: object) -> str:
    """A value as messages show it: short, in one line, whatever it is."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # a foreign object's own repr may fail in any way
        text = f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."


def real_array(
    values: object, what: str, expected: str, error: type[Dh2UrdfError] = ArgumentError
) -> Array:
    """Real numbers of any type, order and stride as native floats; a float array itself.

    Parameters
    ----------
    values : array_like
        Numbers; arrays of pandas, xarray and others by their array interface.
    what, expected : str
        Name of the argument and what it takes, for the message.
    error : exception type

    Raises
    ------
    ArgumentError
        Or ``error``: no numbers, text, None, ragged, complex, masked entries.
    """
    if type(values) is ndarray and values.dtype is FLOAT:
        return values
    try:
        array = np.asanyarray(values)
        if np.ma.is_masked(array):
            raise TypeError
        array = np.asarray(array)
        if array.dtype.kind == "O":
            _only_numbers(array)
        elif array.dtype.kind not in "iuf":
            raise TypeError
        with np.errstate(over="ignore"):
            return array.astype(np.float64, copy=False)
    except Exception:  # an object's own conversions may fail in any way
        raise error(f"{what}: expected {expected}, got {found(values)}") from None


def finite_array(
    values: object,
    what: str,
    expected: str,
    error: type[Dh2UrdfError] = ArgumentError,
    shape: tuple[int, ...] | None = None,
) -> Array:
    """:func:`real_array` without NaN and infinity.

    Raises
    ------
    ArgumentError
        Or ``error``, with the index of the first entry that is not finite.
    """
    array = real_array(values, what, expected, error)
    if shape is not None and array.shape != shape:
        raise error(f"{what}: expected {expected}, got {found(values)}")
    finite = np.isfinite(array)
    if not finite.all():
        index = ", ".join(map(str, np.argwhere(~finite)[0]))
        raise error(f"{what}{index and f'[{index}]'}: expected {expected}, got NaN or infinity")
    return array


def _only_numbers(array: NDArray[Any]) -> None:
    """Refuse objects that are no real numbers, which NumPy would read: texts, None, truths.

    Raises
    ------
    TypeError
    """
    for entry in array.flat:
        if isinstance(entry, NO_NUMBERS) or not hasattr(entry, "__float__"):
            raise TypeError


def number(
    value: object,
    what: str,
    low: float,
    high: float,
    error: type[Dh2UrdfError] = ArgumentError,
    unit: str = "",
) -> float:
    """A finite real number between two bounds, included; the unit is for the message.

    Raises
    ------
    ArgumentError
        Or ``error``.
    """
    if type(value) is float and low <= value <= high:
        return value
    expected = f"a number from {low:g} to {high:g}{' ' * bool(unit)}{unit}"
    array = real_array(value, what, expected, error)
    if array.shape or not low <= float(array) <= high:
        raise error(f"{what}: expected {expected}, got {found(value)}")
    return float(array)


def integer(
    value: object,
    what: str,
    low: int,
    high: int,
    error: type[Dh2UrdfError] = ArgumentError,
) -> int:
    """A whole number between two bounds, included; no truth value.

    Raises
    ------
    ArgumentError
        Or ``error``.
    """
    try:
        whole = operator.index(cast("Any", value))
        if not isinstance(value, (bool, np.bool_)) and low <= whole <= high:
            return whole
    except TypeError:
        pass
    raise error(f"{what}: expected a whole number from {low} to {high}, got {found(value)}")


def text(value: object, what: str, error: type[Dh2UrdfError] = ArgumentError) -> str:
    """A text that a file can hold: bounded, and no half of a character; or the error."""
    if not isinstance(value, str):
        raise error(f"{what}: expected a text, got {found(value)}")
    if len(value) > TEXT_CHARACTERS:
        raise error(f"{what}: {len(value)} characters; at most {TEXT_CHARACTERS} are allowed")
    if any("\ud800" <= character <= "\udfff" for character in value):
        raise error(f"{what}: {found(value)} holds half a character, which no file can hold")
    return str(value)


def flag(value: object, what: str) -> bool:
    """True or False, of Python or NumPy; nothing that is merely true or false.

    Raises
    ------
    ArgumentError
    """
    if value is True or value is False:
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    raise ArgumentError(f"{what}: expected True or False, got {found(value)}")


def instance(value: object, what: str, kind: Any, error: type[Dh2UrdfError] = ArgumentError) -> Any:
    """An object of some class.

    Raises
    ------
    ArgumentError
        Or ``error``.
    """
    if isinstance(value, kind):
        return value
    raise error(f"{what}: expected a {kind.__name__}, got {found(value)}")


def generator(rng: Any, what: str = "rng") -> np.random.Generator:
    """A generator of random numbers, or the one of a seed.

    Raises
    ------
    ArgumentError
    """
    try:
        return np.random.default_rng(rng)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(
            f"{what}: expected a numpy.random.Generator or a whole number from 0, got {found(rng)}"
        ) from None


def choice(
    value: object,
    what: str,
    allowed: Collection[str],
    error: type[Dh2UrdfError] = ArgumentError,
) -> str:
    """One of some words.

    Raises
    ------
    ArgumentError
        Or ``error``.
    """
    if isinstance(value, str) and value in allowed:
        return value
    words = " or ".join(repr(str(word)) for word in allowed)
    raise error(f"{what}: expected {words}, got {found(value)}")
