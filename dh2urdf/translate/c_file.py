"""One C file: constants, records, tuples, helpers, and the kernels' bodies."""

import ast
import inspect
import re
import sys
from types import ModuleType
from typing import Any

import numpy as np

from dh2urdf.translate.c_text import (
    ELEMENT,
    HELPERS,
    NEEDS,
    NUMBER,
    RESERVED,
    comment,
    number,
    table,
)
from dh2urdf.translate.inference import Inference, Instance
from dh2urdf.translate.source import Source, stored
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import Array, Kernel, Record, Tuple, Type, is_sized_late

LANES = """
/* A loop whose turns do not depend on one another. */
#if defined(__clang__)
#define SIDE_BY_SIDE _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define SIDE_BY_SIDE _Pragma("GCC ivdep")
#else
#define SIDE_BY_SIDE
#endif"""

INCLUDES = ["", *(f"#include <{name}.h>" for name in ("math", "stdbool", "stdint", "string"))]


class CFile:
    """Names and definitions that the bodies share."""

    def __init__(self, prefix: str = "") -> None:
        self.inference, self.prefix = Inference(), prefix
        self.exported = True
        """Whether the entries are seen from outside the file."""
        self.helpers: set[str] = set()
        self.functions: set[str] = set()
        self._names: dict[str, Any] = {}
        self._constants: dict[tuple[str, str], tuple[str, Any, str]] = {}
        self._homes: dict[tuple[str, str], tuple[str, str]] = {}
        self._tuples: dict[Tuple, tuple[str, list[str]]] = {}
        self._records: dict[str, Record] = {}

    @property
    def entries(self) -> list[Instance]:
        """The kernels that others may call, in the order in which they were added."""
        return self.inference.entries

    def add_entry(self, function: Any, arguments: list[Type]) -> Instance:
        """A kernel that others may call, and all that it calls."""
        return self.inference.add_entry(function, arguments)

    def text(self, header: str = "") -> str:
        """The whole file, to be compiled by itself."""
        functions = self.bodies()
        out = comment(header) if header else []
        return "\n".join([*out, *INCLUDES, *self.types(), *self.definitions()]) + functions

    def bodies(self) -> str:
        """The functions; what they need is known after them."""
        for instance in self.inference.order:
            home = instance.source.module.__name__
            instance.name = self._unique(instance.source.name.lstrip("_"), home, instance)
        self.functions = {instance.name for instance in self.inference.order}
        bodies = [Body(self, instance).text() for instance in self.inference.order]
        return "\n\n" + "\n\n".join(bodies) + "\n"

    def types(self) -> list[str]:
        """Records and tuples."""
        out: list[str] = []
        for record in self._records.values():
            out += ["", *_struct(self.prefix + record.name, _fields(record))]
        for name, fields in self._tuples.values():
            out += ["", *_struct(name, fields)]
        return out

    def definitions(self) -> list[str]:
        """Helpers and constants."""
        out = [LANES, "", *(text for name, text in HELPERS.items() if name in self.helpers)]
        for name, value, doc in self._constants.values():
            out += ["", *comment(doc)] if doc else []
            out.append(_constant(name, value))
        return out

    def _unique(self, name: str, module: str, key: Any) -> str:
        """A name of the file for a key."""
        room = module.split(".")[-2:]
        more = [f"{name}_{i}" for i in range(2, 999)]
        for candidate in (name, f"{name}_{room[-1]}", f"{name}_{'_'.join(room)}", *more):
            if self._names.setdefault(self.prefix + candidate, key) == key:
                return self.prefix + candidate
        raise AssertionError(name)

    def helper(self, name: str) -> str:
        """Name of a helper, which the file gets."""
        self.helpers |= {name, NEEDS.get(name, name)}
        return name

    def constant(self, source: Source, node: ast.Name) -> str:
        """Name of a module's constant, defined when it is first used."""
        place, _, name = node.id.rpartition("::")
        module = sys.modules[place] if place else source.module
        asked = module.__name__, name
        if asked not in self._homes:
            home, doc = _home(module, name)
            self._homes[asked] = key = home.__name__, name
            if key not in self._constants:
                c = self._unique(name.lstrip("_").upper(), home.__name__, key)
                self._constants[key] = c, source.stands_for(node), doc
        return self._constants[self._homes[asked]][0]

    def declaration(self, t: Type, name: str, storage: bool = False) -> str:
        """A name with its type; ``storage``: the array itself, not where it is."""
        if isinstance(t, Array):
            record = isinstance(t.element, Record)
            base = self._record(t.element) if record else ELEMENT[t.element]  # type: ignore
            base = ("const " if t.constant else "") + base
            inner = "".join(f"[{d}]" for d in t.shape[1:])
            if storage:
                return f"{base} {name}[{t.shape[0]}]{inner}"
            return f"{base} (*{name}){inner}" if inner else f"{base} *{name}"
        if isinstance(t, Record):
            return f"{self._record(t)} *{name}"
        if isinstance(t, Tuple):
            return f"{self.tuple_name(t)} {name}"
        return f"{NUMBER[t] if isinstance(t, str) else 'void'} {name}"

    def local(self, instance: Instance, name: str) -> str:
        """A name of a kernel in C: what C, a function or a length has taken is marked."""
        taken = name in RESERVED or name in self.functions or name in instance.lengths()
        return f"{name}_" if taken else name.replace("::", "_")

    def parameters(self, instance: Instance) -> list[str]:
        """Declarations of all that an instance is handed."""
        out = [f"int {length}" for length in instance.lengths()]
        for p, t in zip(instance.source.parameters, instance.arguments, strict=True):
            if not isinstance(t, Kernel):
                sized = isinstance(t, Array) and isinstance(t.shape[0], int)
                out.append(self.declaration(t, self.local(instance, p), storage=sized))
        return out

    def _record(self, t: Record) -> str:
        self._records[t.name] = t
        return self.prefix + t.name

    def tuple_name(self, t: Tuple) -> str:
        """Name of the struct for a tuple."""
        if t not in self._tuples:
            fields = [
                f"void *f{i}" if is_sized_late(x) else self.declaration(x, f"f{i}")
                for i, x in enumerate(t.items)
            ]
            letters = "".join(x[0] if isinstance(x, str) else "p" for x in t.items)
            runs = re.finditer(r"(.)\1*", letters)
            short = "".join(m[1] + (str(len(m[0])) if len(m[0]) > 1 else "") for m in runs)
            self._tuples[t] = self._unique(f"tuple_{short}", "", t), fields
        return self._tuples[t][0]


