"""The entries of the package: which they are, and the types that their annotations give."""

import inspect
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np

from dh2urdf.translate.source import SubsetError
from dh2urdf.translate.types import ELEMENTS, Array, Length, Record, Tuple, Type

ROOM = "dh2urdf.kernels"

ELEMENTS_OF: dict[Any, Type] = {float: "float", int: "int", bool: "bool"}


def engine() -> Any:
    """The kernels' own module of what is compiled."""
    return import_module(f"{ROOM}.numbers.engine")


def modules() -> list[Path]:
    """Files of the kernels, in the order of their names."""
    found = import_module(ROOM)
    return sorted(Path(str(found.__file__)).parent.rglob("*.py"))


def entries() -> dict[str, Callable[..., Any]]:
    """All kernels that Python calls, by module and name."""
    top = Path(str(import_module(ROOM).__file__)).parent
    for path in modules():
        parts = path.relative_to(top).with_suffix("").parts
        import_module(".".join([ROOM, *(p for p in parts if p != "__init__")]))
    return dict(sorted(engine().INTERPRETED.items()))


def argument_types(function: Callable[..., Any]) -> list[Type]:
    """Types of an entry's arguments."""
    hints = get_type_hints(function, include_extras=True)
    names = inspect.signature(function).parameters
    if missing := [name for name in names if name not in hints]:
        path, line = inspect.getsourcefile(function), function.__code__.co_firstlineno
        raise SubsetError(f"{path}:{line}: {function.__name__}: no type for {', '.join(missing)}")
    lengths = engine().LENGTHS.get(f"{function.__module__}.{function.__name__}", {})
    return [_fixed(_type_of(hints[name]), lengths) for name in names]


def _type_of(hint: Any) -> Type:
    if hint in ELEMENTS_OF:
        return ELEMENTS_OF[hint]
    if isinstance(hint, type) and issubclass(hint, tuple):
        fields = get_type_hints(hint, include_extras=True)
        return Tuple(tuple(_type_of(fields[name]) for name in fields))
    assert get_origin(hint) is Annotated, hint
    array, *shape = get_args(hint)
    if isinstance(shape[0], np.dtype):
        return Array(Record(str(shape[1]), shape[0]), tuple(shape[2:]))
    dtype = np.dtype(get_args(get_args(array)[1])[0])
    return Array(ELEMENTS[dtype.kind], tuple(shape))


def _fixed(t: Type, lengths: dict[str, int]) -> Type:
    """A type with numbers in the place of some lengths."""
    if isinstance(t, Tuple):
        return Tuple(tuple(_fixed(x, lengths) for x in t.items))
    if isinstance(t, Array):
        return replace(t, shape=tuple(_length(d, lengths) for d in t.shape))
    return t


def _length(d: Length, lengths: dict[str, int]) -> Length:
    name, _, more = str(d).partition(" + ")
    return lengths[name] + int(more or 0) if name in lengths else d
