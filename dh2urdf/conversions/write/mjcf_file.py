"""A DH table as an MJCF, compiled by MuJoCo and compared before it is kept."""

import os
import re
from collections.abc import Iterator
from math import cos, sin

import numpy as np
from lxml import etree

from dh2urdf.conversions.write.inertia import TENSOR
from dh2urdf.conversions.write.urdf_elements import MARK, urdf_text_and_warnings
from dh2urdf.conversions.write.urdf_file import ConversionReport, chosen_options, write_verified
from dh2urdf.conversions.write.urdf_options import UrdfOptions
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import TableLike, as_table
from dh2urdf.exceptions import MissingExtraError, VerificationError
from dh2urdf.transforms import Array, pose

CLASSES = {
    "visual": {"contype": "0", "conaffinity": "0", "group": "2"},
    "collision": {"group": "3"},
}
"""What MuJoCo makes of the bodies that are drawn, and of those that collide."""

JOINTS = {"revolute": "hinge", "prismatic": "slide"}


def write_mjcf(
    table: TableLike,
    path: str | os.PathLike[str],
    *,
    options: UrdfOptions | None = None,
    force: bool = False,
) -> ConversionReport:
    """Write the MJCF of a table, proved by MuJoCo (extra ``mjcf``); as :func:`write_urdf` does.

    Links are bodies, DH frames and the tool bodies with a site. The table itself, with the
    velocities for which an MJCF has no place, is in ``<custom>``.

    Examples
    --------
    >>> import os, tempfile
    >>> from dh2urdf import write_mjcf
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report = write_mjcf("planar_rr", os.path.join(folder, "rr.xml"))
    >>> report.max_error < 1e-9
    True
    """
    return write_verified(verified_mjcf, table, path, options, force)


def verified_mjcf(
    table: TableLike, options: UrdfOptions | None = None
) -> tuple[str, float, tuple[str, ...]]:
    """Text of the MJCF, largest FK difference [m and rad], warnings; errors as of the URDF."""
    table, chosen = as_table(table), chosen_options(options)
    urdf, warnings = urdf_text_and_warnings(table, chosen)
    text = _Mjcf(etree.fromstring(urdf.encode()), table).text()
    return text, _verify(text, table, chosen.digits), warnings


class _Mjcf:
    """The same links, joints and bodies as in the URDF of this package, in MuJoCo's terms."""

    def __init__(self, urdf: etree._Element, table: DHTable) -> None:
        self.urdf, self.table = urdf, table
        self.links = {link.get("name"): link for link in urdf.iterchildren("link")}
        self.root = etree.Element("mujoco", model=table.name)

    def text(self) -> str:
        root = self.root
        root.append(etree.Comment(MARK))
        etree.SubElement(root, "compiler", angle="radian", autolimits="true")
        classes = etree.SubElement(root, "default")
        for name, attributes in CLASSES.items():
            one = etree.SubElement(classes, "default", {"class": name})
            etree.SubElement(one, "geom", attributes)
        embedded = self.urdf.findtext("dh2urdf")
        if embedded:
            custom = etree.SubElement(root, "custom")
            etree.SubElement(custom, "text", name="dh2urdf", data=re.sub(r"\n\s*", " ", embedded))
        assets = etree.SubElement(root, "asset")
        for material in self.urdf.iterchildren("material"):
            rgba = material.find("color").get("rgba")
            etree.SubElement(assets, "material", name=material.get("name"), rgba=rgba)
        world = etree.SubElement(root, "worldbody")
        self._link(etree.SubElement(world, "body", name="base_link"), "base_link")
        self._followers()
        etree.indent(root, space="  ")
        return f"{etree.tostring(root, encoding='unicode')}\n"

    def _link(self, body: etree._Element, name: str) -> None:
        """Fill a body with what its link weighs and shows, and with all that hangs on it."""
        moved = {row: k for k, row in enumerate(self.table.joint_names)}
        self._solids(body, self.links[name])
        for joint in self._joints_on(name):
            child, place = joint.find("child").get("link"), _place(joint)
            if joint.get("type") != "fixed":
                inner = etree.SubElement(body, "body", {"name": child, **place})
                self._joint(inner, joint, moved[joint.get("name")])
                self._link(inner, child)
            elif self.links[child].find("visual") is not None:
                self._solids(body, self.links[child])  # of the base, which stands in the same frame
            else:  # MuJoCo rounds a site that nearly stands in its body's frame, but not a body
                frame = etree.SubElement(body, "body", {"name": child, **place})
                etree.SubElement(frame, "site", name=child, group="4")

    def _followers(self) -> None:
        """Equalities, which simulation keeps, of joints that follow others."""
        follows = [(j, j.find("mimic")) for j in self.urdf.iterchildren("joint")]
        follows = [(joint, mimic) for joint, mimic in follows if mimic is not None]
        equality = etree.SubElement(self.root, "equality") if follows else None
        for joint, mimic in follows:
            pair = {"joint1": joint.get("name"), "joint2": mimic.get("joint")}
            line = f"{mimic.get('offset')} {mimic.get('multiplier')} 0 0 0"
            etree.SubElement(equality, "joint", {**pair, "polycoef": line})

    def _joints_on(self, link: str) -> Iterator[etree._Element]:
        for joint in self.urdf.iterchildren("joint"):
            if joint.find("parent").get("link") == link:
                yield joint

    def _joint(self, body: etree._Element, joint: etree._Element, k: int) -> None:
        limit, losses = joint.find("limit"), joint.find("dynamics")
        made = {"name": joint.get("name"), "type": JOINTS[joint.get("type")]}
        made |= {"axis": joint.find("axis").get("xyz")}
        made |= {"range": f"{limit.get('lower')} {limit.get('upper')}"}
        if self.table.joints[k].effort is not None:
            made |= {"actuatorfrcrange": f"-{limit.get('effort')} {limit.get('effort')}"}
        if losses is not None:
            made |= {"damping": losses.get("damping"), "frictionloss": losses.get("friction")}
        etree.SubElement(body, "joint", made)

    def _solids(self, body: etree._Element, link: etree._Element) -> None:
        inertial = link.find("inertial")
        mass = inertial.find("mass").get("value") if inertial is not None else "0"
        if float(mass) > 0:
            xx, xy, xz, yy, yz, zz = (inertial.find("inertia").get(key) for key in TENSOR)
            at, tensor = inertial.find("origin").get("xyz"), " ".join((xx, yy, zz, xy, xz, yz))
            etree.SubElement(body, "inertial", pos=at, mass=mass, fullinertia=tensor)
        for part in link.iterchildren(*CLASSES):
            shape = part.find("geometry")[0]
            geom = {"class": part.tag, "type": shape.tag, "size": _size(shape), **_place(part)}
            if part.tag == "visual":
                geom["material"] = part.find("material").get("name")
            etree.SubElement(body, "geom", geom)


