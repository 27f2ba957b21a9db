"""Formulas written out: text, LaTeX, and Python that needs nothing but ``math``."""

import re
from typing import Any

import numpy as np
import sympy as sp
from sympy.printing.latex import LatexPrinter
from sympy.printing.printer import Printer
from sympy.printing.str import StrPrinter

from dh2urdf.dh import JointType
from dh2urdf.grids import number
from dh2urdf.symbolic.families import Derivation
from dh2urdf.symbolic.formulas import Kind, Step
from dh2urdf.symbolic.transforms import exact_angle, exact_length
from dh2urdf.transforms import Array

RIM = 1e-12
"""What a square may lack where it is rounding of a stretched arm [1, or m^2]."""

GREEK = {"theta": "θ", "alpha": "α", "sigma": "σ", "tau": "τ"}


def _plus_first(printer: Any, expression: Any, order: Any = None) -> list[Any]:
    """Terms of a sum, those with a minus sign last."""
    terms = Printer._as_ordered_terms(printer, expression, order)
    return sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))


class _Text(StrPrinter):  # type: ignore[misc]
    """Expressions of text."""

    _as_ordered_terms = _plus_first

    def _print_Piecewise(self, value: Any) -> str:
        (other, condition), (usual, _) = value.args
        return f"{self._print(usual)}, or {self._print(other)} if {self._print(condition)}"


class _Latex(LatexPrinter):  # type: ignore[misc]
    """Expressions of LaTeX."""

    _as_ordered_terms = _plus_first


def as_text(ik: Derivation) -> str:
    """Formulas to read, a line each."""
    lines = [_title(ik), "", *_legend(ik)]
    for step in ik.steps:
        lines += ["", step.name] if step.kind is Kind.HEADING else [f"  {_line(step)}"]
    lines += ["", "The joint values"]
    return "\n".join([*lines, *(f"  {_plain(q)} = {_plain(v)}" for q, v in _joints(ik))])


def _title(ik: Derivation) -> str:
    return f"Inverse kinematics in formulas: {ik.family}"


def _legend(ik: Derivation) -> list[str]:
    """What the letters are."""
    n = len(ik.arm.links)
    given = [f"{_plain(sp.Symbol(name))} = {number(v)}" for name, v in ik.arm.values.items()]
    named = any(step.name.startswith("b_") for step in ik.steps)
    ends = [
        f"{name} = {np.array2string(T, separator=', ').replace(chr(10), '')}"
        for name, T in (("T_base^-1", ik.arm.to_base), ("T_tool^-1", ik.arm.to_last))
        if not np.array_equal(T, np.eye(4))
    ]
    pose = f"r_11 ... r_33, p_x, p_y, p_z: the pose of frame {n} in frame 0"
    return [
        f"{pose}{', T_base^-1 T T_tool^-1' if ends else ''}",
        "c_i = cos θ_i, s_i = sin θ_i; σ and τ are 1 in one solution and -1 in another",
        *(["b_ij: the rotation matrix of the joints before the wrist"] if named else []),
        *([", ".join(given) + " (metres, radians)"] if given else []),
        *ends,
    ]


def _line(step: Step) -> str:
    name, value = _plain(sp.Symbol(step.name)), step.value
    if step.kind is Kind.CHOICE:
        return f"{name} = ±1"
    if step.kind is Kind.ROOT:
        return f"{name} = √({_plain(value)}), no solution if that is not real"
    return f"{name} = {_plain(value)}"


def _plain(value: Any) -> str:
    """An expression in one line of text."""
    text: str = _Text({"full_prec": False}).doprint(_decimal(value))
    for word, letter in GREEK.items():
        text = text.replace(f"{word}_", f"{letter}_")
    text = text.replace("**", "^").replace("*", "·").replace("sqrt", "√").replace("pi", "π")
    return text.replace("-", "\N{MINUS SIGN}")


def _decimal(value: Any) -> Any:
    """An expression with decimals in place of long fractions."""
    numbers = value.atoms(sp.Rational, sp.Float)
    return value.xreplace({x: sp.Float(x, 15) for x in numbers if x.is_Float or x.q > 12})


def _joints(ik: Derivation) -> list[tuple[Any, Any]]:
    """``q_i`` of each joint: the joint variable less the table's offset."""
    out = []
    for link, row in zip(ik.arm.links, ik.arm.rows, strict=True):
        slides = row.joint_type is JointType.PRISMATIC
        variable = sp.Symbol(f"{'d' if slides else 'theta'}_{link.label}")
        offset = exact_length(row.d) if slides else exact_angle(row.theta)
        out.append((sp.Symbol(f"q_{link.label}"), row.sign * (variable - offset)))
    return out


def as_latex(ik: Derivation) -> str:
    """Formulas as LaTeX: words, and an ``align*`` after each."""
    out, block = [f"% {_title(ik)}"], list[str]()

    def close() -> None:
        if block:
            joined = " \\\\\n".join(block)
            out.append(f"\\begin{{align*}}\n{joined}\n\\end{{align*}}")
            block.clear()

    for step in ik.steps:
        if step.kind is Kind.HEADING:
            close()
            out.append(f"{step.name}:")
        else:
            block.append(_latex_line(step))
    close()
    out.append("The joint values:")
    block += [f"{_latex(q)} &= {_latex(v)}" for q, v in _joints(ik)]
    close()
    return "\n".join(out)


