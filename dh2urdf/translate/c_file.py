"""One C file: constants, tuples, records, helpers, and the kernels' bodies."""

import ast
import inspect
import re
import sys
from collections import Counter
from collections.abc import Callable
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from dh2urdf.translate.c_text import (
    ELEMENT,
    HELPERS,
    LIBRARY,
    NUMBER,
    RESERVED,
    comment,
    folded,
    number,
    table,
)
from dh2urdf.translate.source import Source, every, source_of, stored
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import Array, Record, Tuple, Type, type_of_value
from dh2urdf.translate.values import Instance

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
    """Kernels, each once for each list of argument types, and what they share."""

    def __init__(self, prefix: str = "") -> None:
        self.prefix = prefix
        """Before the names of all that the file defines."""
        self.exported = True
        """Whether the entries are seen from outside the file."""
        self.entries: list[Instance] = []
        """The kernels that others may call, in the order in which they were added."""
        self.order: list[Instance] = []
        """All kernels, those that others call before these."""
        self._instances: dict[tuple[Source, tuple[Type, ...]], Instance] = {}
        self._open: set[Source] = set()
        self._names: dict[str, object] = {}
        self._helpers: set[str] = set()
        self._constants: dict[tuple[str, str], tuple[str, object, str]] = {}
        self._structs: dict[Tuple | Record, tuple[str, list[str]]] = {}

    def add_entry(self, function: Callable[..., Any], arguments: list[Type]) -> Instance:
        """A kernel that others may call, and all that it calls."""
        self.entries.append(self.instance(source_of(function), tuple(arguments)))
        return self.entries[-1]

    def instance(self, source: Source, given: tuple[Type, ...]) -> Instance:
        """A kernel for some types of arguments; where it asks for no length, for any."""
        if (source, given) not in self._instances:
            if source in self._open:
                source.refuse(source.tree, "a kernel that calls itself", "a loop")
            self._open.add(source)
            made = Instance(source, given)
            body = Body(self, made)
            made.body = body.body()
            self._open.remove(source)
            loose = {p: _loose(t) for p, t in zip(source.parameters, given, strict=True)}
            loose.update((p, body.values[p].type) for p in made.asked & set(loose))
            made.arguments = tuple(loose.values())
            kinds = {body.values[p].text: t for p, t in loose.items()}
            made.parameters = [(c, kinds.get(c, t)) for c, t in made.parameters]
            self._instances[source, given] = self._kept(made)
        return self._instances[source, given]

    def _kept(self, made: Instance) -> Instance:
        key = made.source, made.arguments
        if key not in self._instances:
            made.name = self._unique(
                made.source.name.lstrip("_"), made.source.module.__name__, made
            )
            self.order.append(made)
            self._instances[key] = made
        return self._instances[key]

    def text(self, header: str = "") -> str:
        """The whole file, to be compiled by itself."""
        out = comment(header) if header else []
        return "\n".join([*out, *INCLUDES, *self.types(), *self.definitions()]) + self.bodies()

    def bodies(self) -> str:
        """The functions."""
        return "\n\n" + "\n\n".join(map(self._function, self.order)) + "\n"

    def _function(self, instance: Instance) -> str:
        """A function with its docstring; what has no loop may become a part of its callers."""
        head = f"{instance.name}({', '.join(self.parameters(instance)) or 'void'})"
        head = self.declaration(instance.returned, head)
        named = Counter(re.findall(r"\w+", head + instance.body))
        given = [*instance.lengths(), *(c for c, _ in instance.parameters)]
        unused = [f"    (void){c};" for c in given if named[c] == 1]
        if not (self.exported and instance in self.entries):
            loops = any(isinstance(s, ast.For | ast.While) for s in every(instance.source.body))
            head = f"static {'' if loops else 'inline '}{head}"
        doc = comment(instance.source.doc) if instance.source.doc else []
        return "\n".join([*doc, *folded(head), "{", *unused, instance.body, "}"])

    def types(self) -> list[str]:
        """Structs of records and tuples."""
        return [
            line
            for name, fields in self._structs.values()
            for line in ["", "typedef struct {", *(f"    {f};" for f in fields), f"}} {name};"]
        ]

    def definitions(self) -> list[str]:
        """Helpers and constants."""
        out, said = [LANES, "", *(HELPERS[name] for name in HELPERS if name in self._helpers)], ""
        for name, value, doc in self._constants.values():
            if doc and doc != said:
                out += ["", *comment(doc)]
            out.append(_constant(name, value))
            said = doc
        return out

    def _unique(self, name: str, module: str, key: object) -> str:
        """A name of the file for a key."""
        room = module.split(".")[-2:]
        more = [f"{name}_{i}" for i in range(2, 999)]
        for candidate in (name, f"{name}_{room[-1]}", f"{name}_{'_'.join(room)}", *more):
            c = self.prefix + candidate
            if c not in RESERVED | LIBRARY | set(HELPERS) and self._names.setdefault(c, key) == key:
                return c
        raise AssertionError(name)

    def helper(self, name: str) -> str:
        """Name of a helper, which the file gets."""
        self._helpers.add(name)
        return name

    def constant(self, source: Source, name: str) -> str:
        """Name of a module's constant, defined when it is first used."""
        home, doc = _home(source.module, name)
        key = home.__name__, name
        if key not in self._constants:
            c = self._unique(name.lstrip("_").upper(), home.__name__, key)
            self._constants[key] = c, source.stands_for(name), doc
        return self._constants[key][0]

    def declaration(self, t: Type | None, name: str, storage: bool = False) -> str:
        """A name with its type; ``storage``: the array itself, not where it is."""
        match t:
            case Array():
                base = "const " * t.constant + self._element(t)
                inner = "".join(f"[{d}]" for d in t.shape[1:])
                if storage:
                    return f"{base} {name}[{t.shape[0]}]{inner}"
                return f"{base} (*{name}){inner}" if inner else f"{base} *{name}"
            case Record():
                return f"{self._record(t)} *{name}"
            case Tuple():
                return f"{self.tuple_name(t)} {name}"
        return f"{'void' if t is None else NUMBER[t]} {name}"

    def parameters(self, instance: Instance) -> list[str]:
        """Declarations of all that an instance is handed."""
        return [f"int {length}" for length in instance.lengths()] + [
            self.declaration(t, c, isinstance(t, Array) and isinstance(t.shape[0], int))
            for c, t in instance.parameters
        ]

    def _element(self, t: Array) -> str:
        return ELEMENT[t.element] if isinstance(t.element, str) else self._record(t.element)

    def _record(self, t: Record) -> str:
        if t not in self._structs:
            fields = [
                self.declaration(x, key, storage=True)
                if isinstance(x, Array)
                else f"{ELEMENT[x]} {key}"
                for key, x in t.fields().items()
            ]
            self._structs[t] = self._unique(t.name, "", t), fields
        return self._structs[t][0]

    def tuple_name(self, t: Tuple) -> str:
        """Name of the struct for a tuple of numbers."""
        if t not in self._structs:
            fields = [self.declaration(x, f"f{i}") for i, x in enumerate(t.items)]
            letters = "".join(x[0] if isinstance(x, str) else "t" for x in t.items)
            runs = (m[0] for m in re.finditer(r"(.)\1*", letters))
            short = "".join(run[0] + (str(len(run)) if len(run) > 1 else "") for run in runs)
            self._structs[t] = self._unique(f"tuple_{short}", "", t), fields
        return self._structs[t][0]


def _loose(t: Type) -> Type:
    """A type without the first length, of which a kernel may not ask."""
    return t.first() if isinstance(t, Array) and isinstance(t.element, str) else t


def _constant(name: str, value: object) -> str:
    if isinstance(value, np.ndarray | tuple):
        return table(name, np.asarray(value))
    return f"static const {NUMBER[str(type_of_value(value))]} {name} = {number(value)};"


def _home(module: ModuleType, name: str) -> tuple[ModuleType, str]:
    """The module that defines a constant, and what it says of it there."""
    body = _tree(module).body
    for s, after in zip(body, [*body[1:], None], strict=True):
        if isinstance(s, ast.ImportFrom) and any(a.name == name for a in s.names):
            return _home(sys.modules[str(s.module)], name)
        if isinstance(s, ast.Assign) and name in stored([s]):
            if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
                return module, str(after.value.value)
            return module, ""
    return module, ""


@cache
def _tree(module: ModuleType) -> ast.Module:
    return ast.parse(inspect.getsource(module))
