"""The number that a formula of a worked solution gives, and the whole turns it is off by."""

import math
from collections.abc import Callable

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
"""Difference [rad] between a formula's number and its value that is no turn."""


def turns_between(formula: str, given: Given, value: float) -> int:
    """The whole turns that lead from the number of a formula of angles to its value [rad].

    0 where the formula has either sign, a vector or a letter without a number.
    """
    try:
        number = _Sum(tokens(formula), given).read()
    except (LookupError, ValueError, ZeroDivisionError):
        return 0
    turns = round((value - number) / math.tau)
    return turns if abs(value - number - turns * math.tau) < CLOSE else 0


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
        if self.rest[0].text == "-":
            self.rest.pop(0)
            return -self._power()
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
