"""A kernel's source: its syntax tree, what its names stand for, and where C declares them."""

import ast
import inspect
import io
import sys
import textwrap
import tokenize
from collections import Counter, defaultdict
from collections.abc import Callable
from functools import cache, cached_property
from typing import Any, NoReturn

from dh2urdf import engine

ROOM = "dh2urdf.kernels"

MAKERS = ("np.empty", "np.zeros")


class SubsetError(Exception):
    """A kernel uses what cannot be translated: where, what, and what to write instead."""


class Source:
    """One kernel as it is written."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function
        self.name, self.module = function.__name__, sys.modules[function.__module__]
        self.file = inspect.getsourcefile(function)
        lines, self.line = inspect.getsourcelines(function)
        text = textwrap.dedent("".join(lines))
        tree = ast.parse(text).body[0]
        if not isinstance(tree, ast.FunctionDef):
            self.refuse(tree, "no function", "def")
        a = tree.args
        if a.vararg or a.kwarg or a.kwonlyargs or a.posonlyargs or a.defaults:
            self.refuse(a, "arguments that are not plain", "positional ones")
        self.tree, self.doc = tree, ast.get_docstring(tree) or ""
        self.body = tree.body[1:] if self.doc else tree.body
        self.parameters = [x.arg for x in a.args]
        self.loops = [n for n in ast.walk(tree) if isinstance(n, ast.For | ast.While)]
        loops = [s for s in self.loops if isinstance(s, ast.For)]
        counters = {x for s in loops for x in named(s.target)}
        times = named(tree, ast.Store)
        self.stored = {*times, *self.parameters}
        self.variables = self.stored - counters - {*self.parameters, "_"}
        self.once = {x for x in self.variables if times[x] == 1}
        self.changing = set(times) - self.once - counters
        turns = {x: sum(named(s)[x] for s in loops if named(s.target)[x]) for x in counters}
        self.astray = {x for x in counters if turns[x] != named(tree)[x]} - {"_"}
        """Counters that are used beside their loops."""
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        comments = (t for t in tokens if t.type == tokenize.COMMENT)
        self.comments = {t.start[0]: t.string.lstrip("# ") for t in comments}

    def refuse(self, node: ast.AST, found: str, instead: str = "") -> NoReturn:
        """Raise :class:`SubsetError` for a node."""
        line = self.line + getattr(node, "lineno", 1) - 1
        what = ast.unparse(node).partition("\n")[0]
        advice = f"; write {instead}" if instead else ""
        where = f"{self.file}:{line}: {self.name}"
        raise SubsetError(f"{where}: {found}{': ' * bool(what)}{what}{advice}")

    def stands_for(self, name: str) -> Any:
        """The object that a name of the module stands for; None if there is none."""
        found: Any = self.module
        for part in name.split("."):
            found = getattr(found, part, None)
        return found

    def kernel(self, name: str) -> "Source | None":
        """The kernel that a name of the module stands for."""
        value = self.stands_for(name)
        name = getattr(value, "__name__", "").replace("__", ".")  # of a compiled entry
        value = engine.INTERPRETED.get(name, value)
        own = self.module.__name__.partition(".")[0]
        inside = getattr(value, "__module__", "").partition(".")[0] == own
        return source_of(value) if inside and hasattr(value, "__code__") else None

    @cached_property
    def made(self) -> ast.expr | None:
        """What a kernel returns that does nothing but make arrays; None for another kernel."""
        self.__dict__["made"] = None  # for kernels that call themselves
        last = self.body[-1]
        if len(self.body) > 1 or not isinstance(last, ast.Return):
            return None
        calls = {ast.unparse(n.func) for n in ast.walk(last) if isinstance(n, ast.Call)}
        kernels = filter(None, map(self.kernel, calls))
        return last.value if calls & {*MAKERS} or any(k.made for k in kernels) else None

    @cached_property
    def declared(self) -> tuple[dict[ast.stmt, set[str]], dict[ast.stmt, set[str]]]:
        """Names that C declares at their assignments, and those it declares before statements."""
        at: dict[ast.stmt, set[str]] = defaultdict(set)
        before: dict[ast.stmt, set[str]] = defaultdict(set)
        for name in self.variables:
            places = _assignments(name, self.body)
            for s in places:
                at[s].add(name)
            if not places:
                before[next(s for s in self.body if named(s)[name])].add(name)
        return at, before


@cache
def source_of(function: Callable[..., Any]) -> Source:
    """The source of a kernel, read once."""
    return Source(function)


@cache
def named(node: ast.AST, context: type[ast.expr_context] = ast.expr_context) -> Counter[str]:
    """How often a node names something, to read it (ast.Load), to write it (ast.Store), or both."""
    inside = (n for n in ast.walk(node) if isinstance(n, ast.Name))
    return Counter(n.id for n in inside if isinstance(n.ctx, context))


def _assignments(name: str, block: list[ast.stmt]) -> list[ast.stmt]:
    """Assignments that all uses of a name in a block follow; none if that cannot be."""
    users, found = [s for s in block if named(s)[name]], list[ast.stmt]()
    first = users[0]
    stores = isinstance(first, ast.Assign) and named(first, ast.Store)[name]
    if stores and not named(first, ast.Load)[name]:
        return [first]
    for s in users:
        blocks = [getattr(s, "body", []), getattr(s, "orelse", [])]
        inside = [b for b in blocks if any(named(x)[name] for x in b)]
        places = [_assignments(name, b) for b in inside]
        if not all(places) or sum(named(x)[name] for b in inside for x in b) != named(s)[name]:
            return []
        found += [place for inner in places for place in inner]
    return found
