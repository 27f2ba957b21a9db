"""What the kernels of a C file share: names, constants, records, tuples, and small helpers."""

import ast
import inspect
import re
import sys
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from types import ModuleType

from dh2urdf.translate import c_text
from dh2urdf.translate.c_text import ELEMENT, HELPERS, NUMBER
from dh2urdf.translate.source import Source, stored
from dh2urdf.translate.types import Array, Record, Tuple, Type, lengths_of


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

    def __init__(self) -> None:
        self._names: dict[str, object] = {}
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

    def definitions(self, text: str) -> list[str]:
        """Helpers and constants that a text names."""
        words = set(re.findall(r"\w+", re.sub(r"(?s)/\*.*?\*/", "", text)))
        out = ["", c_text.HEAD, "", *(HELPERS[name] for name in HELPERS if name in words)]
        said = ""
        for name, value, doc in self._constants.values():
            if name in words:
                out += ["", *c_text.comment(doc)] if doc and doc != said else []
                out.append(c_text.constant(name, value))
                said = doc
        return out

    def unique(self, name: str, module: str, key: object) -> str:
        """A name of the file for a key."""
        room = module.split(".")[-2:]
        more = [f"{name}_{i}" for i in range(2, 999)]
        for c in (name, f"{name}_{room[-1]}", f"{name}_{'_'.join(room)}", *more):
            taken = c in c_text.RESERVED | c_text.LIBRARY or c in HELPERS
            if not taken and self._names.setdefault(c, key) == key:
                return c
        raise AssertionError(name)

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
            case Array(element=element):
                kind = ELEMENT[element] if isinstance(element, str) else self.struct(element)
                base = f"{'const ' * t.constant}{kind}"
                inner = "".join(f"[{d}]" for d in t.shape[1:])
                if storage:
                    return f"{base} {name}[{t.shape[0]}]{inner}"
                return f"{base} (*{name}){inner}" if inner else f"{base} *{name}"
            case Record():
                return f"{self.struct(t)} *{name}"
            case Tuple():
                return f"{self.struct(t)} {name}"
            case None:
                return f"void {name}"
        return f"{(ELEMENT if storage else NUMBER)[t]} {name}"

    def struct(self, t: Tuple | Record) -> str:
        """Name of the struct for a tuple of numbers, or for a record."""
        if t not in self._structs:
            storage = isinstance(t, Record)
            fields = [self.declaration(x, key, storage) for key, x in t.fields().items()]
            self._structs[t] = self.unique(t.name, "", t), fields
        return self._structs[t][0]


@cache
def _home(module: ModuleType, name: str) -> tuple[ModuleType, str]:
    """The module that defines a constant, and what it says of it there."""
    for s, after in pairwise([*_tree(module).body, ast.Pass()]):
        if isinstance(s, ast.ImportFrom) and any(a.name == name for a in s.names):
            return _home(sys.modules[str(s.module)], name)
        if isinstance(s, ast.Assign) and name in stored([s]):
            match after:
                case ast.Expr(value=ast.Constant(value=str(doc))):
                    return module, doc
    return module, ""


@cache
def _tree(module: ModuleType) -> ast.Module:
    return ast.parse(inspect.getsource(module))
