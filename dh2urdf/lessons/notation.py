"""Formulas of a worked solution: written once, shown as text, as LaTeX, and with numbers put in.

A formula is written as the lecture notes say it, in ASCII: ``atan2(y_c, x_c) - atan2(m, r)``.
Names next to each other are multiplied (``2 l_1 l_2``), ``+-`` is either sign, ``a / b`` a
fraction, ``R_3^0`` a name, ``x^2`` and ``R^T`` powers.
"""

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from dh2urdf.transforms import Array

Given = Mapping[str, float | Array]

FUNCTIONS = frozenset({"atan2", "sqrt", "cos", "sin", "acos", "FK"})

GREEK = frozenset({"theta", "alpha", "phi", "psi", "gamma", "beta", "delta", "rho", "eta"})

BINARY = frozenset({"+", "-", "+-", "/", "="})

TOKEN = re.compile(
    r"(?P<name>[RHT]_\w+\^\w+|[A-Za-z]+\d*(?:_\w+)?)|(?P<number>\d+(?:\.\d+)?)"
    r"|(?P<sign>\+-|[-+/^(),=])|(?P<space> +)"
)

NOISE = 5e-13
"""Size of a number that is shown as 0: rounding of an arm of about a metre."""


class Token(NamedTuple):
    """A piece of a formula: its kind (name, function, number, sign) and text."""

    kind: str
    text: str


def tokens(formula: str) -> list[Token]:
    """The pieces of a formula, spaces left out, products spelt ``*``."""
    found: list[Token] = []
    at = 0
    while at < len(formula):
        match = TOKEN.match(formula, at)
        assert match is not None, (formula, at)
        kind, text, at = str(match.lastgroup), match.group(), match.end()
        if kind == "space":
            continue
        if text in FUNCTIONS:
            kind = "function"
        ended = bool(found) and (found[-1].kind in {"name", "number"} or found[-1].text == ")")
        if ended and (kind != "sign" or text == "("):
            found.append(Token("sign", "*"))
        found.append(Token(kind, text))
    return found


def shown(value: float) -> str:
    """A number with six digits, rounding shown as 0."""
    return f"{0.0 if abs(value) < NOISE else value:.6g}"


def vector_shown(values: Array) -> str:
    """A vector as ``(1, 0, 0.5)``."""
    return "(" + ", ".join(shown(float(v)) for v in values) + ")"


def measured(value: float, unit: str) -> str:
    """A value with its unit; an angle in degrees too."""
    if unit == "rad":
        return f"{shown(value)} rad ({shown(math.degrees(value))} deg)"
    return f"{shown(value)} {unit}".rstrip()


def with_numbers(formula: str, given: Given) -> str:
    """The formula with numbers in place of names; a name without a number stays."""
    pieces = tokens(formula)
    parts: list[str] = []
    for token, after in zip(pieces, [*(t.text for t in pieces[1:]), ""], strict=True):
        text = _put_in(token, given)
        bare = (not parts or parts[-1] in {"(", ",", "="}) and after != "^"
        wrapped = token.kind == "name" and text.startswith("-") and not bare
        parts.append(f"({text})" if wrapped else text)
    out = ""
    for part, before in zip(parts, ["(", *parts], strict=False):
        if part == "*":
            out += " · "
        elif part in BINARY:
            sign = "±" if part == "+-" else part
            out += sign if before in {"(", ",", "="} else f" {sign} "
        else:
            out += ", " if part == "," else part
    return out


def _put_in(token: Token, given: Given) -> str:
    """A token, or the number of its name."""
    value = given.get(token.text) if token.kind == "name" else None
    if value is None:
        return token.text
    return vector_shown(np.asarray(value)) if np.ndim(value) else shown(float(value))


def latex_number(text: str) -> str:
    """A number that :func:`shown` wrote, as LaTeX."""
    return re.sub(r"e([-+])0*(\d+)", lambda m: rf" \times 10^{{{m[1].strip('+')}{m[2]}}}", text)


