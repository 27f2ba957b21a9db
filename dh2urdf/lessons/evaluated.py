"""The number that a formula of a worked solution gives, and the whole turns it is off by."""

import math
from collections.abc import Callable
from contextlib import suppress

import numpy as np

from dh2urdf.lessons.notation import Given, Token, tokens

FUNCTIONS: dict[str, Callable[..., float]] = {
    "atan2": math.atan2,
    "sqrt": math.sqrt,
    "cos": math.cos,
    "sin": math.sin,
    "acos": math.acos,
}

CLOSE = 1e-6
"""Difference [rad] between a formula's number and its value that is rounding."""

NEAR = 1e-3
"""Difference [rad] of an arc cosine at its rim from the value, of which digits are lost."""


def turn_shown(formula: str, given: Given, values: tuple[float, ...]) -> str:
    """What leads from the number of a formula of angles to its values [rad]; mostly nothing.

    `` + 2π`` where a turn is added, `` (mod 2π)`` where the formula has either sign, so that one
    value may need a turn and the other none. Empty for vectors and letters without a number.
    """
    numbers = _numbers(formula, given)
    gaps = [[value - number for number in numbers] for value in values]
    if len(numbers) > 1:
        turned = any(any(map(_turns, gap)) and min(map(abs, gap)) > NEAR for gap in gaps)
        return " (mod 2π)" if turned else ""
    turns = _turns(gaps[0][0]) if numbers else 0
    return f" {'+' if turns > 0 else '-'} {2 * abs(turns)}π" if turns else ""


def _turns(gap: float) -> int:
    """Whole turns in an angle [rad]; 0 where there is more."""
    turns = round(gap / math.tau)
    return turns if abs(gap - turns * math.tau) < CLOSE else 0


def _numbers(formula: str, given: Given) -> list[float]:
    """What a formula gives, for each of its signs; nothing where it is no number."""
    found = tokens(formula)
    signs = ("+", "-") if any(token.text == "+-" for token in found) else ("",)
    out = []
    for sign in signs:
        signed = [Token("sign", sign) if token.text == "+-" else token for token in found]
        with suppress(LookupError, ValueError, ZeroDivisionError):
            out.append(_Sum(signed, given).read())
    return out if len(out) == len(signs) else []


class _Sum:
    """The pieces of a formula, read from the left; errors where one has no number."""

    def __init__(self, found: list[Token], given: Given) -> None:
        self.rest, self.given = [*found, Token("sign", "")], given

    def read(self) -> float:
        """Terms, up to a comma, a closing bracket or the end."""
        number = self._term()
        while self.rest[0].text in {"+", "-"}:
            sign = -1.0 if self.rest.pop(0).text == "-" else 1.0
            number += sign * self._term()
        if self.rest[0].text not in {"", ",", ")"}:
            raise ValueError(self.rest[0].text)
        return number

    def _term(self) -> float:
        number = self._power()
        while self.rest[0].text in {"*", "/"}:
            times = self.rest.pop(0).text == "*"
            factor = self._power()
            number = number * factor if times else number / factor
        return number

    def _power(self) -> float:
        if self.rest[0].text in {"+", "-"}:
            sign = -1.0 if self.rest.pop(0).text == "-" else 1.0
            return sign * self._power()
        number = self._operand()
        if self.rest[0].text != "^":
            return number
        exponent = int(self.rest[1].text)
        del self.rest[:2]
        return float(number**exponent)

    def _operand(self) -> float:
        kind, text = self.rest.pop(0)
        if kind == "number":
            return float(text)
        if kind == "function" or text == "(":
            arguments = self._arguments(0 if text == "(" else 1)
            return arguments[0] if text == "(" else FUNCTIONS[text](*arguments)
        if np.ndim(self.given[text]):
            raise ValueError(text)
        return float(self.given[text])

    def _arguments(self, opening: int) -> list[float]:
        """What stands within brackets; ``opening``: pieces before its first one."""
        del self.rest[:opening]
        found = [self.read()]
        while self.rest.pop(0).text == ",":
            found.append(self.read())
        return found
