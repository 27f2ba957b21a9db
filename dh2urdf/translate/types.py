"""Types of the kernels' values.

A number is "float", "int" or "bool". Arrays know the lengths of all dimensions but, perhaps, the
first: it may be a number, the name of a length that is known when the kernel runs, or None.
"""

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias, Union

import numpy as np

ELEMENTS = {"f": "float", "i": "int", "b": "bool"}
"""By NumPy's letter of the kind."""

Length: TypeAlias = int | str | None


@dataclass(frozen=True)
class Record:
    """One element of a structured array."""

    name: str
    dtype: np.dtype[Any] = field(compare=False)

    def fields(self) -> dict[str, "Type"]:
        """Types of the fields, by their names."""
        found: dict[str, Type] = {}
        for key, (dtype, *_) in (self.dtype.fields or {}).items():
            element = ELEMENTS[dtype.base.kind]
            found[key] = Array(element, dtype.shape) if dtype.shape else element
        return found


@dataclass(frozen=True)
class Fixed:
    """An array whose values are known when kernels are translated: a name of the file has it."""

    text: str
    values: np.ndarray[Any, Any] = field(compare=False)


@dataclass(frozen=True)
class Array:
    """Numbers, or records, one after the other in memory."""

    element: str | Record
    shape: tuple[Length, ...]
    constant: bool = False
    fixed: Fixed | None = None

    def at(self, indices: int) -> "Array | Record | str":
        """What some leading indices leave."""
        if indices == len(self.shape):
            return self.element
        return replace(self, shape=self.shape[indices:], fixed=None)

    def first(self, length: Length = None) -> "Array":
        """The same with another first length, or without it."""
        return replace(self, shape=(length, *self.shape[1:]), fixed=None)


@dataclass(frozen=True)
class Tuple:
    """Values that travel together: as a struct if all are numbers, else one by one."""

    items: tuple[Union[str, Array, Record, "Tuple"], ...]

    @property
    def name(self) -> str:
        """Name of the struct, by letters of the items."""
        letters = "".join(x[0] if isinstance(x, str) else "t" for x in self.items)
        return "tuple_" + re.sub(r"(.)\1+", lambda run: f"{run[1]}{len(run[0])}", letters)

    def fields(self) -> dict[str, "Type"]:
        """Types of the struct's fields, by their names."""
        return {f"f{i}": t for i, t in enumerate(self.items)}

    @property
    def is_struct(self) -> bool:
        """Whether C has a variable for it."""
        return all(isinstance(t, str) or (isinstance(t, Tuple) and t.is_struct) for t in self.items)


Type: TypeAlias = str | Array | Record | Tuple


def is_fixed(t: Type) -> bool:
    """Whether a name of the file stands for it, which no kernel needs to be handed."""
    return isinstance(t, Array) and t.fixed is not None


def wider(a: Type, b: Type) -> Type | None:
    """The type of what is one or the other; None where there is none."""
    if isinstance(a, str) and isinstance(b, str):
        return max(a, b, key=("bool", "int", "float").index)
    if isinstance(a, Array) and isinstance(b, Array) and a.first() == b.first():
        return a if a == b else a.first()
    return a if a == b else None


def told(t: Type | None) -> str:
    """A type in words."""
    if isinstance(t, Array):
        lengths = ", ".join("?" if d is None else str(d) for d in t.shape)
        return f"{'constant ' * t.constant}array of {told(t.element)} ({lengths})"
    if isinstance(t, Tuple):
        return f"({', '.join(map(told, t.items))})"
    return t.name if isinstance(t, Record) else t or "nothing"


def type_of_value(value: object) -> Type | None:
    """Type of a constant of a module; None where a kernel cannot use it."""
    if isinstance(value, tuple) and {type(v) for v in value} not in ({int}, {float}):
        return None
    table = np.asarray(value)
    element = ELEMENTS.get(table.dtype.kind)
    if element and table.shape:
        return Array(element, table.shape, constant=True)
    return None if element == "int" and abs(int(table)) >= 2**31 else element


def inside(name: str, t: Type) -> Iterator[tuple[str, Type]]:
    """A type, and after it those of a tuple's items; with their names."""
    yield name, t
    for i, item in enumerate(t.items if isinstance(t, Tuple) else ()):
        yield from inside(f"{name}[{i}]", item)


def lengths_of(types: Iterable[Type]) -> list[str]:
    """Names of the lengths in some types."""
    arrays = (x for t in types for _, x in inside("", t) if isinstance(x, Array))
    named = (d for array in arrays for d in array.shape if isinstance(d, str))
    return sorted({name for d in named for name in re.findall(r"[a-z]\w*", d)})
