"""Elements of a URDF read one by one; what has an obvious reading is mended where it stands."""

import math
import re
from collections.abc import Collection, Sequence
from typing import NoReturn

import numpy as np
from lxml import etree

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, LENGTH, NUMBER, TEXT_CHARACTERS
from dh2urdf.conversions.read.kinematic_tree import MOVING, Actuation, TreeJoint, TreeLink
from dh2urdf.conversions.write import DEFAULT_EFFORT, DEFAULT_VELOCITY, TENSOR, Inertial, tensor
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array

KINDS = (*MOVING, "fixed", "floating", "planar", "spherical")

UNIT = 1e-6
"""How far from 1 the length of an axis may be without a remark: six written digits."""

PARTS, BOUNDS = ("limit", "dynamics"), ("lower", "upper")

FLOAT = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
"""A number as every consumer reads it: no hexadecimals, no underscores, no units."""

ENDLESS = re.compile(r"[+-]?(inf|infinity)", re.IGNORECASE)

WIDE = {"revolute": 2 * math.pi, "prismatic": 10.0}
"""Limits [rad, m] that are written where a file has none, as our own files have them."""

FAR = {"revolute": ANGLE, "prismatic": LENGTH}


SNAP = 1e-12
"""Distance from x, y or z up to which Pinocchio takes an axis to be that one."""


def as_pinocchio_takes(axis: Array) -> Array:
    """The axis, or the coordinate axis that it misses by no more than 1e-12.

    Pinocchio has joints of their own for x, y and z (not for their opposites), and takes those up
    to this distance (Eigen's ``isApprox``): a picometre on an arm of a metre. The same axis is
    read here, so that a chain and Pinocchio's placement of it are one thing.
    """
    length = _square(axis)
    for unit in np.eye(3):
        if _square(axis - unit) <= SNAP * SNAP * min(length, 1.0):
            return unit
    return axis


def _square(v: Array) -> float:
    """Squared length, summed in Eigen's order."""
    x, y, z = v.tolist()
    return float(x * x + (y * y + z * z))


