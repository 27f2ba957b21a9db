"""From a DH table to the text of a URDF; every rule here has a consumer that breaks without it."""

import math
import re

import numpy as np
from lxml import etree

from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.chain import SerialChain, resolved
from dh2urdf.conversions.write.bodies import Body, draw_bodies
from dh2urdf.conversions.write.inertia import Inertial, inertial_element, whole_numbers
from dh2urdf.conversions.write.link_masses import link_masses
from dh2urdf.conversions.write.table_chain import LinkFrames, dh_to_chain, link_frames
from dh2urdf.conversions.write.urdf_options import UrdfOptions
from dh2urdf.dh import DHRow, DHTable, JointType
from dh2urdf.dh.quoting import XML_FORBIDDEN
from dh2urdf.exceptions import TableError
from dh2urdf.transforms import Array, matrix_to_rpy

MATERIALS = {
    "base": "0.24 0.30 0.40 1.0",
    "joint": "0.33 0.40 0.52 1.0",
    "link": "0.84 0.86 0.89 1.0",
    "rail": "0.62 0.66 0.72 1.0",
}

DEFAULT_EFFORT = 1000.0
"""Effort limit written where the table has none [N m or N]; URDF requires the attribute."""

DEFAULT_VELOCITY = 10.0
"""Velocity limit written where the table has none [rad/s or m/s]; URDF requires it."""

MARK = " written from a DH table "
"""Comment in a file without its table, by which its writer knows it again."""


def urdf_text_and_warnings(table: DHTable, options: UrdfOptions) -> tuple[str, tuple[str, ...]]:
    """The URDF of a table, and what had to be assumed to write it."""
    check_names(table)
    return _Writer(table, options).write()


def default_limits(table: DHTable, i: int) -> tuple[float, float]:
    """Lower and upper bound of joint i, from 0, [rad] or [m]; made up where the table has none.

    Revolute: +-2 pi. Prismatic: as far as the table's own lengths sum to, at least 1 m. Where
    the given bound lies beyond that, as far again beyond it. A joint that follows goes as far as
    the one that leads, a coupled one as far as the bounds of q put it.
    """
    row, (lower, upper) = table.joints[i], table.joint_ranges[i]
    slides = row.joint_type is JointType.PRISMATIC
    far, bound = far_of(table, slides), LENGTH if slides else ANGLE
    if row.mimic is not None:
        ends = default_limits(table, table.joint_names.index(row.mimic.joint))
        low, high = sorted(row.mimic.multiplier * end + row.mimic.offset for end in ends)
        lower, upper = (
            own if math.isfinite(own) else other for own, other in ((lower, low), (upper, high))
        )
    if lower == -math.inf:
        lower = -far if upper > -far else upper - far
    if upper == math.inf:
        upper = far if lower < far else lower + far
    return max(lower, -bound), min(upper, bound)


def far_of(table: DHTable, slides: bool) -> float:
    """How far a joint without limits goes either way [rad] or [m]."""
    return (table.length or 1.0) if slides else 2.0 * math.pi


def coupling_remarks(table: DHTable) -> list[str]:
    """What a URDF says of coupled joints, a sentence each."""
    return [
        f"{name} is at its value plus {terms}, which no <mimic> can say: the file moves the joint "
        "itself, and its limits are the range that results"
        for name in table.couplings
        if (
            terms := " plus ".join(
                other if v == 1.0 else f"{v:g} {other}"
                for other, v in table.couplings[name].items()
            )
        )
    ]


def check_names(table: DHTable) -> None:
    """Refuse names that a URDF of the table cannot have."""
    reserved = {"tool0_fixed", "base_link_inertia_fixed", "universe"}
    reserved |= {f"dh_{i}_fixed" for i in range(table.n + 1)}
    forbidden, taken = "holds a character that XML forbids", "is taken by another joint of the file"
    names = table.joint_names
    problems = [(n, forbidden) for n in (table.name, *names) if XML_FORBIDDEN.search(n)]
    problems += [(n, f"{taken}, or by Pinocchio") for n in names if n in reserved]
    if problems:
        raise TableError([f"name: {name!r} {problem}" for name, problem in problems])


