"""A kernel's source: its syntax tree, what its names stand for, and what the subset allows."""

import ast
import inspect
import io
import sys
import textwrap
import tokenize
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
from functools import cache, cached_property
from importlib import import_module
from types import ModuleType
from typing import Any, NoReturn

ADVICE: dict[str, tuple[type[ast.AST], ...]] = {
    "a loop": (ast.ListComp, ast.GeneratorExp, ast.DictComp, ast.SetComp),
    "loops": (ast.MatMult,),
    "np.empty, or a tuple": (ast.List,),
    "a record, or arguments": (ast.Dict,),
    "comparisons": (ast.Set,),
    "comparisons with ==": (ast.In, ast.Is),
    "comparisons with !=": (ast.NotIn, ast.IsNot),
    "a kernel of the module": (ast.Lambda, ast.FunctionDef),
    "a record of the module": (ast.ClassDef,),
    "a returned status": (ast.Try, ast.Raise, ast.Assert),
    "the statements alone": (ast.With,),
    "into an array that is handed in": (ast.Yield, ast.YieldFrom),
    "an argument": (ast.Global, ast.Nonlocal),
    "a positional argument": (ast.keyword,),
    "numbers only": (ast.JoinedStr,),
    "the import at the head of the module": (ast.Import, ast.ImportFrom),
    "nothing": (ast.Delete,),
    "an assignment of its own": (ast.NamedExpr,),
    "an assignment without a type": (ast.AnnAssign,),
    "if and elif": (ast.Match,),
    "products, or math.sqrt": (ast.Pow,),
}
"""What to write instead of syntax outside the subset."""

REFUSED = {kind: advice for advice, kinds in ADVICE.items() for kind in kinds}

ENGINE = "dh2urdf.kernels.numbers.engine"

MAKERS = ("np.empty", "np.zeros")


class SubsetError(Exception):
    """A kernel uses what cannot be translated: where, what, and what to write instead."""


class Source:
    """One kernel as it is written."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self.name, self.module = function.__name__, sys.modules[function.__module__]
        self.file = inspect.getsourcefile(function)
        lines, self.line = inspect.getsourcelines(function)
        text = textwrap.dedent("".join(lines))
        tree = ast.parse(text).body[0]
        if not isinstance(tree, ast.FunctionDef):
            self.refuse(tree, "no function", "def")
        self.tree, self.doc = tree, ast.get_docstring(tree) or ""
        self.body = tree.body[1:] if self.doc else tree.body
        self.parameters = [a.arg for a in tree.args.args]
        self.names = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)}
        times = Counter(stored(self.body))
        self.stored = {*times, *self.parameters}
        loops = (s for s in every(self.body) if isinstance(s, ast.For))
        counters = {x for s in loops for x in stored([s.target])}
        self.once = {x for x in times if times[x] == 1} - counters - {*self.parameters}
        self.changing = set(times) - self.once - counters
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        comments = (t for t in tokens if t.type == tokenize.COMMENT)
        self.comments = {t.start[0]: t.string.lstrip("# ") for t in comments}
        self._check()

    def refuse(self, node: ast.AST, found: str, instead: str = "") -> NoReturn:
        """Raise :class:`SubsetError` for a node."""
        line = self.line + getattr(node, "lineno", 1) - 1
        what = ast.unparse(node).partition("\n")[0]
        advice = f"; write {instead}" if instead else ""
        where = f"{self.file}:{line}: {self.name}"
        raise SubsetError(f"{where}: {found}{': ' * bool(what)}{what}{advice}")

    def _check(self) -> None:
        a = self.tree.args
        if a.vararg or a.kwarg or a.kwonlyargs or a.posonlyargs or a.defaults:
            self.refuse(a, "arguments that are not plain", "positional ones")
        keys = {id(n.slice) for n in ast.walk(self.tree) if isinstance(n, ast.Subscript)}
        for node in (n for s in self.body for n in ast.walk(s)):
            operators = [getattr(node, "op", None), *getattr(node, "ops", [])]
            for kind in map(type, [node, *operators]):
                if kind in REFUSED:
                    self.refuse(node, f"{kind.__name__} is not allowed", REFUSED[kind])
            text = isinstance(node, ast.Constant) and not isinstance(node.value, int | float)
            if text and id(node) not in keys:
                self.refuse(node, "a value that is no number", "numbers only")
            if isinstance(node, ast.Constant) and type(node.value) is int and node.value >= 2**31:
                self.refuse(node, "a whole number beyond 32 bits", "a float")
            if isinstance(node, ast.Assign) and len(node.targets) > 1:
                self.refuse(node, "two assignments in one", "two")
            if isinstance(node, ast.For | ast.While) and node.orelse:
                self.refuse(node, "else of a loop", "a flag, or a kernel that returns")

    def stands_for(self, name: str) -> Any:
        """The object that a name of the module stands for; None if there is none."""
        base, _, attribute = name.partition(".")
        found = getattr(self.module, base, None)
        if attribute:
            return getattr(found, attribute, None) if isinstance(found, ModuleType) else None
        return found

    def kernel(self, name: str) -> "Source | None":
        """The kernel that a name of the module stands for."""
        value = self.stands_for(name)
        name = getattr(value, "__name__", "").replace("__", ".")  # of a compiled entry
        value = import_module(ENGINE).INTERPRETED.get(name, value)
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
        counters = stored(s.target for s in every(self.body) if isinstance(s, ast.For))
        for name in self.stored - {*self.parameters, *counters, "_"}:
            places = _assignments(name, self.body)
            for s in places or []:
                at[s].add(name)
            if not places:
                before[next(s for s in self.body if uses(s)[name])].add(name)
        return at, before


@cache
def source_of(function: Callable[..., Any]) -> Source:
    """The source of a kernel, read once."""
    return Source(function)


def stored(nodes: Iterable[ast.AST]) -> list[str]:
    """Names that are given values, once for each time."""
    inside = (n for top in nodes for n in ast.walk(top) if isinstance(n, ast.Name))
    return [n.id for n in inside if isinstance(n.ctx, ast.Store)]


@cache
def loaded(node: ast.AST) -> set[str]:
    """Names that a node reads."""
    return {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}


@cache
def uses(node: ast.AST) -> Counter[str]:
    """How often a node names something."""
    return Counter(n.id for n in ast.walk(node) if isinstance(n, ast.Name))


def blocks_of(statement: ast.stmt) -> list[list[ast.stmt]]:
    """The blocks inside a statement."""
    return [b for b in (getattr(statement, "body", []), getattr(statement, "orelse", [])) if b]


def every(statements: list[ast.stmt]) -> Iterator[ast.stmt]:
    """All statements of a block and of the blocks inside it."""
    for statement in statements:
        yield statement
        for block in blocks_of(statement):
            yield from every(block)


def _assignments(name: str, block: list[ast.stmt]) -> list[ast.stmt]:
    """Assignments that all uses of a name in a block follow; none if that cannot be."""
    users = [s for s in block if uses(s)[name]]
    first, found = users[0], list[ast.stmt]()
    if isinstance(first, ast.Assign) and name in stored([first]) and name not in loaded(first):
        return [first]
    for s in users:
        inside = [b for b in blocks_of(s) if any(uses(x)[name] for x in b)]
        places = [_assignments(name, b) for b in inside]
        if not all(places) or sum(uses(x)[name] for b in inside for x in b) != uses(s)[name]:
            return []
        found += [place for inner in places for place in inner]
    return found
