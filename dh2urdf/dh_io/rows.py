"""One row of a table file to a `DHRow`, with every fault of the row noted."""

import re
from collections.abc import Callable
from decimal import Decimal
from typing import Any, TypeVar

from dh2urdf.dh import DHRow, JointType, Mimic, Origin
from dh2urdf.dh_io.cells.cells import Cells, Context, found
from dh2urdf.dh_io.cells.document import Node, Scalar
from dh2urdf.dh_io.cells.expressions import Lookup, plain_text, to_float
from dh2urdf.dh_io.cells.schema import BY_TYPE, JOINT_TYPES, ROW_KEYS, ROW_KINDS, did_you_mean
from dh2urdf.dh_io.cells.units import Kind
from dh2urdf.dh_io.cells.values import ExpressionError, Value
from dh2urdf.dh_io.couplings import read_mimic
from dh2urdf.dh_io.others_variables import hint_of
from dh2urdf.exceptions import TableError

_VARIABLE = re.compile(
    r"(?:(?P<angle>theta|Theta|th|θ|ϑ|t(?=_?\d))|(?P<length>d|[lsℓ](?=_?[\di]))|(?P<either>q|var(?:iable)?))"
    r"_?(?P<index>\d+|i)?"
)
_PARAMETERS = ("theta", "d", "a", "alpha")
_ORIGIN = ("xyz", "rpy")

Read = TypeVar("Read")


def read_row(node: Node, path: str, joint: int, context: Context) -> DHRow:
    """Read one row, ``joints[3]``; if it moves it is joint 3, say, which allows ``theta3``.

    Where a cell is at fault the row holds a stand-in, so that the other cells are checked too.
    """
    return _Row(Cells(node, path, ROW_KEYS, context.report), joint, context).read()


