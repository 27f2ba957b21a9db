"""What the kernels of a C file share, and pieces of its text: names, constants, structs, lines."""

import ast
import inspect
import re
import sys
import textwrap
from collections.abc import Callable
from functools import cache
from itertools import accumulate, pairwise
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from dh2urdf.translate.source import Source, named
from dh2urdf.translate.types import ELEMENTS, Array, Record, Tuple, Type

WIDTH = 100

_RESERVED = """
auto bool case char const default do double enum extern false far float goto inline int long near
register restrict short signed sizeof static struct switch true typedef union unsigned void volatile
and asm bitand bitor catch class compl delete explicit export friend mutable namespace new not
operator or private protected public template this throw try typename using virtual wchar_t xor
"""
RESERVED = {*_RESERVED.split()}
"""Words of C and of C++ that no name is."""

_LIBRARY = """
abs acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs
fdim floor fma fmax fmin fmod free frexp gamma hypot index isfinite isinf isnan j0 j1 jn ldexp
lgamma log log10 log1p log2 logb lrint lround memcpy memset modf nan nearbyint pow remainder rint
round scalbn signbit sin sincos sinh sqrt tan tanh tgamma time trunc write y0 y1 yn
"""
LIBRARY = {*_LIBRARY.split(), "leave", "TABLE"}
"""What C and the file define, whose names no kernel and no constant has."""

NUMBER = {"float": "double", "int": "int", "bool": "bool"}
ELEMENT = {"float": "double", "int": "int64_t", "bool": "bool"}

HEAD, *_FUNCTIONS = Path(__file__).with_name("support.h").read_text().strip().split("\n\n")
HELPERS = {re.findall(r"\w+(?=\()", text)[0]: text for text in _FUNCTIONS}
"""As Python has them: the first of two that are equal, division towards minus infinity."""


def number(value: object) -> str:
    """A number, or a table, that reads back as the same."""
    text = repr(np.asarray(value).tolist())
    for python, c in {"[": "{", "]": "}", "inf": "INFINITY", "nan": "NAN"}.items():
        text = text.replace(python, c)
    return text.replace("True", "true").replace("False", "false")


def comment(text: str) -> list[str]:
    """A docstring as a comment, its markup taken off."""
    text = re.sub(r":[a-z]+:`~?\.?(?:[\w.]*\.)?(\w+)`", r"\1", text)
    lines = text.replace("``", "").replace("*/", "* /").strip().split("\n")
    if len(lines) == 1:
        return [f"/* {lines[0]} */"]
    return [f"/* {lines[0]}", *(f" * {line}".rstrip() for line in lines[1:]), " */"]


def folded(text: str, indent: int = 0) -> list[str]:
    """A statement in lines that are not too long, broken where the fewest brackets are open."""
    pad, out = " " * indent, list[str]()
    if text.startswith("/*"):
        return textwrap.wrap(text, WIDTH, initial_indent=pad, subsequent_indent=pad + " * ")
    while len(pad) + len(text) > WIDTH:
        depths = [*accumulate((x in "([{") - (x in ")]}") for x in text[: WIDTH + 1])]
        places = [i for i in range(WIDTH // 3 + 1, WIDTH - len(pad) + 1) if text[i] == " "]
        if not places:
            break
        _, back = min((depths[i], -i) for i in places)
        at = -back
        out.append(pad + text[:at])
        pad, text = " " * (indent + 4), text[at + 1 :]
    return [*out, pad + text]


class Definitions:
    """Definitions of a file, each made when it is first asked for."""

    head = HEAD
    """What stands before all definitions."""
    folds = False
    """Whether calls of which all is known are made when they are translated."""

    def __init__(self) -> None:
        self._names: dict[str, object] = {}
        self._constants: dict[tuple[str, str], tuple[str, list[str], str]] = {}
        self.structs: dict[Tuple | Record, tuple[str, list[str]]] = {}

    def definitions(self, text: str) -> list[str]:
        """Helpers and constants that a text names."""
        words = set(re.findall(r"\w+", re.sub(r"(?s)/\*.*?\*/", "", text)))
        out = ["", self.head, "", *(HELPERS[name] for name in HELPERS if name in words)]
        said = ""
        for name, lines, doc in self._constants.values():
            if name in words:
                out += ["", *comment(doc)] if doc and doc != said else []
                out += lines
                said = doc
        return out

    def unique(self, name: str, module: str, key: object) -> str:
        """A name of the file for a key."""
        room = module.split(".")[-2:]
        more = [f"{name}_{i}" for i in range(2, 999)]
        for c in (name, f"{name}_{room[-1]}", f"{name}_{'_'.join(room)}", *more):
            taken = c in RESERVED | LIBRARY or c in HELPERS
            if not taken and self._names.setdefault(c, key) == key:
                return c
        raise AssertionError(name)

    def stands_for(self, source: Source, name: str) -> Any:
        """The object that a name of a kernel's module stands for."""
        return source.stands_for(name)

    def definition(self, source: Source) -> Callable[..., Any]:
        """A kernel as Python runs it."""
        return source.function

    def struct_of(self, t: Tuple, parts: list[str]) -> str:
        """A struct for a tuple of numbers."""
        return f"({self.struct(t)}){{{', '.join(parts)}}}"

    def constant(self, source: Source, name: str) -> str:
        """Name of a module's constant, defined when it is first used."""
        home, doc = home_of(source.module, name)
        key = home.__name__, name
        if key not in self._constants:
            c = self.unique(name.lstrip("_").upper(), home.__name__, key)
            values = np.asarray(self.stands_for(source, name))
            kind = (ELEMENT if values.shape else NUMBER)[ELEMENTS[values.dtype.kind]]
            sizes = "".join(f"[{d}]" for d in values.shape)
            lines = folded(f"static const {kind} {c}{sizes} = {number(values)};")
            self._constants[key] = c, lines, doc
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
            case Record() | Tuple():
                return f"{self.struct(t)} {'*' * isinstance(t, Record)}{name}"
            case None:
                return f"void {name}"
        return f"{(ELEMENT if storage else NUMBER)[t]} {name}"

    def struct(self, t: Tuple | Record) -> str:
        """Name of the struct for a tuple of numbers, or for a record."""
        if t not in self.structs:
            storage = isinstance(t, Record)
            fields = [self.declaration(x, key, storage) for key, x in t.fields().items()]
            name, lines = self.unique(t.name, "", t), [f"    {x};" for x in fields]
            self.structs[t] = name, ["", "typedef struct {", *lines, f"}} {name};"]
        return self.structs[t][0]


_parsed = cache(ast.parse)


@cache
def home_of(module: ModuleType, name: str) -> tuple[ModuleType, str]:
    """The module that defines a constant, and what it says of it there."""
    for s, after in pairwise([*_parsed(inspect.getsource(module)).body, ast.Pass()]):
        if isinstance(s, ast.ImportFrom) and any(a.name == name for a in s.names):
            return home_of(sys.modules[str(s.module)], name)
        if isinstance(s, ast.Assign) and named(s, ast.Store)[name]:
            match after:
                case ast.Expr(value=ast.Constant(value=str(doc))):
                    return module, doc
    return module, ""
