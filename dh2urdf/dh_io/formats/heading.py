"""What a column's heading says: ``d [mm]``, ``alpha (deg)``, ``$a_{i-1}$``, ``theta_deg``."""

import re

from dh2urdf.dh_io.cells.document import Report, Scalar
from dh2urdf.dh_io.cells.schema import ROW_KEYS, ROW_KINDS, canonical
from dh2urdf.dh_io.cells.units import UNIT_SIZES, Kind, unit_kind, unit_name

PARAMETERS = ("theta", "d", "a", "alpha")
INDEX = ("", "i", "j", "#", "no", "no.", "nr", "nr.", "n", "row", "index")
LABELS = ("joint", "link", "axis", "frame")
EMPTY = ("", "-", "–", "—", "−", "n/a")

LIMITS = {"limits", "limit", "limits_of_q", "joint_limits", "qlim", "range", "motion_range"}
"""Columns of both limits: ``-170 to 170 deg``, ``±170°``, ``[-2.9, 2.9]``."""

_DECIMAL = r"(?:\d+(?:\.\d+)?|\.\d+)"
_NUMBER = rf"[-+−–]?\s*(?:(?:{_DECIMAL}\s*\*?\s*)?(?:pi|π)(?:/\d+)?|{_DECIMAL})"
_RANGE = re.compile(
    rf"[\[(]?\s*(?P<one>{_NUMBER})\s*(?P<unit>[a-z°]*?)"
    rf"(?:\s*(?:to|\.\.\.?|…|/|~|,|;|÷)\s*|\s+[-–]\s+)"
    rf"(?P<two>{_NUMBER})\s*(?P<last>[a-z°]*)\s*[\])]?"
    rf"|(?:±|\+/?-)\s*(?P<both>{_NUMBER}\s*[a-z°]*)"
)
_UNIT = re.compile(
    r"(.+?)\s*(?:\[(.*)\]|\((.*)\)|(?:/\s*|,\s*|\sin\s+|(?=[°º]))([a-zA-Z°º]+))$"
    r"|(.+)_(mm|cm|m|deg|rad)$"
)
_ONLY_UNIT = re.compile(r"[\[(]?\s*([a-zA-Z°º]+)\s*[\])]?")
_INDEX_I = re.compile(r"[ijkn]\s*(?:[-−]\s*1)?|[rR]/[pP]|[pP]/[rR]")
_LATEX_MARKS = re.compile(r"\\[()\[\]]")
_LABEL_INDEX = re.compile(r"[\s_]*(?:\(?[ijkn#]\)?|no\.?|nr\.?|number|index|id)$")
_SI_UNITS = {
    "mass": ("kg",),
    "inertia": ("kgm2", "kgm^2", "kgm²"),
    "effort": ("n", "nm", "n,nm", "nmorn"),
    "damping": ("nms/rad", "ns/m"),
    "friction": ("n", "nm"),
}


def heading(text: str) -> tuple[str, str]:
    """Name and unit of a column: ``d [mm]``, ``alpha (deg)``, ``theta_deg``, ``yaw °``."""
    text = _LATEX_MARKS.sub("", text).strip(" *`")
    match = _UNIT.fullmatch(text)
    if match is None:
        return text, ""
    stem, unit = (match[1], match[2] or match[3] or match[4]) if match[1] else (match[5], match[6])
    if not unit or _INDEX_I.fullmatch(unit.strip()):
        return (stem if unit and "/" in unit else text), ""
    if match[4] and unit_kind(unit_name(unit)) is None:
        return text, ""
    return stem, unit_name(unit.replace("/s", ""))


def column(cell: Scalar) -> tuple[str, str]:
    """Canonical key and unit of a header cell; ``Link i`` and ``Axis`` are ``joint``."""
    name, unit = heading(cell.text)
    key = canonical(name)
    if key not in ROW_KEYS and _LABEL_INDEX.sub("", name.casefold().strip()) in LABELS:
        return "joint", ""
    first = canonical(key[:-1].rstrip("_")) if key[-1:] in "01" else ""  # theta_1, a_0
    return (first if first in PARAMETERS else key), unit


def is_header(cells: list[Scalar]) -> bool:
    """Tell whether a row names at least two of theta, d, a and alpha, or an ambiguous column."""
    return len({column(cell)[0] for cell in cells} & {*PARAMETERS, "r"}) >= 2


def limits(text: str) -> tuple[str, ...]:
    """Lower and upper limit that a cell holds, the smaller first; nothing where it holds none."""
    match = _RANGE.fullmatch(text.strip())
    if match is None:
        return ()
    if match["both"]:
        return f"-({match['both']})", match["both"]
    last = match["last"]
    ends = [
        match["one"] + " " + (match["unit"] or last),
        match["two"] + " " + (last or match["unit"]),
    ]
    if match["two"].lstrip()[0] in "-−–" and match["one"].lstrip()[0] not in "-−–":
        ends.reverse()  # +170/-170
    return tuple(ends)


def unit_alone(text: str) -> str:
    """Unit that a cell of a second header row holds: ``(mm)``; empty where it is none."""
    match = _ONLY_UNIT.fullmatch(text.strip())
    unit = unit_name(match[1]) if match else ""
    return unit if unit_kind(unit) else ""


def checked_unit(cell: Scalar, key: str, unit: str, report: Report) -> str:
    """Unit of a column, empty where it is none or does not belong there."""
    if not unit:
        return ""
    plain = re.sub(r"[\s*·]", "", unit)
    if plain in _SI_UNITS.get(key, ()) or unit in ("1", "-"):
        return ""
    either = key in ("lower", "upper", "velocity")
    kinds = (Kind.ANGLE, Kind.LENGTH) if either else (ROW_KINDS.get(key, Kind.NUMBER),)
    if unit_kind(unit) in kinds:
        return unit
    allowed = [u for kind in kinds for u in UNIT_SIZES[kind]] or list(_SI_UNITS.get(key, ("none",)))
    message = f"found unit {unit!r} for {key}; allowed: {', '.join(allowed)}"
    report.fault(cell.mark, "header", message)
    return ""


def without_name(columns: list[int]) -> str:
    """Fault of columns, counted from 0, that hold values and have no name."""
    many = len(columns) > 1
    numbers = " and ".join(str(k + 1) for k in columns)
    return f"column{'s' * many} {numbers} {'have' if many else 'has'} values but no name"
