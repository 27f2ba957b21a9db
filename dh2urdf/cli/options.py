"""Options of every verb: how numbers are read, and which options go together.

A number on the command line is what it is in a table file: ``0.1``, ``-pi/2``, ``-90deg``,
``400mm``. It is no option, whatever it begins with.
"""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from dh2urdf.bounds import ANGLE, DPI, LENGTH, NUMBER
from dh2urdf.dh_io import WRITTEN, Kind, Units, parse_cell
from dh2urdf.dh_io.cells.units import SI
from dh2urdf.dh_io.cells.values import FUNCTIONS
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError, TableError

MARK = "\0"
"""Set before a value that begins with a hyphen, which the parser would take for an option."""

_VALUE = re.compile(
    rf"-$|-+\s*(?:[\d.,(π]|(?:pi|inf|nan)|(?:{'|'.join(FUNCTIONS)})\s*\()", re.IGNORECASE
)

Values = Annotated[list[str] | None, Parameter(consume_multiple=(1, None))]
"""Numbers after one option, parted by spaces or commas, read by :func:`read_numbers`."""


Arm = Annotated[
    str, Parameter(help="A table file, the name of a table that ships, or a URDF; - for stdin.")
]
Link = Annotated[str | None, Parameter(help="Link of a URDF where the chain begins or ends.")]
Deg = Annotated[bool, Parameter(help="Bare angles are degrees.")]
Json = Annotated[bool, Parameter(help="One JSON object instead of text.")]
Force = Annotated[bool, Parameter(help="Replace a file that dh2urdf did not write.")]
PicturePath = Annotated[
    Path, Parameter(name=["--output", "-o"], help="The picture to write: .png, .svg or .pdf.")
]
OptionalPicture = Annotated[
    Path | None,
    Parameter(name=["--output", "-o"], help="The picture to write: .png, .svg or .pdf."),
]
PagePath = Annotated[
    Path | None,
    Parameter(
        name=["--output", "-o"],
        help="An .html to write the arm to instead: one page with sliders, which works offline.",
    ),
]

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
    kinds: Kind | Sequence[Kind],
    units: Units,
    *,
    names: Sequence[str] = (),
    error: type[Dh2UrdfError] = ArgumentError,
) -> list[float]:
    """Numbers of an option in [m], [rad] or plain, parted by spaces or commas.

    ``sizes`` says how many there may be, ``kinds`` what they measure, all or each, ``units`` in
    what bare ones are, and ``names`` what each is called in messages; ``error`` is raised.
    """
    cells = [cell.strip() for value in values for cell in value.split(",") if cell.strip()]
    if len(cells) not in sizes:
        needed = f"values are needed ({', '.join(names)})" if names else "numbers are needed"
        raise error(f"{what}: {' or '.join(map(str, sizes))} {needed}, got {len(cells)}")
    each = [kinds] * len(cells) if isinstance(kinds, Kind) else kinds
    places = [f"{what}: {name}" for name in names] or [what] * len(cells)
    return [
        read_number(cell, place, kind, units, error)
        for cell, place, kind in zip(cells, places, each, strict=False)
    ]


def read_number(
    cell: str,
    what: str,
    kind: Kind,
    units: Units = SI,
    error: type[Dh2UrdfError] = ArgumentError,
    bounds: tuple[float, float] | None = None,
) -> float:
    """One number in [m], [rad] or plain; the parser says itself which option ``what`` is."""
    start = f"{what}: " if what else ""
    try:
        value = parse_cell(cell, kind, units)
    except TableError as fault:
        hint = getattr(fault, "hint", "")
        raise error(f"{start}{found(cell)}: {fault}{hint and '; ' + hint}") from None
    low, high = bounds or (-LARGEST[kind], LARGEST[kind])
    if not low <= value <= high:
        unit = f" {SI.of(kind)}".rstrip()
        raise error(f"{start}expected a number from {low:g} to {high:g}{unit}, got {found(cell)}")
    return value


def real(low: float, high: float, kind: Kind = Kind.NUMBER) -> Parameter:
    """An option that takes one number between bounds, in [m], [rad] or plain."""
    read = partial(read_number, what="", kind=kind, bounds=(low, high))
    return Parameter(converter=lambda _, tokens: read(plain(tokens[0].value)))