class UrdfReader:
    """Reads elements of one file.

    ``mends`` tells what was set right in the document itself, with its element and line;
    ``remarks`` what is odd and stays.
    """

    def __init__(self, where: str) -> None:
        self.where = where
        self.mends: list[str] = []
        self.remarks: list[str] = []

    def place(self, element: etree._Element) -> str:
        """``file:line: <tag name="...">``, with the element around it where it has no name."""
        name = element.get("name")
        text = f'<{element.tag} name="{shown(name)}">' if name else f"<{element.tag}>"
        parent = element.getparent()
        if name is None and parent is not None and parent.getparent() is not None:
            owner = parent if parent.get("name") else parent.getparent()
            text += f' of <{owner.tag} name="{shown(owner.get("name", ""))}">'
        return f"{self.where}:{element.sourceline}: {text}"

    def fail(self, element: etree._Element, message: str) -> NoReturn:
        """Refuse an element."""
        raise UrdfError(f"{self.place(element)}: {message}")

    def mend(self, element: etree._Element, message: str) -> None:
        """Note what was set right."""
        self.mends.append(f"{self.place(element)}: {message}")

    def numbers(
        self, element: etree._Element, key: str, default: Sequence[float], most: float = NUMBER
    ) -> list[float]:
        """As many finite numbers of an attribute as there are defaults."""
        text = element.get(key)
        if text is None:
            return list(default)
        words, count = text.split(), len(default)
        said = f'{key}="{shown(text)}"'
        if len(words) != count or not all(map(FLOAT.fullmatch, words)):
            endless = any(ENDLESS.fullmatch(w) or w.lower() == "nan" for w in words)
            what = "a number" if count == 1 else f"{count} numbers"
            hint = "; this is xacro, not URDF" if "$" in text else ""
            self.fail(element, f"{said} is not {'finite' if endless else what}{hint}")
        values = [float(word) for word in words]
        if not all(abs(value) <= most for value in values):
            self.fail(element, f"{said} lies beyond {most:.0e}")
        return values

    def amount(self, element: etree._Element | None, key: str, default: float) -> float | None:
        """A number that cannot be negative; None where it is left out, missing or no number.

        ``default`` takes its place in the document; NaN for none.
        """
        if element is None or (element.get(key) is None and math.isnan(default)):
            return None
        try:
            value = self.numbers(element, key, (math.nan,))[0]
            if value >= 0:
                return value
            fault = f"has no {key}" if math.isnan(value) else f'{key}="{value!r}" is negative'
            fault = f"{self.place(element)}: {fault}"
        except UrdfError as error:
            fault = str(error)
        mended = "left out" if math.isnan(default) else f"taken as {default!r}"
        self.mends.append(f"{fault}; {mended}")
        if not math.isnan(default):
            element.set(key, repr(default))
            return None
        del element.attrib[key]
        if not element.attrib:  # urdfdom takes no <dynamics/>
            element.getparent().remove(element)
        return None

    def name(self, element: etree._Element) -> str:
        """Name of a link or joint, which may be empty."""
        name = str(element.get("name", ""))
        if len(name) > TEXT_CHARACTERS:
            self.fail(element, f"a name of {len(name)} characters; at most {TEXT_CHARACTERS}")
        return name

    def origin(self, element: etree._Element) -> Array:
        """``<origin xyz rpy>`` of an element as a pose."""
        origin, zeros = element.find("origin"), (0.0, 0.0, 0.0)
        if origin is None:
            return np.eye(4)
        xyz = self.numbers(origin, "xyz", zeros)
        if max(map(abs, xyz)) > LENGTH:
            self.fail(origin, f'xyz="{origin.get("xyz")}" is farther than {LENGTH:.0e} m')
        return tf.origin_matrix(xyz, self.numbers(origin, "rpy", zeros, ANGLE))

    def link(self, element: etree._Element) -> TreeLink:
        """A link, without an inertial that cannot be."""
        inertial = element.find("inertial")
        body = None
        if inertial is not None:
            try:
                body = self.inertial(inertial)
            except UrdfError as error:
                self.mends.append(f"{error}; <inertial> left out")
                element.remove(inertial)
        return TreeLink(self.name(element), self.place(element), body)

    def inertial(self, element: etree._Element) -> Inertial | None:
        """A body in its link's frame; None for one without mass."""
        pose = self.origin(element)
        weight, turning = element.find("mass"), element.find("inertia")
        mass = 0.0 if weight is None else self.numbers(weight, "value", (0.0,))[0]
        six = [0.0] * 6
        if turning is not None:
            six = [self.numbers(turning, key, (0.0,))[0] for key in TENSOR]
        if mass < 0:
            self.fail(element, f"a mass of {mass!r}")
        if mass == 0:
            return None
        return Inertial(mass, np.zeros(3), tensor(six)).moved(pose)

    def joint(
        self, element: etree._Element, links: Collection[str], taken: Collection[str]
    ) -> TreeJoint:
        """A joint between two links of the file.

        Raises
        ------
        UrdfError
            It does not join two links. All else that cannot be meant is its ``fault``.
        """
        parent, child = (self.end(element, tag, links) for tag in ("parent", "child"))
        if parent == child:
            self.fail(element, f"joins link {shown(child)!r} to itself")
        where, name = self.place(element), self.name(element)
        faults: list[tuple[str, str]] = []
        if not name or name in taken:
            what = "a second joint of this name" if name else "has no name"
            name = f"{name or 'joint'}_{len(taken) + 1}"
            faults.append((f"{where}: {what}", f"called {name!r}"))
            element.set("name", name)
        kind, origin, axis = element.get("type", ""), np.eye(4), np.array([1.0, 0.0, 0.0])
        try:
            if kind not in KINDS:
                self.fail(element, f'type="{shown(kind)}" is not one of {", ".join(KINDS)}')
            origin = self.origin(element)
            axis = self.axis(element) if kind in MOVING else axis
        except UrdfError as error:
            faults.append((str(error), "held still"))
            kind = "fixed"
            _make_fixed(element)
        limit, dynamics = (element.find(tag) if kind in MOVING else None for tag in PARTS)
        ends = self.limits(element, kind, faults)
        self.mends += [f"{fault}; {mend}" for fault, mend in faults]
        drive = self.drive(limit, dynamics)
        fault = faults[0][0] if faults else ""
        return TreeJoint(name, kind, parent, child, origin, axis, where, *ends, drive, None, fault)

    def drive(self, limit: etree._Element | None, dynamics: etree._Element | None) -> Actuation:
        """What a moving joint's ``<limit>`` and ``<dynamics>`` say of its drive."""
        return Actuation(
            self.amount(limit, "velocity", DEFAULT_VELOCITY) or None,
            self.amount(limit, "effort", DEFAULT_EFFORT) or None,
            self.amount(dynamics, "damping", math.nan),
            self.amount(dynamics, "friction", math.nan),
        )

    def end(self, element: etree._Element, tag: str, links: Collection[str]) -> str:
        """Name of a joint's parent or child link."""
        end = element.find(tag)
        if end is None or not end.get("link"):
            self.fail(element, f'has no <{tag} link="...">')
        name = str(end.get("link"))
        if name not in links:
            self.fail(end, f"no link is named {shown(name)!r}")
        return name

    def axis(self, element: etree._Element) -> Array:
        """Unit axis of a moving joint."""
        axis = element.find("axis")
        if axis is None:
            return np.array([1.0, 0.0, 0.0])
        if axis.get("xyz") is None:
            self.fail(axis, "has no xyz")
        vector = as_pinocchio_takes(np.array(self.numbers(axis, "xyz", (0.0, 0.0, 0.0))))
        length = math.hypot(*vector.tolist())
        if length < 1e-9 or length > LENGTH:
            what = "a zero axis" if length < 1e-9 else "no direction"
            self.fail(axis, f'xyz="{axis.get("xyz")}" is {what}')
        if abs(length - 1) > UNIT:
            self.remarks.append(f"{self.place(axis)}: length {length:.6g}, taken as a direction")
        return vector if length == 1.0 else vector / length

    def limits(
        self, element: etree._Element, kind: str, faults: list[tuple[str, str]]
    ) -> tuple[float | None, float | None]:
        """Bounds of a revolute or prismatic joint, None where it has none."""
        if kind not in WIDE:
            return None, None
        limit, wide = element.find("limit"), [repr(-WIDE[kind]), repr(WIDE[kind])]
        if limit is None:
            self.mend(element, "no <limit>; read as unlimited")
            drive = {"effort": repr(DEFAULT_EFFORT), "velocity": repr(DEFAULT_VELOCITY)}
            etree.SubElement(element, "limit", lower=wide[0], upper=wide[1], **drive)
            return None, None
        values: list[float | None] = [None, None]
        texts = [limit.get(key) for key in BOUNDS]
        try:
            if texts == [None, None]:
                self.mend(limit, "no lower and no upper; read as unlimited")
            else:
                values = [self.bound(limit, key, FAR[kind]) for key in BOUNDS]
                wide = [limit.get(key, "0") for key in BOUNDS]
        except UrdfError as error:
            faults.append((str(error), "read as unlimited"))
        lower, upper = values
        if lower is not None and upper is not None and lower > upper:
            fault = f"{self.place(limit)}: lower {lower!r} lies above upper {upper!r}"
            faults.append((fault, "exchanged"))
            lower, upper, wide = upper, lower, wide[::-1]
        limit.attrib.update(zip(BOUNDS, wide, strict=True))
        return lower, upper

    def bound(self, limit: etree._Element, key: str, far: float) -> float | None:
        """One bound; None where it is infinite or so far that it bounds nothing."""
        text = limit.get(key, "0").strip()
        value = (
            math.inf if ENDLESS.fullmatch(text) else self.numbers(limit, key, (0.0,), math.inf)[0]
        )
        if abs(value) <= far:
            return value
        limit.set(key, repr(-far if key == "lower" else far))
        self.mend(limit, f'{key}="{shown(text)}" lies beyond {far:.0e}; read as unlimited')
        return None


def _make_fixed(element: etree._Element) -> None:
    """Turn a joint whose place or motion cannot be read into one that does not move."""
    element.set("type", "fixed")
    for tag in ("origin", "axis", "limit", "dynamics", "mimic"):
        for part in element.findall(tag):
            element.remove(part)
