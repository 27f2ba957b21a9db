"""What the kernels of a C file share: names, constants, records, tuples, and small helpers."""

import ast
import inspect
import re
import sys
from dataclasses import dataclass, field
from functools import cache
from types import ModuleType

import numpy as np

from dh2urdf.translate.c_text import (
    ELEMENT,
    HELPERS,
    LANES,
    LIBRARY,
    NUMBER,
    RESERVED,
    comment,
    number,
    table,
)
from dh2urdf.translate.source import Source, stored
from dh2urdf.translate.types import Array, Record, Tuple, Type, lengths_of, type_of_value


@dataclass(eq=False)
class Instance:
    """A kernel for one list of argument types."""

    source: Source
    arguments: tuple[Type, ...]
    name: str = ""
    returned: Type | None = None
    parameters: list[tuple[str, Type]] = field(default_factory=list)
    """Those of C, where tuples with arrays are taken apart."""
    asked: set[str] = field(default_factory=set)
    """Parameters whose first length the kernel asks for."""
    body: str = ""
    entered: tuple[Type, ...] = ()
    """Types of an entry's arguments as they are declared, with all lengths."""

    def lengths(self) -> list[str]:
        """Names of the lengths that it is handed."""
        return lengths_of(self.arguments)


class Definitions:
    """Definitions of a file, each made when it is first asked for."""

    def __init__(self, prefix: str = "") -> None:
        self.prefix = prefix
        """Before the names of all that the file defines."""
        self._names: dict[str, object] = {}
        self._helpers: set[str] = set()
        self._constants: dict[tuple[str, str], tuple[str, object, str]] = {}
        self._structs: dict[Tuple | Record, tuple[str, list[str]]] = {}

    def instance(self, source: Source, given: tuple[Type, ...]) -> Instance:
        """A kernel for some types of arguments."""
        raise NotImplementedError

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

    def unique(self, name: str, module: str, key: object) -> str:
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
            c = self.unique(name.lstrip("_").upper(), home.__name__, key)
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
            self._structs[t] = self.unique(t.name, "", t), fields
        return self._structs[t][0]

    def tuple_name(self, t: Tuple) -> str:
        """Name of the struct for a tuple of numbers."""
        if t not in self._structs:
            fields = [self.declaration(x, f"f{i}") for i, x in enumerate(t.items)]
            letters = "".join(x[0] if isinstance(x, str) else "t" for x in t.items)
            runs = (m[0] for m in re.finditer(r"(.)\1*", letters))
            short = "".join(run[0] + (str(len(run)) if len(run) > 1 else "") for run in runs)
            self._structs[t] = self.unique(f"tuple_{short}", "", t), fields
        return self._structs[t][0]


def _constant(name: str, value: object) -> str:
    if isinstance(value, np.ndarray | tuple):
        return table(name, np.asarray(value))
    return f"static const {NUMBER[str(type_of_value(value))]} {name} = {number(value)};"


@cache
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
