"""Pieces of C text: numbers, comments, tables, and small helpers that the subset needs."""

import math
import re
import textwrap

import numpy as np
from numpy.typing import NDArray

WIDTH = 100

_RESERVED = """
auto bool case char const default do double enum extern false far float goto inline int long near
register restrict short signed sizeof static struct switch true typedef union unsigned void volatile
"""
RESERVED = set(re.findall(r"\w+", _RESERVED))

NUMBER = {"float": "double", "int": "int", "bool": "bool"}
ELEMENT = {"float": "double", "int": "int64_t", "bool": "bool"}

HELPERS = {
    "larger": "static inline double larger(double a, double b) { return b > a ? b : a; }",
    "smaller": "static inline double smaller(double a, double b) { return b < a ? b : a; }",
    "larger_int": "static inline int larger_int(int a, int b) { return b > a ? b : a; }",
    "smaller_int": "static inline int smaller_int(int a, int b) { return b < a ? b : a; }",
    "size_int": "static inline int size_int(int a) { return a < 0 ? -a : a; }",
    "floor_div": "static inline int floor_div(int a, int b)\n"
    "{\n    return a / b - (a % b != 0 && (a < 0) != (b < 0));\n}",
    "floor_mod": "static inline int floor_mod(int a, int b) { return a - b * floor_div(a, b); }",
}
"""As Python defines them: the first of two that compare as equal, division towards minus
infinity."""

NEEDS = {"floor_mod": "floor_div"}


def number(value: object) -> str:
    """A literal that reads back as the same number."""
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, int | np.integer):
        return str(int(value))
    x = float(value)  # type: ignore[arg-type]
    if math.isinf(x):
        return "INFINITY" if x > 0 else "-INFINITY"
    return "NAN" if math.isnan(x) else repr(x)


def comment(text: str) -> list[str]:
    """A docstring as a comment, its markup taken off."""
    text = re.sub(r":[a-z]+:`~?\.?(?:[\w.]*\.)?(\w+)`", r"\1", text)
    lines = text.replace("``", "").replace("*/", "* /").strip().split("\n")
    if len(lines) == 1:
        return [f"/* {lines[0]} */"]
    return [f"/* {lines[0]}", *(f" * {line}".rstrip() for line in lines[1:]), " */"]


def folded(text: str, indent: int = 0) -> list[str]:
    """A statement in lines that are not too long."""
    pad = " " * indent
    if len(pad) + len(text) <= WIDTH or text.startswith("/*"):
        return [pad + text]
    width, inner = WIDTH - indent, "    "
    parts = textwrap.wrap(text, width, subsequent_indent=inner, break_long_words=False)
    return [pad + part for part in parts]


def table(name: str, values: NDArray[np.generic]) -> str:
    """A constant array."""
    kind = ELEMENT[{"f": "float", "i": "int", "b": "bool"}[values.dtype.kind]]
    sizes = "".join(f"[{d}]" for d in values.shape)
    return f"static const {kind} {name}{sizes} = {_rows(values, 0)};"


def _rows(a: NDArray[np.generic], indent: int) -> str:
    if a.ndim == 1:
        text = "{" + ", ".join(number(x) for x in a) + "}"
        inner = " " * (indent + 4)
        return "\n".join(textwrap.wrap(text, WIDTH - 8, subsequent_indent=inner))
    pad = " " * (indent + 4)
    inside = ",\n".join(pad + _rows(x, indent + 4) for x in a)
    return "{\n" + inside + "\n" + " " * indent + "}"
