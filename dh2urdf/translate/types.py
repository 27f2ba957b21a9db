"""Types of the kernels' values, and what holds two of them.

A number is "float", "int" or "bool". Arrays know the lengths of all dimensions but, perhaps, the
first: it may be a number, the name of a length that is known when the kernel runs, or None.
"""

from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np

NUMBERS = ("bool", "int", "float")
"""Each is contained in the next."""

ELEMENTS = {"f": "float", "i": "int", "b": "bool"}
"""By NumPy's letter of the kind."""


@dataclass(frozen=True)
class Array:
    """Numbers, or records, one after the other in memory."""

    element: Union[str, "Record"]
    shape: tuple[int | str | None, ...]
    constant: bool = False

    def at(self, indices: int) -> "Type":
        """What some leading indices leave."""
        if indices == len(self.shape):
            return self.element
        return Array(self.element, self.shape[indices:], self.constant)

    def unsized(self) -> "Array":
        """The same without its first length."""
        return Array(self.element, (None, *self.shape[1:]), self.constant)


@dataclass(frozen=True)
class Tuple:
    """Values that travel together."""

    items: tuple["Type", ...]


@dataclass(frozen=True)
class Record:
    """One element of a structured array."""

    name: str
    dtype: np.dtype[Any] = field(compare=False)

    def field_type(self, key: str) -> "Type":
        """Type of a field."""
        dtype = self.dtype.fields[key][0]  # type: ignore[index]
        element = ELEMENTS[dtype.base.kind]
        return Array(element, dtype.shape) if dtype.shape else element


@dataclass(frozen=True)
class Kernel:
    """A kernel that is handed to another: each one has an instance of its own."""

    function: Any


Type = str | Array | Tuple | Record | Kernel | None


def is_sized_late(t: Type) -> bool:
    """Whether the elements of an array have a size that is known when the kernel runs."""
    return isinstance(t, Array) and any(isinstance(d, str) for d in t.shape[1:])


def joined(a: Type, b: Type) -> Type:
    """The type that holds both; TypeError where there is none."""
    if a is None or a == b:
        return b
    if b is None:
        return a
    if isinstance(a, str) and isinstance(b, str):
        return max(a, b, key=NUMBERS.index)
    same = isinstance(a, Array) and isinstance(b, Array) and a.element == b.element
    if same and a.shape[1:] == b.shape[1:]:
        return Array(a.element, (None, *a.shape[1:]), a.constant or b.constant)
    if isinstance(a, Tuple) and isinstance(b, Tuple) and len(a.items) == len(b.items):
        return Tuple(tuple(joined(x, y) for x, y in zip(a.items, b.items, strict=True)))
    raise TypeError(f"{told(a)} and {told(b)}")


def told(t: Type) -> str:
    """A type in words."""
    if isinstance(t, Array):
        element = t.element if isinstance(t.element, str) else t.element.name
        return f"array of {element} {tuple('?' if d is None else d for d in t.shape)}"
    if isinstance(t, Tuple):
        return "(" + ", ".join(map(told, t.items)) + ")"
    return "nothing" if t is None else t if isinstance(t, str) else getattr(t, "name", "kernel")


def type_of_value(value: object) -> Type:
    """Type of a constant of a module; None where a kernel cannot use it."""
    if isinstance(value, bool | np.bool_):
        return "bool"
    if isinstance(value, int | np.integer):
        return "int"
    if isinstance(value, float | np.floating):
        return "float"
    if isinstance(value, np.ndarray) and value.dtype.kind in ELEMENTS:
        return Array(ELEMENTS[value.dtype.kind], value.shape, constant=True)
    if isinstance(value, tuple) and value:
        if {type(v) for v in value} in ({int}, {float}):
            return type_of_value(np.array(value))
        return Tuple(tuple(type_of_value(v) for v in value))
    return Kernel(value) if callable(value) and hasattr(value, "__code__") else None