def as_markdown(ik: Derivation) -> str:
    """Formulas as Markdown: words, and formulas between dollar signs after each."""
    title, _, text = as_latex(ik).partition("\n")
    for word, sign in (("begin", "\n$$\n\\begin"), ("end", "\\end")):
        text = text.replace(f"\\{word}{{align*}}", f"{sign}{{aligned}}")
    return f"## {title[2:]}\n\n" + text.replace("\\end{aligned}", "\\end{aligned}\n$$\n") + "\n"


def _latex_line(step: Step) -> str:
    name = _latex(sp.Symbol(step.name))
    if step.kind is Kind.CHOICE:
        return f"{name} &= \\pm 1"
    value = sp.sqrt(step.value, evaluate=False) if step.kind is Kind.ROOT else step.value
    return f"{name} &= {_latex(value)}"


def _latex(value: Any) -> str:
    """An expression of LaTeX."""
    text: str = _Latex().doprint(_decimal(value))
    fixes = ("{atan}_{2}", "{atan2}"), (r"{\left(", r"\left("), (r"\right)}", r"\right)")
    for found, better in fixes:
        text = text.replace(found, better)
    return text


HEAD = '''"""{title}.

{legend}
"""

from math import atan2, cos, pi, remainder, sin, sqrt

{constants}
def ik(T{letters}):
    """All joint values [rad and m] that put the tool at a pose, joint limits aside.

    ``T`` is the pose of the tool in the base, 4 rows of 4 numbers. A list with a list of joint
    values for each branch; empty out of reach, and where a joint other than the wrist's is free.
    An arm of fewer than six joints cannot take every pose, so its branches have to be checked:
    each meets what of the pose is used here.
    """
'''

PRODUCT = """
def _product(A, B):
    return [[sum(A[i][k] * B[k][j] for k in range(4)) for j in range(4)] for i in range(4)]

"""


def as_python(ik: Derivation) -> str:
    """A module with one function that needs nothing but ``math``."""
    constants, lines = "", list[str]()
    to_base, to_last = ik.arm.to_base, ik.arm.to_last
    for name, T, product in (
        ("TO_BASE", to_base, "_product(TO_BASE, T)"),
        ("TO_LAST", to_last, "_product(T, TO_LAST)"),
    ):
        if not np.array_equal(T, np.eye(4)):
            constants += f"{name} = {_rows(T)}\n"
            lines.append(f"T = {product}")
    if constants:
        constants = f"{constants}\n{PRODUCT}"
    values = "".join(f", {name}={value!r}" for name, value in ik.arm.values.items())
    used, known = _used(ik), {sp.Symbol(name) for name in ik.arm.values}
    lines += [f"r_{i}1, r_{i}2, r_{i}3, p_{axis} = T[{i - 1}]" for i, axis in enumerate("xyz", 1)]
    lines += ["found = []"]
    depth = 1
    body = [f"    {line}" for line in lines]
    for step in ik.steps:
        pad = "    " * depth
        body += [pad + line for line in _code(step, depth, used, known)]
        depth += step.kind is Kind.CHOICE
    pad = "    " * depth
    turns = [link.slides for link in ik.arm.links]
    values_of = [
        _python(v) if slides else f"remainder({_python(v)}, 2 * pi)"
        for slides, (_, v) in zip(turns, _joints(ik), strict=True)
    ]
    body.append(f"{pad}found.append([")
    body += [f"{pad}    {value}," for value in values_of]
    body += [f"{pad}])", "    return found"]
    legend = "\n".join(_legend(ik))
    head = HEAD.format(
        title=_title(ik), legend=legend, constants=constants, letters=values and f", *{values}"
    )
    return head + "\n".join(body) + "\n"


def _rows(T: Array) -> str:
    return f"[{', '.join(repr(row) for row in T.tolist())}]"


def _used(ik: Derivation) -> set[str]:
    """Names that some formula needs."""
    values = [step.value for step in ik.steps if step.value is not None]
    values += [v for _, v in _joints(ik)]
    return {symbol.name for value in values for symbol in sp.sympify(value).free_symbols}


def _code(step: Step, depth: int, used: set[str], known: set[Any]) -> list[str]:
    """A step as statements; ``known`` is what may be divided by unseen."""
    name, leave = step.name, "continue" if depth > 1 else "return found"
    if step.kind is Kind.HEADING:
        return [f"# {name}"]
    if step.kind is Kind.CHOICE:
        return [f"for {name} in (1, -1):"]
    if step.kind is Kind.ROOT:
        lines = [f"{name} = {_python(step.value)}", f"if {name} < -{RIM}:", f"    {leave}"]
        return [*lines, f"{name} = sqrt(max({name}, 0.0))"]
    under = sp.fraction(step.value)[1]
    lines = [f"if not {_python(under)}:", f"    {leave}"] if under.free_symbols - known else []
    lines.append(f"{name} = {_python(step.value)}")
    if step.kind is Kind.ANGLE:
        k = name.removeprefix("theta_")
        lines += [
            f"{letter}_{k} = {function}({name})"
            for letter, function in (("c", "cos"), ("s", "sin"))
            if f"{letter}_{k}" in used
        ]
    return lines


def _python(value: Any) -> str:
    """An expression of Python's own operators and ``math``."""
    return re.sub(r"\bmath\.", "", sp.pycode(value))