class _Writer:
    """One table on its way to XML: the element tree and the warnings so far."""

    def __init__(self, table: DHTable, options: UrdfOptions) -> None:
        self.table, self.options = table, options
        self.chain: SerialChain = dh_to_chain(table)
        self.frames: LinkFrames = link_frames(table)
        pairs = zip(table.joint_names, table.joints, strict=True)
        self.mimics = {name: row.mimic for name, row in pairs if row.mimic is not None}
        self.bodies = draw_bodies(table, self.chain)
        self.masses, self.warnings = link_masses(table, self.frames.dh, self.bodies, options)
        self.robot = etree.Element("robot", name=table.name)

    def write(self) -> tuple[str, tuple[str, ...]]:
        self._preamble()
        etree.SubElement(self.robot, "link", name="base_link")
        parent = "base_link"
        for i, row in enumerate(self.table.joints, 1):
            link = f"link_{i}"
            self._link(link, self.masses[i], self.bodies[i])
            self._joint(row, parent, link, i)
            parent = link
        self._massless_link("tool0", parent, self.frames.tool)
        self._side_links()
        self._limit_warnings()
        etree.indent(self.robot, space="  ")
        text = etree.tostring(self.robot, encoding="unicode")
        return f'<?xml version="1.0"?>\n{text}\n', tuple(self.warnings)

    def _preamble(self) -> None:
        mujoco = etree.SubElement(self.robot, "mujoco")
        etree.SubElement(mujoco, "compiler", fusestatic="false", discardvisual="false")
        if self.options.embed_table:
            embedded = etree.SubElement(self.robot, "dh2urdf", schema="1")
            from dh2urdf.dh_io import table_to_text

            embedded.text = table_to_text(self.table, "json")
        else:
            self.robot.append(etree.Comment(MARK))
        if any(row.mass is None for row in self.table.joints):
            estimate = f"estimated from the drawn bodies at {self.options.density:g} kg/m^3"
            self.robot.append(etree.Comment(f" links without a mass in the table: {estimate} "))
        for remark in coupling_remarks(self.table):
            self.robot.append(etree.Comment(f" {re.sub('-(?=-)', '- ', remark)} "))
        for name, rgba in MATERIALS.items():
            if any(b.material == name for bodies in self.bodies for b in bodies):
                material = etree.SubElement(self.robot, "material", name=name)
                etree.SubElement(material, "color", rgba=rgba)

    def _side_links(self) -> None:
        """What hangs beside the chain; behind it, as ikpy follows the first joint of a link."""
        self._link("base_link_inertia", self.masses[0], self.bodies[0])
        inertia = "base_link_inertia"
        self._placed(f"{inertia}_fixed", "fixed", "base_link", inertia, np.eye(4))
        if self.options.dh_frames:
            for i, T_link_dh in enumerate(self.frames.dh):
                self._massless_link(f"dh_{i}", f"link_{i}" if i else "base_link", T_link_dh)

    def _massless_link(self, name: str, parent: str, T: Array) -> None:
        self._link(name, Inertial(0.0, np.zeros(3), np.zeros((3, 3))), [])
        self._placed(f"{name}_fixed", "fixed", parent, name, T)

    def _placed(self, name: str, kind: str, parent: str, child: str, T: Array) -> etree._Element:
        joint = etree.SubElement(self.robot, "joint", name=name, type=kind)
        self._origin(joint, T)
        etree.SubElement(joint, "parent", link=parent)
        etree.SubElement(joint, "child", link=child)
        return joint

    def _joint(self, row: DHRow, parent: str, child: str, i: int) -> None:
        name, T = self.table.joint_names[i - 1], self.frames.origins[i - 1]
        joint = self._placed(name, str(row.joint_type), parent, child, T)
        etree.SubElement(joint, "axis", xyz="0 0 1" if row.sign > 0 else "0 0 -1")
        lower, upper = default_limits(self.table, i - 1)
        effort = DEFAULT_EFFORT if row.effort is None else row.effort
        velocity = DEFAULT_VELOCITY if row.velocity is None else row.velocity
        limits = {"lower": lower, "upper": upper, "effort": effort, "velocity": velocity}
        losses = {"damping": row.damping or 0.0, "friction": row.friction or 0.0}
        etree.SubElement(joint, "limit", {k: self._number(v) for k, v in limits.items()})
        if row.damping is not None or row.friction is not None:
            etree.SubElement(joint, "dynamics", {k: self._number(v) for k, v in losses.items()})
        if row.mimic is not None:
            # Pinocchio and yourdfpy take no leader that follows another
            leader, multiplier, offset = resolved(name, self.mimics)
            numbers = {"multiplier": repr(multiplier), "offset": repr(offset)}
            etree.SubElement(joint, "mimic", {"joint": leader, **numbers})

    def _link(self, name: str, inertial: Inertial, bodies: list[Body]) -> None:
        link = etree.SubElement(self.robot, "link", name=name)
        inertial_element(link, inertial)
        for tag in ("visual", "collision") if self.options.collision else ("visual",):
            for body in bodies:
                self._body(link, tag, body)

    def _body(self, link: etree._Element, tag: str, body: Body) -> None:
        element = etree.SubElement(link, tag)
        self._origin(element, body.pose)
        keys = {"box": ["size"], "sphere": ["radius"], "cylinder": ["radius", "length"]}[body.shape]
        sizes = whole_numbers(body.size).split(maxsplit=len(keys) - 1)
        geometry = etree.SubElement(element, "geometry")
        etree.SubElement(geometry, body.shape, dict(zip(keys, sizes, strict=True)))
        if tag == "visual":
            etree.SubElement(element, "material", name=body.material)

    def _limit_warnings(self) -> None:
        """Say which limits were made up, the same ones together; and what the file cannot say."""
        made_up: dict[str, list[str]] = {}
        for i, (name, row) in enumerate(
            zip(self.table.joint_names, self.table.joints, strict=True)
        ):
            ends = zip(("lower", "upper"), self.table.joint_ranges[i], strict=True)
            missing = [key for key, end in ends if not math.isfinite(end)]
            if missing and row.mimic is None:
                half = f" ({missing[0]})" if len(missing) == 1 else ""
                made_up.setdefault(self._made_up(i), []).append(name + half)
        self.warnings += [
            f"{', '.join(names)}: no limits in the table; written as {written}"
            for written, names in made_up.items()
        ]
        self.warnings += coupling_remarks(self.table)

    def _made_up(self, i: int) -> str:
        """The limits of a joint that has none, in words."""
        slides = self.table.joints[i].joint_type is JointType.PRISMATIC
        far = far_of(self.table, slides)
        both = zip(default_limits(self.table, i), self.table.joint_ranges[i], strict=True)
        beyond = [v for v, given in both if not math.isfinite(given) and abs(v) > far]
        if beyond:
            return f"{beyond[0]:.6g} {'m' if slides else 'rad'}, beyond the one that is given"
        reach = f"+-{far:.6g} m, as far as the table's lengths sum to"
        return reach if slides else "+-2 pi rad"

    def _origin(self, parent: etree._Element, T: Array) -> None:
        xyz, rpy = (" ".join(map(self._number, v)) for v in (T[:3, 3], matrix_to_rpy(T)))
        etree.SubElement(parent, "origin", xyz=xyz, rpy=rpy)

    def _number(self, value: float) -> str:
        number = float(value)
        if self.options.digits is not None:
            number = round(number, self.options.digits)
        return repr(number + 0.0)
