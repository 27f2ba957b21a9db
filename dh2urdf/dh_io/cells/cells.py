"""Cells to values: the layer between the raw document and the rows."""

import re
from dataclasses import dataclass, field, replace
from decimal import Decimal

from dh2urdf.bounds import RATIO
from dh2urdf.dh import JointType, Origin
from dh2urdf.dh.quoting import XML_FORBIDDEN
from dh2urdf.dh_io.cells.document import NOWHERE, Items, Keys, Mark, Node, Report, Scalar
from dh2urdf.dh_io.cells.expressions import PI_NAMES, Lookup, evaluate, plain_text, to_float
from dh2urdf.dh_io.cells.schema import FLAGS, MISUSED_KEYS, TRUTHS, canonical, did_you_mean, nearest
from dh2urdf.dh_io.cells.units import EXACT, SI, Kind, Units, to_si, unit_kind, unit_name
from dh2urdf.dh_io.cells.values import FUNCTIONS, ExpressionError, Value
from dh2urdf.exceptions import TableError

_SLIPS = str.maketrans({"O": "0", "o": "0", "l": "1", "I": "1", ",": "."})
_LINK_LENGTH = re.compile(r"[lI]_?\d")
_NUMBER_MUST = re.compile(r"^-?[\d.e+-]+ (?=must)")
_RATIO = re.compile(r"(.*?)\s*([^\W\d_]+|°)\s*/\s*([^\W\d_]+|°)")
_PLAIN_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


def found(node: Node) -> str:
    """Text of a cell as messages show it."""
    if isinstance(node, Scalar):
        text = node.text if len(node.text) <= 60 else node.text[:57] + "..."
        return text if _PLAIN_NUMBER.fullmatch(text) else repr(text)
    return "a list" if isinstance(node, Items) else "keys and values"


