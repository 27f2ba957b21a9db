"""The entries as functions of a Python extension: arrays checked once, at the door.

The extension needs the stable interfaces of Python and of NumPy only. Each
level of processor is the same C, compiled once more; the table of its entries is chosen when the
extension is imported: the best that the processor has, or the one that ``DH2URDF_LEVEL`` names.
"""

import platform

from dh2urdf.translate.c_file import INCLUDES, CFile
from dh2urdf.translate.c_text import folded
from dh2urdf.translate.definitions import Instance
from dh2urdf.translate.types import Array, Record, Tuple, Type

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

KINDS = {"float": "NPY_DOUBLE", "int": "NPY_INT64", "bool": "NPY_BOOL"}

LEAVE = r"""
#ifdef __AVX__
#include <immintrin.h>
#endif

/* Clear the wide registers, as code for old ones asks for; compilers forget it at times. */
static void leave(void)
{
#ifdef __AVX__
    _mm256_zeroupper();
#endif
}
"""

COMMON = r"""
static int refuse(const char *name, int dimensions)
{
    PyErr_Format(PyExc_TypeError,
        "%s: expected an array in C order, of %d dimensions and the kernel's kind of numbers",
        name, dimensions);
    return 0;
}

/* Whether an object is an array in C order with a number of dimensions and a kind of elements. */
static int fits(PyObject *given, const char *name, int dimensions, int kind)
{
    PyArrayObject *a = (PyArrayObject *)given;
    return (PyArray_Check(given) && PyArray_NDIM(a) == dimensions && PyArray_TYPE(a) == kind &&
        PyArray_IS_C_CONTIGUOUS(a)) || refuse(name, dimensions);
}

/* Whether an object is a tuple of a number of values. */
static int travels(PyObject *given, const char *name, Py_ssize_t items)
{
    if (PyTuple_Check(given) && PyTuple_Size(given) == items) {
        return 1;
    }
    PyErr_Format(PyExc_TypeError, "%s: expected a tuple of %zd", name, items);
    return 0;
}

static int differs(const char *name, Py_ssize_t found, Py_ssize_t expected)
{
    if (found == expected) {
        return 0;
    }
    PyErr_Format(PyExc_ValueError, "%s: a length is %zd, expected %zd", name, found, expected);
    return 1;
}
"""