def _place(element: etree._Element) -> dict[str, str]:
    """An origin as every reader of MJCF takes it: place and quaternion (w first)."""
    origin = element.find("origin")
    roll, pitch, yaw = (0.5 * float(v) for v in origin.get("rpy").split())
    if not (roll or pitch or yaw):
        return {"pos": origin.get("xyz")}
    (cr, cp, cy), (sr, sp, sy) = (tuple(map(f, (roll, pitch, yaw))) for f in (cos, sin))
    x, y = sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy
    w, z = cr * cp * cy + sr * sp * sy, cr * cp * sy - sr * sp * cy
    return {"pos": origin.get("xyz"), "quat": " ".join(map(repr, (w, x, y, z)))}


def _size(shape: etree._Element) -> str:
    """Half lengths of a box or cylinder, the radius of a sphere."""
    if shape.tag == "box":
        return " ".join(repr(0.5 * float(v)) for v in shape.get("size").split())
    if shape.tag == "sphere":
        return str(shape.get("radius"))
    return f"{shape.get('radius')} {0.5 * float(shape.get('length'))!r}"


def _verify(text: str, table: DHTable, digits: int | None) -> float:
    """Largest difference [m and rad] between MuJoCo's sites and the DH product."""
    from dh2urdf.conversions.write.verify import compare_with_table

    try:
        import mujoco
    except ImportError:
        raise MissingExtraError("mjcf", "writing an MJCF") from None
    try:
        model = mujoco.MjModel.from_xml_string(text)
    except ValueError as error:
        raise VerificationError(f"MuJoCo does not take the written file: {error}") from None
    data = mujoco.MjData(model)
    names = tuple(model.joint(k).name for k in range(model.njnt))
    if names != table.joint_names:
        raise VerificationError(f"{table.name}: MuJoCo reads the joints {', '.join(names)}")
    sites = {model.site(k).name: k for k in range(model.nsite)}
    present = [i for i in range(table.n + 1) if f"dh_{i}" in sites]
    ids = [sites[name] for name in (*(f"dh_{i}" for i in present), "tool0")]

    def place(q: Array) -> Array:
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        return np.stack([pose(data.site_xmat[k].reshape(3, 3), data.site_xpos[k]) for k in ids])

    return compare_with_table(table, model.jnt_range, present, place, digits)
