"""Formulas of worked solutions, computed as they are printed."""

import math
import re

import numpy as np

from dh2urdf.lessons.notation import tokens

FUNCTIONS = {name: getattr(math, name) for name in ("atan2", "sqrt", "cos", "sin")}
FUNCTIONS["acos"] = lambda c: math.acos(min(1.0, max(-1.0, c)))


def computed(equation):
    """The values of an equation's formula with its numbers put in: one for each of its signs."""
    pieces = tokens(equation.via or equation.formula)
    python = "".join({"^": "**"}.get(piece.text, piece.text) for piece in pieces)
    letters = {**FUNCTIONS, "pi": math.pi, **equation.given}
    signs = ("+", "-") if "+-" in python else ("",)
    return [eval(python.replace("+-", sign), {}, letters) for sign in signs]


def off(equation):
    """How far the value of an equation is from its formula and the turn that is shown behind it.

    Angles without numbers, and those modulo 2π, are compared on the circle.
    """
    gaps = []
    shown = re.search(r" ([-+] \d+)π$", equation.numbers)
    turn = int(shown[1].replace(" ", "")) * math.pi if shown else 0.0
    free = not equation.numbers or equation.numbers.endswith(" (mod 2π)")
    for value in computed(equation):
        gap = np.asarray(value) + turn - np.asarray(equation.value)
        if equation.unit == "rad" and free:
            gap = np.remainder(gap + math.pi, 2.0 * math.pi) - math.pi
        gaps.append(float(np.abs(gap).max()))
    return min(gaps)


def is_plain(equation):
    """Whether all letters of a formula have numbers, and none is a matrix; there are some."""
    pieces = tokens(equation.via or equation.formula)
    names = [piece.text for piece in pieces if piece.kind == "name"]
    known = bool(names) and all(np.ndim(equation.given.get(name, np.eye(2))) < 2 for name in names)
    return known and not any(piece.text == "FK" for piece in pieces)