class Extension:
    """Text of the file with the entries, beside that of the kernels."""

    def __init__(self, file: CFile, module: str, sources: str) -> None:
        self.file, self.module, self.sources = file, module, sources
        self.entries = file.entries

        file.exported = False
        self.bodies = file.bodies()

    def kernels(self) -> str:
        """The kernels, and their entries in the table of a level."""
        names = ", ".join(e.name for e in self.entries)
        lines = ['#include "kernels.h"', *self.file.definitions()]
        table = "\n".join(folded(f"const Entries TABLE = {{leave, {names}}};"))
        return "\n".join(lines) + f"{self.bodies}{LEAVE}\n{table}\n"

    def header(self) -> str:
        """Types that both files share."""
        lines = ["typedef struct {", "    void (*leave)(void);"]
        for e in self.entries:
            parameters = ", ".join(self.file.parameters(e)) or "void"
            declared = self.file.declaration(e.returned, f"(*{e.name})({parameters})")
            lines += folded(f"{declared};", 4)
        lines += ["} Entries;", *(f"extern const Entries entries_{level};" for level in LEVELS), ""]
        return "\n".join([*INCLUDES, *self.file.types(), "", *lines])

    def doors(self) -> str:
        """The functions that Python calls."""
        out = ["#define PY_SSIZE_T_CLEAN", "#define Py_LIMITED_API 0x030B0000"]
        out += ["#define NPY_NO_DEPRECATED_API NPY_1_20_API_VERSION"]
        names = ("Python", "stdlib", "string", "numpy/arrayobject")
        out += [*(f"#include <{name}.h>" for name in names), '#include "kernels.h"']
        out += [COMMON, "static const Entries *entries;"]
        out += [self._door(e) for e in self.entries]
        out.append("static PyMethodDef methods[] = {")
        for e in self.entries:
            call = f"(PyCFunction)(void (*)(void))py_{e.name}"
            out.append(f'    {{"{_public(e)}", {call}, METH_FASTCALL, NULL}},')
        out += ["    {NULL, NULL, 0, NULL},", "};", ""]
        return "\n".join(out) + self._module()

    def _module(self) -> str:
        lines = []
        for level, (_, features) in LEVELS.items():
            has = [f'__builtin_cpu_supports("{f}")' for f in features.split()]
            test = " && ".join([f'is_wanted("{level}")', *has])
            lines += [f"    if (!level && {test}) {{"]
            lines += [
                f'        level = "{level}";',
                f"        entries = &entries_{level};",
                "    }",
            ]
        choose = "\n".join(lines)
        return f"""
static struct PyModuleDef definition = {{
    PyModuleDef_HEAD_INIT, "{self.module}", NULL, -1, methods, NULL, NULL, NULL, NULL,
}};

static int is_wanted(const char *level)
{{
    const char *wanted = getenv("DH2URDF_LEVEL");
    return !wanted || !*wanted || !strcmp(wanted, level);
}}

PyMODINIT_FUNC PyInit_{self.module}(void)
{{
    import_array();
{"    __builtin_cpu_init();" if X86 else ""}
    const char *level = NULL;
{choose}
    if (!level) {{
        PyErr_Format(PyExc_ValueError, "DH2URDF_LEVEL: expected one of {", ".join(LEVELS)} that "
            "this processor has, got %s", getenv("DH2URDF_LEVEL"));
        return NULL;
    }}
    PyObject *module = PyModule_Create(&definition);
    if (module && (PyModule_AddStringConstant(module, "SOURCES", "{self.sources}") < 0
            || PyModule_AddStringConstant(module, "COMPILER", __VERSION__) < 0
            || PyModule_AddStringConstant(module, "LEVEL", level) < 0)) {{
        Py_DECREF(module);
        return NULL;
    }}
    return module;
}}
"""

    def _door(self, e: Instance) -> str:
        names = e.source.parameters
        lines = [f"static PyObject *py_{e.name}(PyObject *self, PyObject *const *args,"]
        lines += ["    Py_ssize_t given)", "{", "    (void)self;"]
        lines += [f"    Py_ssize_t {x} = -1;" for x in e.lengths()]
        lines += [f"    if (given != {len(names)}) {{"]
        lines += [f'        PyErr_SetString(PyExc_TypeError, "{len(names)} arguments");']
        lines += ["        return NULL;", "    }"]
        handed: list[str] = []
        checks: list[str] = []
        for i, (name, t) in enumerate(zip(names, e.arguments, strict=True)):
            text, value = self._taken(name, f"args[{i}]", t, f"a{i}", checks)
            lines += text
            handed.append(value)
        lines += checks
        bound = [f"(int){x}" for x in e.lengths()]
        call = f"entries->{e.name}({', '.join([*bound, *handed])})"
        if e.returned is not None:
            call = f"{self.file.declaration(e.returned, 'found')} = {call}"
        many = "poses" if "poses" in e.lengths() else ""
        if many and e.returned is None:
            lines += [f"    if (poses >= {MANY}) {{", "        Py_BEGIN_ALLOW_THREADS"]
            lines += [f"        {call};", "        Py_END_ALLOW_THREADS", "    } else {"]
            lines += [f"        {call};", "    }"]
        else:
            lines.append(f"    {call};")
        lines.append("    entries->leave();")
        lines += [f"    return {_answer(e.returned, 'found')};", "}", ""]
        bare = ((line.lstrip(), line) for line in lines)
        return "\n".join(x for text, line in bare for x in folded(text, len(line) - len(text)))

    def _taken(
        self, name: str, given: str, t: Type, at: str, checks: list[str]
    ) -> tuple[list[str], str]:
        """Lines that take an argument, and the expression that stands for it.

        What compares lengths goes to ``checks``: it waits until all arguments are there.
        """
        if t == "float":
            lines = [f"    const double {at} = PyFloat_AsDouble({given});"]
            return [*lines, *_failed(f"{at} == -1.0 && PyErr_Occurred()")], at
        if t == "int":
            lines = [f"    const long {at} = PyLong_AsLong({given});"]
            return [*lines, *_failed(f"{at} == -1 && PyErr_Occurred()")], f"(int){at}"
        if t == "bool":
            lines = [f"    const int {at} = PyObject_IsTrue({given});"]
            return [*lines, *_failed(f"{at} < 0")], f"{at} != 0"
        if isinstance(t, Tuple):
            lines = _failed(f'!travels({given}, "{name}", {len(t.items)})')
            values = []
            for i, item in enumerate(t.items):
                part = f"PyTuple_GetItem({given}, {i})"
                more, value = self._taken(f"{name}[{i}]", part, item, f"{at}_{i}", checks)
                lines += more
                values.append(value)
            return lines, ", ".join(values)
        assert isinstance(t, Array)
        kind = "NPY_VOID" if isinstance(t.element, Record) else KINDS[t.element]
        lines = [f"    PyArrayObject *{at} = (PyArrayObject *){given};"]
        lines += _failed(f'!fits({given}, "{name}", {len(t.shape)}, {kind})')
        if isinstance(t.element, Record):
            size = t.element.dtype.itemsize
            checks += _failed(f'differs("{name}: a record", PyArray_ITEMSIZE({at}), {size})')
        for k, d in enumerate(t.shape):
            found = f"PyArray_DIM({at}, {k})"
            if isinstance(d, str) and d.isidentifier():
                lines += [f"    {d} = {d} < 0 ? {found} : {d};"]
            if d is not None:
                checks += _failed(f'differs("{name}", {found}, {d})')
        return lines, f"PyArray_DATA({at})"


def _failed(test: str) -> list[str]:
    return [f"    if ({test}) {{", "        return NULL;", "    }"]


def _public(e: Instance) -> str:
    """Name of an entry for Python: one that pickle takes, with its module for namesakes."""
    return f"{e.source.module.__name__}.{e.source.name}".replace(".", "__")


def _answer(t: Type | None, name: str) -> str:
    """A value for Python."""
    if t is None:
        return "Py_NewRef(Py_None)"
    if isinstance(t, Tuple):
        letters = "".join({"float": "d", "int": "i", "bool": "N"}[str(x)] for x in t.items)
        parts = [
            f"PyBool_FromLong({name}.f{i})" if x == "bool" else f"{name}.f{i}"
            for i, x in enumerate(t.items)
        ]
        return f'Py_BuildValue("({letters})", {", ".join(parts)})'
    return {"float": "PyFloat_FromDouble", "int": "PyLong_FromLong", "bool": "PyBool_FromLong"}[
        str(t)
    ] + f"({name})"
