"""The entries as functions of a Python extension: arrays checked once, at the door.

The extension needs the stable interfaces of Python and of NumPy only. What an entry expects is
written here, as lines for the macro ``DOOR`` of ``doors.c``, which has all that the doors share.
"""

from collections.abc import Iterator

from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.c_text import folded
from dh2urdf.translate.definitions import Instance
from dh2urdf.translate.types import Array, Length, Record, Tuple, Type, lengths_of, told

MEMBERS = {"float": "real", "int": "whole", "bool": "whole"}

KINDS = {"float": "NPY_DOUBLE, 8", "int": "NPY_INT64, 8", "bool": "NPY_BOOL, 1"}
"""NumPy's kinds of elements, and their bytes."""

ANSWERS = {"float": "d", "int": "i", "bool": "N"}
"""Python's letters for what is found."""


def doors(file: CFile) -> str:
    """The doors of all entries."""
    return "\n".join(line for e in file.entries for line in _door(file, e))


def _door(file: CFile, e: Instance) -> Iterator[str]:
    """The door of an entry."""
    names = list(dict.fromkeys(["0", "poses", *lengths_of(e.entered)]))
    pairs = zip(e.source.parameters, e.entered, strict=True)
    taken = [one for name, t in pairs for one in _taken(name, t)]
    numbers = [t for _, t in taken if not isinstance(t, Tuple)]
    handed = [f"(int)lengths[{names.index(x)}]" for x in e.lengths()]
    handed += [f"given[{i}].{MEMBERS.get(str(t), 'array')}" for i, t in enumerate(numbers)]
    call = f"entries->{e.name}({', '.join(handed)})"
    if e.returned is not None:
        call = f"{file.declaration(e.returned, 'found')} = {call}"
    public = f"{e.source.module.__name__}.{e.source.name}".replace(".", "__")
    counts = f"{len(e.entered)}, {len(numbers)}, {len(names)}"
    yield from folded(f"DOOR({public}, {e.name}, {counts}, {call}, {_answer(e.returned)},")
    for name, t in taken:
        yield from folded(f"{{{_expected(name, t, names)}}},", 4)
    yield ")\n"


def _taken(name: str, t: Type) -> Iterator[tuple[str, Type]]:
    """An argument, and the items of a tuple after it."""
    yield name, t
    for i, item in enumerate(t.items if isinstance(t, Tuple) else ()):
        yield from _taken(f"{name}[{i}]", item)


def _expected(name: str, t: Type, names: list[str]) -> str:
    """What an argument has to be."""
    if isinstance(t, Tuple):
        return f'"{name}: expected a tuple of {len(t.items)}", 0, {len(t.items)}'
    text = f'"{name}: expected {told(t)}'
    if not isinstance(t, Array):
        return f"{text}\", '{told(t)[0]}'"
    record = isinstance(t.element, Record) and f"NPY_VOID, {t.element.dtype.itemsize}"
    lengths = ", ".join(_length(d, names) for d in t.shape)
    kind = record or KINDS[str(t.element)]
    return f'{text} in C order", 0, {len(t.shape)}, {kind}, {{{lengths}}}'


def _length(d: Length, names: list[str]) -> str:
    """A length by the place of its name, the first of which is zero's, and a number more."""
    name, _, more = str(d).partition(" + ")
    return f"{{0, {d}}}" if isinstance(d, int) else f"{{{names.index(name)}, {more or 0}}}"


def _answer(t: Type | None) -> str:
    """What is found, for Python."""
    if t is None:
        return "Py_NewRef(Py_None)"
    fields = t.fields() if isinstance(t, Tuple) else {}
    found = {f"found.{name}": x for name, x in fields.items()} or {"found": t}
    letters = "".join(ANSWERS[str(x)] for x in found.values())
    values = (f"PyBool_FromLong({c})" if x == "bool" else c for c, x in found.items())
    form = f"({letters})" if fields else letters
    return f'Py_BuildValue("{form}", {", ".join(values)})'