@dataclass
class Context:
    """What all cells of a file share.

    By path: ``places`` of cells, ``marks`` of keys, ``ratios`` the kinds that multipliers say.
    ``names`` are those of the joints that were read.
    """

    report: Report
    units: Units = SI
    constants: dict[str, Value] = field(default_factory=dict)
    places: dict[str, Scalar] = field(default_factory=dict)
    ratios: dict[str, tuple[Kind, Kind] | None] = field(default_factory=dict)
    marks: dict[str, Mark] = field(default_factory=dict)
    names: list[str] = field(default_factory=list)

    def value(
        self, cell: Node, path: str, kind: Kind, lookup: Lookup | None = None, *, free: bool = False
    ) -> Value | None:
        """Value of a cell, None (and a fault) where it has none."""
        if not isinstance(cell, Scalar):
            self.report.fault(
                cell.mark, path, f"found {found(cell)}; expected one {self._one(kind)}"
            )
            return None
        self.places[path] = cell
        if cell.unit and unit_kind(cell.unit) not in (None, kind):
            message = f"found {found(cell)} in a column in {cell.unit}; expected {self._one(kind)}"
            self.report.fault(cell.mark, path, message)
            return None
        try:
            value = evaluate(cell.text, kind, self._units(cell), lookup or self.lookup, free=free)
            to_float(value.number)
        except ExpressionError as error:
            message = f"found {found(cell)}; {error}"
            hint = _slip(cell.text) or error.hint or f"expected {self._one(kind)}"
            self.report.fault(cell.mark, path, message, hint)
            return None
        return value

    def number(self, cell: Node, path: str, kind: Kind = Kind.NUMBER) -> float | None:
        """Float in [m], [rad] or plain; None (and a fault) where the cell has none."""
        value = self.value(cell, path, kind)
        return None if value is None else to_float(value.number)

    def numbers(
        self, node: Node, path: str, kind: Kind, size: int, names: str
    ) -> tuple[float, ...] | None:
        """Floats from a list, or from a text such as ``0 1.5 0``."""
        unit = node.unit if isinstance(node, Scalar) else ""
        if isinstance(node, Scalar):
            words = re.split(r"[\s,;]+", node.text.strip("[]() "))
            node = Items(tuple(Scalar(w, node.mark, unit) for w in words), node.mark)
        count = len(node.values) if isinstance(node, Items) else 0
        if not isinstance(node, Items) or count != size:
            what = f"{count} values" if isinstance(node, Items) else found(node)
            self.report.fault(node.mark, path, f"found {what}; expected {size}: [{names}]")
            return None
        values = [self.number(v, f"{path}[{i}]", kind) for i, v in enumerate(node.values, 1)]
        return None if None in values else tuple(v for v in values if v is not None)

    def text(self, node: Node, path: str) -> str:
        """Plain text of a cell."""
        if not isinstance(node, Scalar):
            self.report.fault(node.mark, path, f"found {found(node)}; expected a text")
            return ""
        if path.endswith("name") and XML_FORBIDDEN.search(node.text):
            message = f"{node.text!r} holds a character that XML forbids; no URDF can be written"
            self.report.warn(node.mark, path, message)
        return node.text

    def lookup(self, name: str) -> Value:
        """Value of a constant."""
        if name in self.constants:
            return self.constants[name]
        raise self.unknown(name)

    def unknown(self, name: str, variable: str = "") -> ExpressionError:
        """Error for a name without a value."""
        if name.casefold() in ("true", "false", "yes", "no", "none", "null"):
            return ExpressionError(f"{name!r} is not a number")
        names = [*self.constants, *FUNCTIONS, "pi", *([variable] if variable else [])]
        if self.constants:
            known = f"constants: has {', '.join(sorted(self.constants)[:12])}"
        else:
            example = self.report.example("constants", **{f"{name:.20}": "0.4"})
            known = f"give its value, as in {example}"
            known = "a number in its place" if self.report.format == "frame" else known
        return ExpressionError(
            f"{name!r} has no value", _slip(name) or did_you_mean(name, names) or known
        )

    def define(self, node: Node) -> None:
        """Read ``constants:``; each may use those above it."""
        if not isinstance(node, Keys):
            self.report.fault(node.mark, "constants", f"found {found(node)}; expected name: value")
            return
        for key, cell in node.pairs:
            name, path = plain_text(key.text), f"constants.{key.text:.40}"
            if not name.isidentifier() or name in PI_NAMES or unit_kind(unit_name(name)):
                hint = "a letter, then letters, digits and _; not pi or a unit"
                self.report.fault(key.mark, path, "not a name for a constant", hint)
            elif name in self.constants:
                self.report.fault(key.mark, path, "given twice")
            else:
                value = self.value(cell, path, Kind.NUMBER, free=True)
                self.constants[name] = value or Value(Decimal(1))

    def mark_of(self, path: str) -> Mark:
        """Where a cell, or the one that holds it, was read."""
        while path and path not in self.marks and path not in self.places:
            path = path.rpartition(".")[0]
        return self.places[path].mark if path in self.places else self.marks.get(path, NOWHERE)

    def ratio(self, cell: Node, path: str) -> float | None:
        """A multiplier: a plain number, or with units such as ``0.8 mm/deg`` in [m] and [rad]."""
        match = _RATIO.fullmatch(cell.text.strip()) if isinstance(cell, Scalar) else None
        units = [unit_name(word) for word in match.groups()[1:]] if match else []
        upper, lower = map(unit_kind, units or ("", ""))
        number, size = cell, Decimal(1)
        self.ratios[path] = None
        if match and upper and lower and isinstance(cell, Scalar):
            self.ratios[path], number = (upper, lower), replace(cell, text=match[1])
            size = EXACT.divide(*(to_si(size, unit) for unit in units))
        value = self.value(number, path, Kind.NUMBER)
        if value is None or not isinstance(cell, Scalar):
            return None
        self.places[path] = cell
        out = to_float(EXACT.multiply(value.number, size))
        if abs(out) <= RATIO:
            return out
        expected = f"expected a number from {-RATIO:g} to {RATIO:g}"
        self.report.fault(cell.mark, path, f"found {found(cell)}; {expected}")
        return None

    def _units(self, cell: Scalar) -> Units:
        """Units of a cell, its column's where the header names one."""
        kind = unit_kind(cell.unit)
        return self.units._replace(**{kind.value: cell.unit}) if kind else self.units

    def _one(self, kind: Kind) -> str:
        unit = f" [{self.units.of(kind)}]" if self.units.of(kind) else ""
        return f"{kind}{unit}: a number or an expression such as {_EXAMPLES[kind]}"