def whole(low: int, high: int) -> Parameter:
    """An option that takes a whole number between bounds."""

    def read(_: object, tokens: Sequence[Any]) -> int:
        cell = plain(tokens[0].value)
        value = read_number(cell, "", Kind.NUMBER, bounds=(-math.inf, math.inf))
        if value.is_integer() and low <= value <= high:
            return int(value)
        raise ArgumentError(f"expected a whole number from {low} to {high}, got {found(cell)}")

    return Parameter(converter=read)


Dpi = Annotated[float, real(*DPI), Parameter(help="Resolution of a PNG.")]

Digits = Annotated[int | None, whole(0, 17)]

_BODIES = "collision dh_frames balance_inertia"
_TABLES = dict.fromkeys((f"output={suffix}" for suffix in WRITTEN), _BODIES)
_TABLES |= dict.fromkeys((f"format={name}" for name in WRITTEN.values()), _BODIES)

_NO_TABLE = "convention snap explain digits x_axis compact flip embedded"
_FORMS = {f"format={form}": _NO_TABLE for form in ("opw", "screws", "kdl")}

ALONE: dict[str, dict[str, str]] = {
    "show": {"format": "symbolic values q", "q": "values"},
    "fk": {"q": "values"},
    "ik": {
        "csv": "xyz rpy matrix",
        "csv=-": "robot=-",
        "best": "turns=all",
        "matrix": "xyz rpy",
        "task=position": "rpy",
        "explain": "csv words",
        "json": "format",
        "symbolic": "xyz rpy matrix csv seed locked explain words deg "
        "task=position task=position+axis turns=all within_limits=False",
    },
    "figure": {"output=.svg": "dpi", "output=.pdf": "dpi"},
    "workspace": {
        "envelope": "plane at rpy points orientations",
        "exact": "envelope plane at rpy points orientations",
    },
    "place": {"output=.svg": "dpi", "output=.pdf": "dpi"},
    "check": {"fix": "run", "json": "format=sarif format=junit format=html"},
    "view": {"output": "host port open map"},
    "extract": {**_FORMS, "output=-": "force"},
    "export": {"ros2": "output language prefix held base tip tests", "output=-": "force tests"},
    "convert": {"output": "out_dir", "output=-": "force", **_TABLES},
}
"""For each verb, options, and those that say nothing beside them.

An option stands for itself, for one value (``task=position``) or for the suffix of a path
(``output=.svg``); with ``+`` for two at once.
"""

NEEDED: dict[str, dict[str, str]] = {
    "show": {"deg": "values q"},
    "ik": {
        "best": "csv",
        "output": "csv",
        "force": "output",
        "nearest": "matrix csv",
        "seed_tolerance": "seed",
        "solution": "explain",
        "format": "explain symbolic",
        "format=python": "symbolic",
    },
    "figure": {"deg": "q", "task": "branches"},
    "workspace": {"deg": "rpy"},
    "map": {"within": "towards", "spins": "towards"},
    "place": {"force": "output", "dpi": "output"},
    "path": {"force": "output figure", "dpi": "figure"},
    "view": {
        "map": "robot",
        "base": "robot",
        "tip": "robot",
        "deg": "q",
        "output": "robot",
        "force": "output",
    },
    "check": {"base": "fix", "tip": "fix", "force": "fix"},
    "extract": {"force": "output"},
    "export": {"plugin": "ros2", "tests": "output"},
}
"""For each verb, options, and those without one of which they say nothing."""


def check_together(verb: str, given: Mapping[str, Any]) -> None:
    """Refuse options that say nothing beside or without others."""
    facts = set()
    for name, value in given.items():
        if value is not None and value != ():
            suffix = value.suffix.lower() if isinstance(value, Path) else value
            facts |= {name, f"{name}={value}", f"{name}={suffix}"}
    for option, others in ALONE.get(verb, {}).items():
        for other in others.split():
            if {option, other} <= facts:
                raise ArgumentError(
                    f"{_shown(option)} stands alone: {_shown(other)} does nothing beside it"
                )
    for option, others in NEEDED.get(verb, {}).items():
        if facts >= set(option.split("+")) and not facts & set(others.split()):
            needed = " or ".join(map(_shown, others.split()))
            raise ArgumentError(f"{_shown(option)} does nothing without {needed}")


def _shown(option: str) -> str:
    """``--task position``, or ``VALUES`` where it has no name on the command line."""
    if option.endswith("=False"):
        return f"--no-{option.removesuffix('=False').replace('_', '-')}"
    parts = [part.replace("_", "-").partition("=") for part in option.split("+")]
    return " with ".join(
        f"{name.upper() if name in ('values', 'robot') else '--' + name} {value}".rstrip()
        for name, _, value in parts
    )
