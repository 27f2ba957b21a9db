"""Places of a source file that can be changed to something that is wrong: one small change each."""

import ast
from collections.abc import Iterator
from typing import NamedTuple

COMPARED = {
    ast.Lt: ("<=", ">="),
    ast.LtE: ("<", ">"),
    ast.Gt: (">=", "<="),
    ast.GtE: (">", "<"),
    ast.Eq: ("!=",),
    ast.NotEq: ("==",),
}
COMBINED = {
    ast.Add: "-",
    ast.Sub: "+",
    ast.Mult: "/",
    ast.Div: "*",
    ast.FloorDiv: "*",
    ast.Mod: "*",
}


class Site(NamedTuple):
    """A change: where (line, column), what is there and what comes in its place."""

    line: int
    column: int
    old: str
    new: str


def sites(text: str) -> Iterator[Site]:
    """All changes of a module: operators, comparisons, numbers, conditions, statements left out."""
    lines = text.split("\n")
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line.encode()) + 1)
    raw = text.encode()

    def between(first: tuple[int, int], last: tuple[int, int]) -> str:
        a, b = (starts[line - 1] + column for line, column in (first, last))
        return raw[a:b].decode()

    for node in inside(ast.parse(text)):
        begin, end = (
            (node.lineno, node.col_offset),
            (node.end_lineno or 0, node.end_col_offset or 0),
        )
        whole = between(begin, end)
        match node:
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                a, b = (left.end_lineno or 0, left.end_col_offset or 0), start(right)
                sign = between(a, b)
                for new in COMPARED.get(type(op), ()):
                    yield Site(*a, sign, f" {new} " + "(" * sign.count("("))
            case ast.BinOp(left=left, op=op, right=right) if type(op) in COMBINED:
                a, b = (left.end_lineno or 0, left.end_col_offset or 0), start(right)
                sign = between(a, b)
                if not set(sign) & set(")#\n"):
                    yield Site(*a, sign, f" {COMBINED[type(op)]} " + "(" * sign.count("("))
            case ast.BoolOp(op=op, values=[first, second, *_]):
                a = (first.end_lineno or 0, first.end_col_offset or 0)
                sign = between(a, start(second))
                old, new = ("and", "or") if isinstance(op, ast.And) else ("or", "and")
                if sign.count(old) == 1:
                    yield Site(*a, sign, sign.replace(old, new))
            case ast.UnaryOp(op=ast.USub()):
                yield Site(*begin, whole, whole[1:])
            case ast.UnaryOp(op=ast.Not()):
                yield Site(*begin, whole, whole[4:])
            case ast.Constant(value=bool()):
                yield Site(*begin, whole, str(not node.value))
            case ast.Constant(value=int()):
                yield Site(*begin, whole, str(node.value + 1))
            case ast.Constant(value=float()):
                yield Site(*begin, whole, repr(node.value * 2 if node.value else 1.0))
            case (
                ast.AugAssign() | ast.Assign(targets=[ast.Subscript()]) | ast.Expr(value=ast.Call())
            ):
                yield Site(*begin, whole, "pass")
            case ast.Break():
                yield Site(*begin, whole, "pass")
            case ast.Continue():
                yield Site(*begin, whole, "pass")


def start(node: ast.expr | ast.stmt) -> tuple[int, int]:
    """Where something begins."""
    return node.lineno, node.col_offset


def inside(tree: ast.Module) -> Iterator[ast.AST]:
    """Statements and expressions of functions, without annotations, decorators and texts."""
    for top in ast.walk(tree):
        if isinstance(top, ast.FunctionDef):
            for statement in top.body:
                for node in ast.walk(statement):
                    if isinstance(node, ast.expr | ast.stmt) and not isinstance(
                        node, ast.FunctionDef
                    ):
                        yield node


def changed(text: str, site: Site) -> str:
    """The module with the change."""
    raw = text.encode()
    lines = raw.split(b"\n")
    at = sum(len(line) + 1 for line in lines[: site.line - 1]) + site.column
    old = site.old.encode()
    assert raw[at : at + len(old)] == old
    return (raw[:at] + site.new.encode() + raw[at + len(old) :]).decode()