_EXAMPLES = {
    Kind.ANGLE: "-90, pi/2, 90deg",
    Kind.LENGTH: "0.335, 2*l1, 100mm",
    Kind.NUMBER: "1.5, 3/4",
}


def _slip(text: str) -> str:
    """Hint where only letters for digits or a decimal comma keep a text from being a number."""
    if _LINK_LENGTH.fullmatch(text.strip()):
        return ""
    fixed = text.strip().translate(_SLIPS)
    right = fixed != text.strip() and _PLAIN_NUMBER.fullmatch(fixed) and any(map(str.isdigit, text))
    return f"did you mean {fixed}?" if right else ""


def _typed(key: str, cell: Node) -> tuple[str, Node]:
    """``R: true`` and ``prismatic: false`` as the type of a joint."""
    truth = TRUTHS.get(cell.text.strip().casefold()) if isinstance(cell, Scalar) else None
    if key not in FLAGS or truth is None or not isinstance(cell, Scalar):
        return key, cell
    other = {JointType.REVOLUTE: JointType.PRISMATIC, JointType.PRISMATIC: JointType.REVOLUTE}
    return "type", replace(cell, text=str(FLAGS[key] if truth else other[FLAGS[key]]))


class Cells:
    """The cells of one mapping by their canonical keys; unknown and doubled keys are faults."""

    def __init__(self, node: Node, path: str, allowed: tuple[str, ...], report: Report) -> None:
        self.mark, self.report = node.mark, report
        self.path, self.cells = path, dict[str, Node]()
        self.keys, self.meant = dict[str, Scalar](), set[str]()
        if not isinstance(node, Keys):
            keys = ", ".join(allowed)
            report.fault(node.mark, path, f"found {found(node)}; expected the keys {keys}")
            self.meant.update(allowed)
            return
        for key, cell in node.pairs:
            name, content = canonical(key.text), cell
            if "type" in allowed:
                name, content = _typed(name, cell)
            where = self.at(key.text[:40])
            if name not in allowed:
                meant = nearest(name, allowed)
                self.meant.add(meant)
                hint = MISUSED_KEYS.get(name) or (f"did you mean {meant}?" if meant else "")
                message = f"unknown key {found(key)}; allowed: {', '.join(allowed)}"
                report.fault(key.mark, where, message, hint)
            elif name in self.keys:
                first = self.keys[name]
                also = f" as {first.text!r}" if first.text != key.text else ""
                report.fault(key.mark, where, f"given twice, first in line {first.mark.line}{also}")
            else:
                self.keys[name] = key
                if not (isinstance(content, Scalar) and not content.text):
                    self.cells[name] = content

    def at(self, key: str) -> str:
        """Path of one cell: ``joints[3].alpha``."""
        return f"{self.path}.{key}" if self.path else key

    def get(self, key: str) -> Node | None:
        """Cell of a key, None where there is none or it is empty."""
        return self.cells.get(key)

    def refuse(self, error: TableError) -> None:
        """Note what a row or a rigid step refuses at the cells that it names."""
        for problem in error.problems:
            key, _, message = problem.partition(": ")
            cell = self.cells.get(key)
            if cell is not None:
                message = _NUMBER_MUST.sub("it ", message.partition(", got ")[0])
                message = f"found {found(cell)}; {message}"
            self.report.fault(self.mark_of(key), self.at(key), message)

    def origin(self, xyz: tuple[float, ...] | None, rpy: tuple[float, ...] | None) -> Origin:
        """The rigid step of two cells, none (and a fault) where it is beyond all bounds."""
        none = (0.0, 0.0, 0.0)
        try:
            return Origin(xyz or none, rpy or none)  # type: ignore[arg-type]
        except TableError as error:
            self.refuse(error)
            return Origin()

    def is_missing(self, key: str) -> bool:
        """Tell whether a cell is absent, and this not a fault already (misspelt, no mapping)."""
        return key not in self.cells and key not in self.meant

    def mark_of(self, key: str) -> Mark:
        """Place of a cell; of its key, or of the mapping, where it is missing."""
        for place in (self.cells, self.keys):
            if key in place:
                return place[key].mark
        return self.mark