def latex_name(name: str) -> str:
    r"""``theta_1`` as ``\\theta_{1}``, ``R_3^0`` as ``R_{3}^{0}``, ``l_1`` as ``\\ell_{1}``."""
    head, _, rest = name.partition("_")
    below, _, above = rest.partition("^")
    letter = f"\\{head}" if head in GREEK else r"\ell" if head == "l" else head
    below = f"\\{below}" if below in GREEK else below
    return letter + (f"_{{{below}}}" if below else "") + (f"^{{{above}}}" if above else "")


LETTER = re.compile(
    rf"\b(?:(?:{'|'.join(sorted(GREEK))}|[A-Za-z])(?:_[A-Za-z0-9]+(?:\^[A-Za-z0-9]+)?)"
    rf"|{'|'.join(sorted(GREEK))}|[a-z]\^2)\b"
)
"""A letter of a formula within a sentence: it has an index, is Greek or squared."""


def latex(formula: str, given: Given | None = None) -> str:
    """The formula in LaTeX's mathematics, numbers put in where they are given."""
    return _Latex(tokens(formula), given or {}).text


class _Latex:
    """LaTeX of the pieces of a formula."""

    def __init__(self, found: list[Token], given: Given) -> None:
        self.given, self.times = given, r"\cdot" if given else r"\,"
        out: list[str] = []
        rest = found
        while rest:
            piece, rest = self._operand(rest, not out or out[-1] == ",")
            if rest and rest[0].text == "/":
                below, rest = self._operand(rest[1:], True)
                piece = rf"\frac{{{_bare(piece)}}}{{{_bare(below)}}}"
            out.append(piece)
        self.text = " ".join(out)

    def _operand(self, found: list[Token], bare: bool) -> tuple[str, list[Token]]:
        """The operand or sign that comes first, brackets and powers included; the rest.

        ``bare``: no sign stands before it, with which a minus would clash.
        """
        kind, text = found[0]
        if kind == "sign" and text != "(":
            return {"+-": r"\pm", "*": self.times}.get(text, text), found[1:]
        rest = found[1:]
        piece = latex_name(text) if kind == "name" else text
        if kind == "function" or text == "(":
            start = 1 if kind == "function" else 0
            end = _closing(found, start)
            inside, rest = _Latex(found[start + 1 : end], self.given).text, found[end + 1 :]
            piece = rf"{_function(text)}\left({inside}\right)"
            if text == "sqrt":
                piece = rf"\sqrt{{{inside}}}"
        elif text in self.given:
            number = latex_number(_put_in(found[0], self.given))
            powered = bool(rest) and rest[0].text == "^"
            signed = number[0] == "-" and (powered or not bare)
            piece = rf"\left({number}\right)" if signed or "times" in number else number
        if rest and rest[0].text == "^":
            return f"{piece}^{{{rest[1].text}}}", rest[2:]
        return piece, rest


def _function(name: str) -> str:
    """The LaTeX of a function; nothing for a bracket."""
    known = {"(": "", "atan2": r"\operatorname{atan2}", "acos": r"\arccos", "FK": r"\mathrm{FK}"}
    return known.get(name, f"\\{name}")


def _closing(found: list[Token], start: int) -> int:
    """Index of the bracket that closes the one at start."""
    depth, at = 1, start
    while depth:
        at += 1
        depth += {"(": 1, ")": -1}.get(found[at].text, 0)
    return at


def _bare(piece: str) -> str:
    r"""A piece without the ``\\left( \\right)`` that is all about it."""
    if not piece.startswith(r"\left("):
        return piece
    depth = 0
    for bracket in re.finditer(r"\\(left\(|right\))", piece):
        depth += 1 if bracket[1] == "left(" else -1
        if not depth and bracket.end() < len(piece):
            return piece
    return piece.removeprefix(r"\left(").removesuffix(r"\right)")
