"""The kernels of one arm as C that C++ and any compiler take too, its constants in their places."""

import ast
import inspect
import re
from collections.abc import Callable
from functools import cache
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from dh2urdf import kernels
from dh2urdf.kernels import blocks
from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.definitions import ELEMENT, HELPERS, folded, home_of, number
from dh2urdf.translate.source import Source
from dh2urdf.translate.types import ELEMENTS, Array, Fixed, Tuple

SMALL = {"blocks.POSES": 1, "blocks.LANES": 1, "two_parallel.branches.TOGETHER": 8}
"""Sizes of blocks, of one pose, and of parts of a pose, that need a few kilobytes of stack."""

BLOCK = "blocks.BLOCK"
"""Numbers from row to row of a block: the arms of a pose where these are its lanes, else one."""


def lanes_of(kernel: Callable[..., Any]) -> int:
    """Lanes that a pose takes in the blocks of a kernel, whose module names them."""
    return blocks.ARMS if "ARMS" in vars(inspect.getmodule(kernel)) else 1


HEAD = """/* A loop whose turns do not depend on one another. */
#if defined(__GNUC__) && !defined(__clang__)
#define SIDE_BY_SIDE _Pragma("GCC ivdep")
#else
#define SIDE_BY_SIDE
#endif"""


@cache
def _assigned(home: ModuleType) -> dict[str, ast.expr]:
    """What a module's names are assigned."""
    found = dict[str, ast.expr]()
    for s in ast.parse(inspect.getsource(home)).body:
        match s:
            case ast.Assign(targets=[ast.Name(id=target)], value=value):
                found[target] = value
    return found


@cache
def _changed(home: ModuleType, name: str, lanes: int) -> int | None:
    """A constant of a module that follows from the sizes of small blocks of some lanes."""
    place = f"{home.__name__}.{name}".removeprefix(f"{kernels.__name__}.")
    if place == BLOCK:
        return lanes
    if place in SMALL:
        return SMALL[place]
    found = _assigned(home).get(name)
    plain = ast.BinOp | ast.operator | ast.Name | ast.expr_context | ast.Constant
    if found is None or not all(isinstance(n, plain) for n in ast.walk(found)):
        return None
    names = [n.id for n in ast.walk(found) if isinstance(n, ast.Name)]
    given = {n: _changed(home_of(home, n)[0], n, lanes) for n in names}
    if all(value is None for value in given.values()):
        return None
    known = {n: value for n, value in given.items() if value is not None}
    return int(eval(ast.unparse(found), {**vars(home), **known}))


TAKEN = """
fk jacobian ik ik_near solutions workspace prepare H JOINTS SOLUTIONS STACK NOINLINE INLINE
HAS_WORKSPACE LOWER UPPER
"""
"""Names of what the file offers."""


class ArmFile(CFile):
    """Kernels that know one arm, under names that begin with the arm's."""

    head = HEAD
    folds = True

    def __init__(self, prefix: str, lanes: int) -> None:
        super().__init__()
        self.prefix, self.lanes = prefix, lanes
        for name in TAKEN.split():
            self.unique(name, "", TAKEN)
        self._given: dict[str, tuple[np.ndarray[Any, Any], str]] = {}

    def unique(self, name: str, module: str, key: object) -> str:
        """A name of the file, after that of the arm."""
        prefix = self.prefix.upper() if name.isupper() else self.prefix
        return super().unique(f"{prefix}_{name}", module, key)

    def stands_for(self, source: Source, name: str) -> Any:
        """The object that a name of a kernel's module stands for; blocks are of one pose."""
        home, _ = home_of(source.module, name)
        changed = _changed(home, name, self.lanes)
        return super().stands_for(source, name) if changed is None else changed

    def definition(self, source: Source) -> Callable[..., Any]:
        """A kernel as Python runs it, and those that it calls, with blocks of one pose."""
        function, changed = source.function, dict[str, Any]()
        for name in function.__code__.co_names:
            inner = source.kernel(name)
            if inner is not None:
                changed[name] = self.definition(inner)
            elif name.isupper():
                changed[name] = self.stands_for(source, name)
        return FunctionType(function.__code__, {**function.__globals__, **changed})

    def struct_of(self, t: Tuple, parts: list[str]) -> str:
        """A struct made by a function: not every compiler has literals of them."""
        return f"{self.struct(t)}_of({', '.join(parts)})"

    def fixed(self, name: str, values: np.ndarray[Any, Any]) -> Array:
        """The type of an array that is known, which the file has under a name."""
        shape, dtype, same = values.shape, values.dtype, values.tobytes()
        for text, (other, _) in self._given.items():
            if (other.shape, other.dtype, other.tobytes()) == (shape, dtype, same):
                return self._known(text, other)
        text = self.unique(name.upper(), "", ("fixed", name, len(self._given)))
        kind = ELEMENT[ELEMENTS[dtype.kind]]
        sizes = "".join(f"[{d}]" for d in shape)
        self._given[text] = values, f"static const {kind} {text}{sizes} = {number(values)};"
        return self._known(text, values)

    @staticmethod
    def _known(text: str, values: np.ndarray[Any, Any]) -> Array:
        element = ELEMENTS[values.dtype.kind]
        return Array(element, values.shape, constant=True, fixed=Fixed(text, values))

    def text(self) -> str:
        """All that the entries need."""
        bodies = {body.function: self._function(body) for body in self.order}
        used, todo = set[str](), [entry.function for entry in self.entries]
        while todo:
            name = todo.pop()
            if name not in used:
                used.add(name)
                todo += set(re.findall(r"\w+", bodies[name])) & bodies.keys() - used
        kernels = "\n\n".join(text for name, text in bodies.items() if name in used)
        lines = list[str]()
        for t, (name, made) in self.structs.items():
            lines += [*made, *self._maker(t, name)]
        words = set(re.findall(r"\w+", kernels))
        for text, (_, line) in self._given.items():
            lines += ["", *folded(line)] if text in words else []
        return self._prefixed("\n".join([*lines, *self.definitions(kernels), "", kernels]))

    def _maker(self, t: Tuple | Any, name: str) -> list[str]:
        """A function that makes a struct."""
        if not isinstance(t, Tuple):
            return []
        given = ", ".join(self.declaration(x, key) for key, x in t.fields().items())
        sets = [f"    made.{key} = {key};" for key in t.fields()]
        head = f"static inline {name} {name}_of({given})"
        return ["", *folded(head), "{", f"    {name} made;", *sets, "    return made;", "}"]

    def _prefixed(self, text: str) -> str:
        """A text with the arm's name before those of small functions and macros."""
        names = "|".join([*HELPERS, "leave"])
        text = re.sub(rf"\b({names})(?=\()", rf"{self.prefix}_\1", text)
        return re.sub(r"\bSIDE_BY_SIDE\b", f"{self.prefix.upper()}_SIDE_BY_SIDE", text)
