"""The entries of the package: which they are, and the types that their annotations give."""

import inspect
from collections.abc import Callable
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


def entries() -> dict[str, Callable[..., Any]]:
    """All kernels that Python calls, by module and name."""
    top = Path(str(import_module(ROOM).__file__)).parent
    for path in sorted(top.rglob("*.py")):
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
    return [_type_of(hints[name], lengths) for name in names]


def _type_of(hint: Any, lengths: dict[str, int]) -> Type:
    """The type that an annotation gives, with numbers in the place of some lengths."""
    if hint in ELEMENTS_OF:
        return ELEMENTS_OF[hint]
    if isinstance(hint, type) and issubclass(hint, tuple):
        fields = get_type_hints(hint, include_extras=True)
        return Tuple(tuple(_type_of(field, lengths) for field in fields.values()))
    assert get_origin(hint) is Annotated, hint
    array, *shape = get_args(hint)
    if isinstance(shape[0], np.dtype):
        dtype, name, *shape = shape
        element: str | Record = Record(str(name), dtype)
    else:
        element = ELEMENTS[np.dtype(get_args(get_args(array)[1])[0]).kind]
    return Array(element, tuple(_length(d, lengths) for d in shape))


def _length(d: Length, lengths: dict[str, int]) -> Length:
    name, _, more = str(d).partition(" + ")
    return lengths[name] + int(more or 0) if name in lengths else d
