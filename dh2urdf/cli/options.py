"""Options of every verb: how numbers are read, and which options go together.

A number on the command line is what it is in a table file: ``0.1``, ``-pi/2``, ``-90deg``,
``400mm``. It is no option, whatever it begins with.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from cyclopts import Parameter

from dh2urdf.bounds import ANGLE, LENGTH, NUMBER
from dh2urdf.dh_io import FORMATS, Kind, Units, parse_cell
from dh2urdf.dh_io.units import SI
from dh2urdf.dh_io.values import FUNCTIONS
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError, TableError

__all__ = [
    "LARGEST",
    "Values",
    "check_together",
    "marked",
    "plain",
    "read_number",
    "read_numbers",
    "real",
    "whole",
]

MARK = "\0"
"""Set before a value that begins with a hyphen, which the parser would take for an option."""

_VALUE = re.compile(
    rf"-$|-+\s*(?:[\d.,(π]|(?:pi|inf|nan)|(?:{'|'.join(FUNCTIONS)})\s*\()", re.IGNORECASE
)

Values = Annotated[list[str] | None, Parameter(consume_multiple=(1, None))]
"""Numbers after one option, parted by spaces or commas, read by :func:`read_numbers`."""

LARGEST = {Kind.LENGTH: LENGTH, Kind.ANGLE: ANGLE, Kind.NUMBER: NUMBER}


def marked(tokens: Sequence[str]) -> list[str]:
    """Tokens whose values cannot be taken for options; what follows ``--`` needs no mark."""
    end = tokens.index("--") if "--" in tokens else len(tokens)
    first = [MARK + t if _VALUE.match(t) else t.replace(MARK, "\ufffd") for t in tokens[:end]]
    return [*first, *tokens[end:]]


def plain(value: Any) -> Any:
    """A value, or a list of values, without marks."""
    if isinstance(value, (list, tuple)):
        return type(value)(plain(v) for v in value)
    if isinstance(value, (str, Path)):
        return type(value)(str(value).removeprefix(MARK))
    return value


def read_numbers(
    values: Iterable[str],
    what: str,
    sizes: Sequence[int],
    kinds: Kind | Sequence[Kind] = Kind.NUMBER,
    units: Units = SI,
    *,
    names: Sequence[str] = (),
    error: type[Dh2UrdfError] = ArgumentError,
) -> list[float]:
    """Numbers of an option or a line in [m], [rad] or plain; commas part them as spaces do.

    Parameters
    ----------
    values : iterable of str
    what : str
        The option, for messages.
    sizes : sequence of int
        How many there may be.
    kinds : Kind or sequence of Kind
        What they measure, all of them or each.
    units : Units
        Units of bare numbers.
    names : sequence of str
        What each is called, for messages.
    error : exception type

    Raises
    ------
    ArgumentError
        Or ``error``.
    """
    cells = [cell.strip() for value in values for cell in value.split(",") if cell.strip()]
    if len(cells) not in sizes:
        wanted = " or ".join(map(str, sizes))
        needed = f"values are needed ({', '.join(names)})" if names else "numbers are needed"
        raise error(f"{what}: {wanted} {needed}, got {len(cells)}")
    each = [kinds] * len(cells) if isinstance(kinds, Kind) else kinds
    out = []
    for k, (cell, kind) in enumerate(zip(cells, each, strict=False)):
        where = f"{what}: {names[k]}" if names else what
        out.append(read_number(cell, where, kind, units, error))
    return out


def read_number(cell: str, what: str, kind: Kind, units: Units, error: type[Dh2UrdfError]) -> float:
    """One of the numbers of :func:`read_numbers`."""
    return _number(cell, what, kind, units, (-LARGEST[kind], LARGEST[kind]), error)


def _number(
    cell: str,
    what: str,
    kind: Kind,
    units: Units,
    bounds: tuple[float, float],
    error: type[Dh2UrdfError] = ArgumentError,
) -> float:
    """One number; where it has no name the parser puts it before the message."""
    start = f"{what}: " if what else ""
    try:
        value = parse_cell(cell, kind, units)
    except TableError as fault:
        hint = getattr(fault, "hint", "")
        raise error(f"{start}{found(cell)}: {fault}{hint and '; ' + hint}") from None
    low, high = bounds
    if not low <= value <= high:
        unit = f" {SI.of(kind)}".rstrip()
        raise error(f"{start}expected a number from {low:g} to {high:g}{unit}, got {found(cell)}")
    return value


def real(low: float, high: float, kind: Kind = Kind.NUMBER) -> Parameter:
    """An option that takes one number between bounds, in [m], [rad] or plain."""

    def read(_: object, tokens: Sequence[Any]) -> float:
        return _number(plain(tokens[0].value), "", kind, SI, (low, high))

    return Parameter(converter=read)


def whole(low: int, high: int) -> Parameter:
    """An option that takes a whole number between bounds."""

    def read(_: object, tokens: Sequence[Any]) -> int:
        cell = plain(tokens[0].value)
        value = _number(cell, "", Kind.NUMBER, SI, (-NUMBER, NUMBER))
        if value.is_integer() and low <= value <= high:
            return int(value)
        raise ArgumentError(f"expected a whole number from {low} to {high}, got {found(cell)}")

    return Parameter(converter=read)


class Rule(NamedTuple):
    """An option and those that it needs, one of them at least, or does not go with.

    An option stands for itself, for one value (``task=position``) or for the suffix of a path
    (``output=.svg``); with ``+`` for several at once.
    """

    option: str
    needs: str = ""
    bars: str = ""
    why: str = "it would change nothing"


_TABLES = " ".join(f"output={suffix}" for suffix in FORMATS)

_OF_URDF = ("digits", "collision", "dh_frames", "balance_inertia")

RULES: dict[str, tuple[Rule, ...]] = {
    "show_": (
        Rule("format", bars="json symbolic values q", why="it prints the table alone"),
        Rule("json", bars="symbolic", why="symbols are text"),
        Rule("deg", needs="values q"),
        Rule("values", bars="q", why="both are the joint values"),
    ),
    "fk_": (Rule("values", bars="q", why="both are the joint values"),),
    "ik_": (
        Rule("csv", bars="xyz rpy matrix", why="a file of poses stands alone"),
        Rule("matrix", bars="xyz rpy", why="the matrix is the whole pose"),
        Rule("rpy", bars="task=position", why="a position has no orientation"),
        Rule("nearest", needs="matrix csv"),
    ),
    "figure_": (
        Rule("dpi", bars="output=.svg output=.pdf", why="it is the resolution of a PNG"),
        Rule("deg", needs="q"),
    ),
    "workspace_": (Rule("deg", needs="rpy"),),
    "view_": (
        Rule("base", needs="robot"),
        Rule("tip", needs="robot"),
        Rule("deg", needs="q"),
    ),
    "extract_": (
        Rule("json", bars="output=-", why="both would go to stdout"),
        Rule("json+format", needs="output"),
        Rule("force", needs="output"),
        Rule("force", bars="output=-"),
    ),
    "convert_": (
        Rule("output", bars="out_dir", why="each says where to write"),
        Rule("force", bars="output=-"),
        *(Rule(o, bars=_TABLES, why="it is for a URDF") for o in _OF_URDF),
    ),
}
"""For each verb, the options that say nothing, or two things, beside others."""


def check_together(verb: str, given: Mapping[str, Any]) -> None:
    """Refuse options that do nothing, or contradict one another, together.

    Parameters
    ----------
    verb : str
        Name of its function.
    given : mapping
        The arguments that were given, by name.

    Raises
    ------
    ArgumentError
    """
    for option, needs, bars, why in RULES.get(verb, ()):
        if not _is_given(option, given):
            continue
        if needs and not any(_is_given(other, given) for other in needs.split()):
            others = " or ".join(map(_shown, needs.split()))
            raise ArgumentError(f"{_shown(option)} does nothing without {others}")
        for other in bars.split():
            if _is_given(other, given):
                raise ArgumentError(f"{_shown(option)} does not go with {_shown(other)}: {why}")


def _is_given(option: str, given: Mapping[str, Any]) -> bool:
    if "+" in option:
        return all(_is_given(part, given) for part in option.split("+"))
    name, _, wanted = option.partition("=")
    value = given.get(name)
    if value is None or value == ():
        return False
    suffix = value.suffix.lower() if isinstance(value, Path) else ""
    return not wanted or wanted in (str(value), suffix)


def _shown(option: str) -> str:
    """``--task position``, or ``VALUES`` where it has no name on the command line."""
    if "+" in option:
        return " with ".join(map(_shown, option.split("+")))
    name, _, value = option.partition("=")
    shown = name.upper() if name in ("values", "robot") else "--" + name.replace("_", "-")
    return f"{shown} {value}".rstrip()
