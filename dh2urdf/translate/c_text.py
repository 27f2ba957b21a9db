"""Pieces of C text: numbers, comments, tables, lines, and small helpers that the subset needs."""

import re
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dh2urdf.translate.types import ELEMENTS

WIDTH = 100

_RESERVED = """
auto bool case char const default do double enum extern false far float goto inline int long near
register restrict short signed sizeof static struct switch true typedef union unsigned void volatile
"""
RESERVED = {*_RESERVED.split()}
"""Words of C that no name is."""

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

_SUPPORT = Path(__file__).with_name("support.h").read_text().strip().split("\n\n")
HEAD, *_FUNCTIONS = _SUPPORT
HELPERS = {re.findall(r"\w+(?=\()", text)[0]: text for text in _FUNCTIONS}
"""As Python defines them: the first of two that compare as equal, division towards minus
infinity."""


def number(value: Any) -> str:
    """A literal that reads back as the same number."""
    if isinstance(value, bool | np.bool_):
        return "true" if value else "false"
    if isinstance(value, int | np.integer):
        return str(int(value))
    text = repr(float(value))
    return {"nan": "NAN", "inf": "INFINITY", "-inf": "-INFINITY"}.get(text, text)


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
        depth, places = 0, list[tuple[int, int]]()
        for i, letter in enumerate(text[: WIDTH - len(pad) + 1]):
            depth += (letter in "([{") - (letter in ")]}")
            if letter == " " and i > WIDTH // 3:
                places.append((depth, -i))
        if not places:
            break
        at = -min(places)[1]
        out.append(pad + text[:at])
        pad, text = " " * (indent + 4), text[at + 1 :]
    return [*out, pad + text]


def constant(name: str, value: object) -> str:
    """A number or a table that does not change."""
    values = np.asarray(value)
    kind = (ELEMENT if values.shape else NUMBER)[ELEMENTS[values.dtype.kind]]
    sizes = "".join(f"[{d}]" for d in values.shape)
    return "\n".join(folded(f"static const {kind} {name}{sizes} = {_rows(values)};"))


def _rows(a: NDArray[np.generic]) -> str:
    return "{" + ", ".join(map(_rows, a)) + "}" if a.shape else number(a[()])