class _Row:
    def __init__(self, cells: Cells, joint: int, context: Context) -> None:
        self.cells, self.joint, self.context = cells, joint, context
        self.bad: set[str] = set()
        self.type = JointType.REVOLUTE

    def fault(self, key: str, message: str, hint: str = "") -> None:
        """Note a fault of one cell, with what stands there."""
        cell = self.cells.get(key)
        if cell is not None:
            message = f"found {found(cell)}; {message}"
        self.bad.add(key)
        self.context.report.fault(self.cells.mark_of(key), self.cells.at(key), message, hint)

    def read(self) -> DHRow:
        declared = self.declared_type()
        parts = {key: self.parameter(key) for key in _PARAMETERS}
        self.type = declared or self.inferred_type(parts)
        fields: dict[str, Any] = {k: to_float(v.number) for k, v in parts.items() if v is not None}
        fields["sign"] = self.sign(parts)
        self.check_variables(parts)
        self.check_missing()
        kind = Kind.LENGTH if self.type is JointType.PRISMATIC else Kind.ANGLE
        for key in BY_TYPE:
            fields[key] = self.number(key, kind)
        fields["mimic"] = self.mimic(kind)
        for key in ("effort", "damping", "friction", "mass"):
            fields[key] = self.number(key, Kind.NUMBER)
        fields["com"] = self.vector("com", "x, y, z")
        fields["inertia"] = self.inertia(fields["mass"], fields["com"])
        fields["origin"] = self.origin()
        name = self.cells.get("name")
        fields["name"] = self.context.text(name, self.cells.at("name")) if name else ""
        self.check_limits(fields)
        return self.build(fields)

    def declared_type(self) -> JointType | None:
        cell = self.cells.get("type")
        if cell is None:
            return None
        word = cell.text.strip().casefold() if isinstance(cell, Scalar) else ""
        if word in JOINT_TYPES:
            return JOINT_TYPES[word]
        hint = did_you_mean(word, JOINT_TYPES)
        if word == "continuous":
            hint = "a revolute joint without lower and upper turns without end"
        self.fault("type", "allowed: revolute (R), prismatic (P), fixed", hint)
        return None

    def inferred_type(self, parts: dict[str, Value | None]) -> JointType:
        """By the variable that stands in theta or d; a row with xyz or rpy is fixed."""
        d = parts["d"]
        if d is not None and d.variable:
            return JointType.PRISMATIC
        fixed = any(self.cells.get(k) for k in _ORIGIN) and not any(
            map(self.cells.get, _PARAMETERS)
        )
        return JointType.FIXED if fixed and "type" not in self.bad else JointType.REVOLUTE

    def parameter(self, key: str) -> Value | None:
        value = self.kept(key, self.context.value, ROW_KINDS[key], self.lookup(key))
        if value is not None and value.variable and abs(value.coefficient) != 1:
            text = f"{value.variable} enters with the factor {value.coefficient.normalize()}"
            self.fault(key, f"{text}; only +1 and -1 are a DH row")
        return value

    def lookup(self, key: str) -> Lookup:
        """Names of one cell: constants, then the joint's own variable in theta and d."""
        kind = ROW_KINDS[key]
        own = f"theta{self.joint}" if kind is Kind.ANGLE else f"d{self.joint}"

        def look(name: str) -> Value:
            if name in self.context.constants:
                return self.context.constants[name]
            label = self.cells.get("name")
            match = _VARIABLE.fullmatch(name)
            mine = isinstance(label, Scalar) and label.text == name
            constant = key not in ("theta", "d")
            if not mine and (not match or (constant and match["length"])):
                raise self.context.unknown(name, "" if constant else own)
            if constant:
                raise ExpressionError(f"{key} is constant; a joint variable stands in theta or d")
            if match and not mine:
                self.check_name(key, name, match, own)
            return Value(Decimal(0), kind, own, Decimal(1))

        return look

    def check_name(self, key: str, name: str, match: re.Match[str], own: str) -> None:
        """Refuse the variable of another joint, or an angle's name in d."""
        index, report = match["index"], self.context.report
        wrong_kind = match["length"] if ROW_KINDS[key] is Kind.ANGLE else match["angle"]
        if wrong_kind or (index not in (None, "i") and int(index) != self.joint):
            message, cell = f"{name!r} is not the variable of this row (joint {self.joint})", ""
            hint = f"the row's own variable is {own}; "
            if isinstance(text := self.cells.get(key), Scalar) and not wrong_kind:
                cell = hint_of(text.text, key, self.joint, self.context.names, report)
            constant = f"{name} is a constant with {report.example('constants', **{name: '0.4'})}"
            raise ExpressionError(message, hint + (cell or constant))

    def sign(self, parts: dict[str, Value | None]) -> int:
        """Sign given, or the one of the variable in its cell."""
        key = "d" if self.type is JointType.PRISMATIC else "theta"
        part = parts[key]
        shown = int(part.coefficient) if part is not None and part.variable else 0
        cell = self.cells.get("sign")
        if cell is None:
            return shown if shown in (1, -1) else 1
        number = self.number("sign", Kind.NUMBER)
        if number is None:
            return 1
        if number not in (1, -1):
            self.fault("sign", "allowed: 1 and -1")
            return 1
        if shown and shown != number:
            self.fault("sign", f"but {key} shows the variable with the sign {shown:+d}")
        if self.type is JointType.FIXED:
            self.fault("sign", "a fixed row has no variable")
        return int(number)

    def check_variables(self, parts: dict[str, Value | None]) -> None:
        """One variable a row, in the cell that belongs to the type."""
        shown = [k for k in ("theta", "d") if (v := parts[k]) is not None and v.variable]
        if len(shown) == 2:
            cell = self.cells.get("d")
            name = plain_text(cell.text) if isinstance(cell, Scalar) else ""
            name = name if name.isidentifier() else f"d{self.joint}"
            example = self.context.report.example("constants", **{name: "0.4"})
            hint = f"give the one that is constant a value, as in {example}"
            self.fault("d", "theta and d both hold a joint variable; a joint has one", hint)
            return
        moving = {JointType.REVOLUTE: "theta", JointType.PRISMATIC: "d"}.get(self.type)
        for key in shown:
            if key != moving:
                kind = JointType.REVOLUTE if key == "theta" else JointType.PRISMATIC
                message = f"a joint variable here makes the row {kind}, but type says {self.type}"
                self.fault(key, message)

    def check_missing(self) -> None:
        """All four parameters, save the one that the joint moves; a fixed row has some step."""
        if self.type is JointType.FIXED:
            if not any(map(self.cells.get, (*_PARAMETERS, *_ORIGIN))):
                self.fault("type", "a fixed row needs xyz and rpy, or theta, d, a, alpha")
            return
        moving = "d" if self.type is JointType.PRISMATIC else "theta"
        for key in _PARAMETERS:
            if key != moving and self.cells.is_missing(key):
                example = self.context.report.cell(key, "0")
                self.fault(key, "missing", f"write {example} if there is none")

    def kept(self, key: str, read: Callable[..., Read | None], *how: object) -> Read | None:
        """What a cell is read as, None where there is none; one without a value is bad."""
        cell = self.cells.get(key)
        if cell is None:
            return None
        value = read(cell, self.cells.at(key), *how)
        if value is None:
            self.bad.add(key)
        return value

    def number(self, key: str, kind: Kind) -> float | None:
        return self.kept(key, self.context.number, kind)

    def vector(self, key: str, names: str) -> tuple[float, ...] | None:
        kind, size = ROW_KINDS.get(key, Kind.NUMBER), names.count(",") + 1
        return self.kept(key, self.context.numbers, kind, size, names)

    def inertia(
        self, mass: float | None, com: tuple[float, ...] | None
    ) -> tuple[float, ...] | None:
        """Tensor about the centre of mass."""
        values = self.vector("inertia", "ixx, ixy, ixz, iyy, iyz, izz")
        frame = self.cells.get("inertia_frame")
        if frame is None:
            return values
        word = frame.text.strip() if isinstance(frame, Scalar) else ""
        if word not in ("com", "link"):
            self.fault("inertia_frame", "allowed: com, link", did_you_mean(word, ("com", "link")))
        elif self.cells.get("inertia") is None:
            self.fault("inertia_frame", "but there is no inertia")
        elif word == "link" and values:
            if self.cells.get("com") is None:
                self.fault("inertia_frame", "needs com, to move the tensor there")
            elif mass and com:
                return to_centre_of_mass(values, mass, com)
        return values

    def origin(self) -> Origin | None:
        given = [k for k in _ORIGIN if self.cells.get(k) is not None]
        if not given:
            return None
        if self.type is not JointType.FIXED:
            self.fault(given[0], f"only a fixed row has {given[0]}; this one is {self.type}")
            return None
        if both := [k for k in _PARAMETERS if self.cells.get(k) is not None]:
            self.fault(
                given[0], f"a fixed row has either xyz and rpy or DH parameters, not {both[0]}"
            )
            return None
        xyz, rpy = self.vector("xyz", "x, y, z"), self.vector("rpy", "roll, pitch, yaw")
        return self.cells.origin(xyz, rpy)

    def mimic(self, kind: Kind) -> Mimic | None:
        """What the row follows; whether its joint is there, and slides as well, is asked later."""
        node = self.cells.get("mimic")
        if node is None:
            return None
        read = read_mimic(node, self.cells.at("mimic"), kind, self.context)
        if read is None:
            self.bad.add("mimic")
        return read

    def check_limits(self, fields: dict[str, Any]) -> None:
        for low, high in (("lower", "upper"), ("serial_lower", "serial_upper")):
            lower, upper = fields[low], fields[high]
            if lower is not None and upper is not None and lower > upper:
                self.fault(low, f"it lies above {high} ({found(self.cells.cells[high])})")
                fields[low] = None

    def build(self, fields: dict[str, Any]) -> DHRow:
        """Build the row; what `DHRow` refuses is noted at the cell it names."""
        if "mass" in self.bad:
            fields["mass"] = 1.0
        try:
            return DHRow(joint_type=self.type, **fields)
        except TableError as error:
            others = [p for p in error.problems if p.partition(":")[0] not in self.bad]
            self.cells.refuse(TableError(others))
            named = not any(problem.startswith("name:") for problem in others)
        return DHRow(joint_type=self.type, name=fields["name"] if named else "")


def to_centre_of_mass(
    inertia: tuple[float, ...], mass: float, com: tuple[float, ...]
) -> tuple[float, ...]:
    """Tensor about the centre of mass from the one about the frame's origin, axes unchanged.

    Parallel axis theorem: ``I_com = I_origin - m (c.c 1 - c c^T)``, in [kg m^2], [kg] and [m].
    """
    x, y, z = com
    shift = (y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y)
    return tuple(i - mass * s for i, s in zip(inertia, shift, strict=True))
