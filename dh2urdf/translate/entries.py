"""The entries: which they are, what their annotations say, and their doors for Python.

The extension needs the stable interfaces of Python and of NumPy only. What an entry expects is
written here, as lines for the macro ``DOOR`` of ``doors.c``, which has all that the doors share.
"""

import inspect
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np

from dh2urdf import engine
from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.definitions import folded
from dh2urdf.translate.source import ROOM, source_of
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import ELEMENTS, Array, Record, Tuple, Type, inside, lengths_of, told
from dh2urdf.translate.values import Value

MEMBERS = {"float": "real", "int": "whole", "bool": "whole"}

KINDS = {"float": "NPY_DOUBLE, 8", "int": "NPY_INT64, 8", "bool": "NPY_BOOL, 1"}
"""NumPy's kinds of elements, and their bytes."""

ANSWERS = {"float": "d", "int": "i", "bool": "N"}
"""Python's letters for what is found."""


def entries() -> dict[str, Callable[..., Any]]:
    """All kernels that Python calls, by module and name."""
    top = Path(str(import_module(ROOM).__file__)).parent
    for path in sorted(top.rglob("*.py")):
        parts = path.relative_to(top).with_suffix("").parts
        import_module(".".join([ROOM, *(p for p in parts if p != "__init__")]))
    return dict(sorted(engine.INTERPRETED.items()))


def argument_types(function: Callable[..., Any]) -> list[Type]:
    """Types of an entry's arguments."""
    hints = get_type_hints(function, include_extras=True)
    names = inspect.signature(function).parameters
    if missing := [name for name in names if name not in hints]:
        source = source_of(function)
        source.refuse(source.tree.args, f"no type for {', '.join(missing)}", "its kind and shape")
    lengths = engine.LENGTHS.get(f"{function.__module__}.{function.__name__}", {})
    lengths = lengths | {f"{name} + 1": length + 1 for name, length in lengths.items()}
    return [_type_of(hints[name], lengths) for name in names]


def _type_of(hint: Any, lengths: dict[str, int]) -> Type:
    """The type that an annotation gives, with numbers in the place of some lengths."""
    if hint in (float, int, bool):
        return str(hint.__name__)
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
    return Array(element, tuple(lengths.get(d, d) for d in shape))


def doors(file: CFile) -> str:
    """The doors of all entries."""
    return "\n".join(line for e in file.entries for line in _door(file, e))


def _door(file: CFile, e: Body) -> Iterator[str]:
    """The door of an entry."""
    names = list(dict.fromkeys(["0", "poses", *lengths_of(e.entered)]))
    pairs = zip(e.source.parameters, e.entered, strict=True)
    taken = [one for name, t in pairs for one in inside(name, t)]
    numbers = [t for _, t in taken if not isinstance(t, Tuple)]
    handed = [f"(int)lengths[{names.index(x)}]" for x in e.lengths()]
    handed += [f"given[{i}].{MEMBERS.get(str(t), 'array')}" for i, t in enumerate(numbers)]
    call = f"entries->{e.function}({', '.join(handed)})"
    if e.returned is not None:
        call = f"{file.declaration(e.returned, 'found')} = {call}"
    public = f"{e.source.module.__name__}.{e.source.name}".replace(".", "__")
    counts = f"{len(e.entered)}, {len(numbers)}, {len(names)}"
    yield from folded(f"DOOR({public}, {e.function}, {counts}, {call}, {_answer(e.returned)},")
    for name, t in taken:
        yield from folded(f"{{{_expected(name, t, names)}}},", 4)
    yield ")\n"


def _expected(name: str, t: Type, names: list[str]) -> str:
    """What an argument has to be."""
    if isinstance(t, Tuple):
        return f'"{name}: expected a tuple of {len(t.items)}", 0, {len(t.items)}'
    text = f'"{name}: expected {told(t)}'
    if not isinstance(t, Array):
        return f"{text}\", '{told(t)[0]}'"
    record = isinstance(t.element, Record) and f"NPY_VOID, {t.element.dtype.itemsize}"
    lengths = []
    for d in t.shape:  # the place of a name, the first of which is zero's, and a number more
        name, more = ("0", d) if isinstance(d, int) else str(d).partition(" + ")[::2]
        lengths.append(f"{{{names.index(name)}, {more or 0}}}")
    kind = record or KINDS[str(t.element)]
    return f'{text} in C order", 0, {len(t.shape)}, {kind}, {{{", ".join(lengths)}}}'


def _answer(t: Type | None) -> str:
    """What is found, for Python."""
    if t is None:
        return "Py_NewRef(Py_None)"
    value = Value(t, "found")
    items = value.items() if isinstance(t, Tuple) else (value,)
    letters = "".join(ANSWERS[str(x.type)] for x in items)
    values = (f"PyBool_FromLong({x.text})" if x.type == "bool" else x.text for x in items)
    form = f"({letters})" if isinstance(t, Tuple) else letters
    return f'Py_BuildValue("{form}", {", ".join(values)})'
