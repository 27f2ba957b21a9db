"""The doors by which arguments come in: one for each kind, with one message for each fault.

A message names the argument, what was found and what is allowed. The error is an `ArgumentError`,
or of the class that the caller gives.
"""

import operator
from collections.abc import Collection
from typing import Any, cast

import numpy as np
from numpy import ndarray
from numpy.typing import NDArray

from dh2urdf.bounds import NUMBER, TEXT_CHARACTERS
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError

Array = NDArray[np.float64]

FLOAT = np.dtype(np.float64)

NO_NUMBERS: tuple[type, ...] = str, bytes, bool, complex, np.datetime64, np.timedelta64
"""Objects that NumPy would read as numbers, besides None."""


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

    ``values`` may be an array of pandas, xarray and others by their array interface, but no text,
    None, ragged list, complex or masked entry; ``what`` and ``expected`` name it in the message.
    """
    if type(values) is ndarray and values.dtype is FLOAT:
        return values
    try:
        array = np.asanyarray(values)
        if type(array) is not ndarray and np.ma.is_masked(array):
            raise TypeError
        array = np.asarray(array)
        if array.dtype.kind == "O":
            if any(isinstance(v, NO_NUMBERS) or not hasattr(v, "__float__") for v in array.flat):
                raise TypeError
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
    shape: tuple[Any, ...] | None = None,
) -> Array:
    """:func:`real_array` without NaN and infinity; the message has the index of the first.

    With a ``shape``, of which ``...`` stands for any axes before the others, numbers square.
    """
    array = real_array(values, what, expected, error)
    fits = shape is None or array.shape == shape
    if shape is not None and shape[:1] == (...,):
        fits = array.shape[1 - len(shape) :] == shape[1:]
    if not fits:
        raise error(f"{what}: expected {expected}, got {found(values)}")
    finite = np.isfinite(array) if shape is None else np.abs(array) <= NUMBER
    if not finite.all():
        first = np.argwhere(~finite)[0].tolist()
        entry, index = array[tuple(first)], str(first) if first else ""
        got = f"{entry:g}" if np.isfinite(entry) else "NaN or infinity"
        raise error(f"{what}{index}: expected {expected}, got {got}")
    return array


def number(
    value: object,
    what: str,
    low: float,
    high: float,
    error: type[Dh2UrdfError] = ArgumentError,
    unit: str = "",
) -> float:
    """A finite real number between two bounds, included; the unit is for the message."""
    if isinstance(value, float) and low <= value <= high:
        return value
    expected = f"a number from {low:g} to {high:g}{' ' * bool(unit)}{unit}"
    array = real_array(value, what, expected, error)
    if array.shape or not low <= float(array) <= high:
        raise error(f"{what}: expected {expected}, got {found(value)}")
    return float(array)


def integer(
    value: object, what: str, low: int, high: int, error: type[Dh2UrdfError] = ArgumentError
) -> int:
    """A whole number between two bounds, included; no truth value."""
    try:
        whole = operator.index(cast("Any", value))
        if not isinstance(value, (bool, np.bool_)) and low <= whole <= high:
            return whole
    except Exception:  # an object's own conversion may fail in any way
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
    """True or False, of Python or NumPy; nothing that is merely true or false."""
    if value is True or value is False:
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    raise ArgumentError(f"{what}: expected True or False, got {found(value)}")


def instance(value: object, what: str, kind: Any, error: type[Dh2UrdfError] = ArgumentError) -> Any:
    """An object of some class."""
    if isinstance(value, kind):
        return value
    raise error(f"{what}: expected a {kind.__name__}, got {found(value)}")


def items(values: Any, what: str) -> list[Any]:
    """What may be gone through, as a list."""
    try:
        return list(values)
    except Exception:  # an object's own iterator may fail in any way
        raise ArgumentError(f"{what}: expected a list, got {found(values)}") from None


def generator(rng: Any, what: str = "rng") -> np.random.Generator:
    """A generator of random numbers, or the one of a seed."""
    try:
        return np.random.default_rng(rng)
    except Exception:  # as above
        raise ArgumentError(
            f"{what}: expected a numpy.random.Generator or a whole number from 0, got {found(rng)}"
        ) from None


def choice(
    value: object, what: str, allowed: Collection[str], error: type[Dh2UrdfError] = ArgumentError
) -> str:
    """One of some words."""
    if isinstance(value, str) and value in allowed:
        return value
    words = " or ".join(repr(str(word)) for word in allowed)
    raise error(f"{what}: expected {words}, got {found(value)}")
