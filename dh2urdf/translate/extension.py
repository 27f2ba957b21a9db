"""The entries as functions of a Python extension: arrays checked once, at the door.

The extension needs the stable interfaces of Python and of NumPy only. Each
level of processor is the same C, compiled once more; the table of its entries is chosen when the
extension is imported: the best that the processor has, or the one that ``DH2URDF_LEVEL`` names.
"""

import platform
from collections.abc import Iterable, Iterator
from pathlib import Path

from dh2urdf.translate.c_file import INCLUDES, CFile
from dh2urdf.translate.c_text import LEAVE, folded
from dh2urdf.translate.definitions import Instance
from dh2urdf.translate.types import Array, Length, Record, Tuple, Type, lengths_of, told

X86 = platform.machine() in ("x86_64", "AMD64")

LEVELS = {
    "v4": ("x86-64-v4", "avx512f avx512cd avx512bw avx512dq avx512vl"),
    "v3": ("x86-64-v3", "avx2 bmi bmi2 fma"),
    "any": ("x86-64", ""),
}
"""Best first: what compilers call it, and what the processor must have."""

if not X86:
    LEVELS = {"any": ("", "")}

MANY = 256
"""Poses of a call from which on other threads may run meanwhile."""

MEMBERS = {"float": "real", "int": "whole", "bool": "whole"}

KINDS = {"float": "NPY_DOUBLE, 8", "int": "NPY_INT64, 8", "bool": "NPY_BOOL, 1"}
"""NumPy's kinds of elements, and their bytes."""

SHARED = Path(__file__).with_name("doors.h")

DOOR = """static PyObject *py_{name}(PyObject *self, PyObject *const *args, Py_ssize_t count)
{{
    static const Expected expected[] = {{
{expected}
    }};
    npy_intp lengths[] = {{0{unknown}}};
    Given given[{given}];
    (void)self;
    if (!take_all(args, count, {count}, expected, given, lengths)) {{
        return NULL;
    }}
    PyThreadState *others = {many} ? PyEval_SaveThread() : NULL;
{call}
    entries->leave();
    if (others) {{
        PyEval_RestoreThread(others);
    }}
{answer}
}}
"""

MODULE = """static PyMethodDef methods[] = {{
{methods}
    {{NULL, NULL, 0, NULL}},
}};

static struct PyModuleDef definition = {{
    PyModuleDef_HEAD_INIT, "{module}", NULL, -1, methods, NULL, NULL, NULL, NULL,
}};

PyMODINIT_FUNC PyInit_{module}(void)
{{
    import_array();
    {initialize}
    const Level levels[] = {{
{levels}
        {{NULL, 0, NULL}},
    }};
    return made(&definition, levels, "{names}", "{sources}");
}}
"""


class Extension:
    """Text of the file with the entries, beside that of the kernels."""

    def __init__(self, file: CFile, module: str, sources: str) -> None:
        self.file, self.module, self.sources = file, module, sources
        file.exported = False
        self.bodies = file.bodies()

    def kernels(self) -> str:
        """The kernels, and their entries in the table of a level."""
        names = ", ".join(e.name for e in self.file.entries)
        head = "\n".join(['#include "kernels.h"', *self.file.definitions(self.bodies)])
        table = _lines([f"const Entries TABLE = {{leave, {names}}};"])
        return f"{head}{self.bodies}\n{LEAVE}\n\n{table}\n"

    def header(self) -> str:
        """Types that both files share."""
        lines = ["typedef struct {", "    void (*leave)(void);"]
        for e in self.file.entries:
            parameters = ", ".join(self.file.parameters(e)) or "void"
            declared = self.file.declaration(e.returned, f"(*{e.name})({parameters})")
            lines += folded(f"{declared};", 4)
        lines += ["} Entries;", *(f"extern const Entries entries_{level};" for level in LEVELS), ""]
        return "\n".join([*INCLUDES, *self.file.types(), "", *lines])

    def doors(self) -> str:
        """The functions that Python calls, and what it asks for at import."""
        methods, levels = list[str](), list[str]()
        for e in self.file.entries:  # by names that pickle takes
            public = f"{e.source.module.__name__}.{e.source.name}".replace(".", "__")
            call = f"(PyCFunction)(void (*)(void))py_{e.name}"
            methods.append(f'{{"{public}", {call}, METH_FASTCALL, NULL}},')
        for level, (_, features) in LEVELS.items():
            has = " && ".join(f'__builtin_cpu_supports("{x}")' for x in features.split())
            levels.append(f'{{"{level}", {has or 1}, &entries_{level}}},')
        module = MODULE.format(
            module=self.module,
            methods=_lines(methods, 4),
            initialize="__builtin_cpu_init();" if X86 else "",
            levels=_lines(levels, 8),
            names=", ".join(LEVELS),
            sources=self.sources,
        )
        return "\n".join([SHARED.read_text(), *map(self._door, self.file.entries), module])

    def _door(self, e: Instance) -> str:
        """The function for an entry."""
        names = ["0", *lengths_of(e.entered)]
        pairs = zip(e.source.parameters, e.entered, strict=True)
        taken = [one for name, t in pairs for one in _taken(name, t)]
        numbers = [t for _, t in taken if not isinstance(t, Tuple)]
        handed = [f"(int)lengths[{names.index(x)}]" for x in e.lengths()]
        handed += [f"given[{i}].{MEMBERS.get(str(t), 'array')}" for i, t in enumerate(numbers)]
        call = f"entries->{e.name}({', '.join(handed)});"
        if e.returned is not None:
            call = f"{self.file.declaration(e.returned, 'found')} = {call}"
        return DOOR.format(
            name=e.name,
            expected=_lines((f"{{{_expected(name, t, names)}}}," for name, t in taken), 8),
            unknown=", -1" * len(names[1:]),
            given=len(numbers),
            count=len(e.entered),
            many=f"lengths[{names.index('poses')}] >= {MANY}" if "poses" in names else "0",
            call=_lines([call], 4),
            answer=_lines([f"return {_answer(e.returned)};"], 4),
        )


def _lines(statements: Iterable[str], indent: int = 0) -> str:
    return "\n".join(line for s in statements for line in folded(s, indent))


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
    letters = "".join({"float": "d", "int": "i", "bool": "N"}[str(x)] for x in found.values())
    values = (f"PyBool_FromLong({c})" if x == "bool" else c for c, x in found.items())
    form = f"({letters})" if fields else letters
    return f'Py_BuildValue("{form}", {", ".join(values)})'
