"""A kernel's source: its syntax tree, what its names stand for, and what the subset allows."""

import ast
import inspect
import io
import sys
import textwrap
import tokenize
from collections.abc import Iterator
from types import ModuleType
from typing import Any, NoReturn

REFUSED: dict[type[ast.AST], str] = {
    ast.ListComp: "a loop",
    ast.GeneratorExp: "a loop",
    ast.DictComp: "a loop",
    ast.SetComp: "a loop",
    ast.List: "np.empty, or a tuple",
    ast.Dict: "a record, or arguments",
    ast.Set: "comparisons",
    ast.Lambda: "a kernel",
    ast.FunctionDef: "a kernel of the module",
    ast.ClassDef: "a record of the module",
    ast.Try: "a returned status",
    ast.Raise: "a returned status",
    ast.Assert: "a returned status",
    ast.With: "nothing",
    ast.Yield: "an output array",
    ast.Global: "an argument",
    ast.Nonlocal: "an argument",
    ast.JoinedStr: "numbers only",
    ast.Import: "an import of the module",
    ast.ImportFrom: "an import of the module",
    ast.Delete: "nothing",
    ast.NamedExpr: "an assignment of its own",
    ast.Pow: "products, or math.sqrt",
    ast.MatMult: "loops",
}
"""Syntax outside the subset, and what to write instead."""

MAKERS = ("np.empty", "np.zeros", "np.full")


class SubsetError(Exception):
    """A kernel uses what cannot be translated: where, what, and what to write instead."""


class Source:
    """One kernel as it is written."""

    def __init__(self, function: Any) -> None:
        self.function = getattr(function, "py_func", function)
        self.name, self.module = self.function.__name__, sys.modules[self.function.__module__]
        lines, self.line = inspect.getsourcelines(self.function)
        text = textwrap.dedent("".join(lines))
        tree = ast.parse(text).body[0]
        assert isinstance(tree, ast.FunctionDef)
        self.tree, self.doc = _Shapes().visit(tree), ast.get_docstring(tree) or ""
        self.body = tree.body[1:] if self.doc else tree.body
        self.parameters = [a.arg for a in tree.args.args]
        self.comments = {
            token.start[0]: token.string.lstrip("# ")
            for token in tokenize.generate_tokens(io.StringIO(text).readline)
            if token.type == tokenize.COMMENT
        }
        self._check()

    def refuse(self, node: ast.AST, found: str, instead: str = "") -> NoReturn:
        """Raise :class:`SubsetError` for a node."""
        line = self.line + getattr(node, "lineno", 1) - 1
        advice = f"; write {instead}" if instead else ""
        what = ast.unparse(node) if isinstance(node, ast.expr | ast.stmt) else ""
        raise SubsetError(f"{self.module.__file__}:{line}: {self.name}: {found}: {what}{advice}")

    def _check(self) -> None:
        if self.tree.args.vararg or self.tree.args.kwonlyargs or self.tree.args.defaults:
            self.refuse(self.tree.args, "arguments that are not plain", "positional ones")
        keys = {id(n.slice) for n in ast.walk(self.tree) if isinstance(n, ast.Subscript)}
        for statement in self.body:
            for node in ast.walk(statement):
                if type(node) in REFUSED:
                    self.refuse(node, f"{type(node).__name__} is not allowed", REFUSED[type(node)])
                text = isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
                if text and id(node) not in keys:
                    self.refuse(node, "text", "numbers only")
                if isinstance(node, ast.Assign) and len(node.targets) > 1:
                    self.refuse(node, "two assignments in one", "two")

    def stands_for(self, node: ast.expr) -> Any:
        """The object that a name of the module stands for; None if there is none."""
        if isinstance(node, ast.Name):
            module, _, name = node.id.rpartition("::")
            return getattr(sys.modules[module] if module else self.module, name, None)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            base = getattr(self.module, node.value.id, None)
            return getattr(base, node.attr, None) if isinstance(base, ModuleType) else None
        return None


class _Shapes(ast.NodeTransformer):
    """Writes ``m, n = x.shape`` as ``m, n = x.shape[0], x.shape[1]``."""

    def visit_Assign(self, node: ast.Assign) -> ast.AST:
        value, target = node.value, node.targets[0]
        shape = isinstance(value, ast.Attribute) and value.attr == "shape"
        if shape and isinstance(target, ast.Tuple):
            parts = [ast.Subscript(value, ast.Constant(k)) for k in range(len(target.elts))]
            node.value = ast.Tuple(list(parts))
            for n in ast.walk(node.value):
                ast.copy_location(n, value)
        return node


def stored(nodes: list[ast.stmt]) -> list[str]:
    """Names that statements give values to, once for each time."""
    return [
        n.id
        for s in nodes
        for n in ast.walk(s)
        if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)
    ]


def loaded(node: ast.AST) -> set[str]:
    """Names that a node reads."""
    return {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}


def makes_array(node: ast.AST) -> bool:
    """Whether a node is a call that makes an array."""
    return isinstance(node, ast.Call) and ast.unparse(node.func) in MAKERS


def blocks_of(statement: ast.stmt) -> list[list[ast.stmt]]:
    """The blocks inside a statement; that of a loop's else comes after it."""
    return [b for b in (getattr(statement, "body", []), getattr(statement, "orelse", [])) if b]


def every(statements: list[ast.stmt]) -> Iterator[ast.stmt]:
    """All statements of a block and of the blocks inside it."""
    for statement in statements:
        yield statement
        for block in blocks_of(statement):
            yield from every(block)