def _fields(record: Record) -> list[str]:
    out = []
    for key in record.dtype.names or ():
        t = record.field_type(key)
        element = t.element if isinstance(t, Array) else t
        sizes = "".join(f"[{d}]" for d in t.shape) if isinstance(t, Array) else ""
        out.append(f"{ELEMENT[str(element)]} {key}{sizes}")
    return out


def _struct(name: str, fields: list[str]) -> list[str]:
    return ["typedef struct {", *(f"    {f};" for f in fields), f"}} {name};"]


def _constant(name: str, value: Any) -> str:
    if isinstance(value, np.ndarray | tuple):
        return table(name, np.asarray(value))
    text = number(value)
    return f"#define {name} {f'({text})' if text.startswith('-') else text}"


def _home(module: ModuleType, name: str) -> tuple[ModuleType, str]:
    """The module that defines a constant, and what it says of it there."""
    tree = ast.parse(inspect.getsource(module))
    for s, after in zip(tree.body, [*tree.body[1:], None], strict=True):
        if isinstance(s, ast.ImportFrom) and any(a.name == name for a in s.names):
            return _home(sys.modules[str(s.module)], name)
        if isinstance(s, ast.Assign) and name in stored([s]):
            if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
                return module, str(after.value.value)
            return module, ""
    return module, ""
