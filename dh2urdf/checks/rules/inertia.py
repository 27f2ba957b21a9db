"""Rules of mass: what moves needs some, and a tensor that a body could have."""

from collections.abc import Iterator

import numpy as np
from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Finding, complain, finding, misread, refuse
from dh2urdf.conversions.read import MOVING
from dh2urdf.conversions.write import TENSOR, tensor, why_impossible
from dh2urdf.transforms import Array

ESTIMATE = "dh2urdf convert estimates masses from the drawn bodies of a DH table"


def _inertial(doc: Document, link: str) -> etree._Element | None:
    return doc.link_by_name[link].find("inertial")


def _mass(doc: Document, link: str) -> float | None:
    """Mass of a link [kg]; None where there is no <inertial>, or none that can be read."""
    inertial = _inertial(doc, link)
    return None if inertial is None else doc.number(inertial.find("mass"), "value")


def _tensor(doc: Document, inertial: etree._Element | None) -> Array | None:
    """Tensor (3, 3) [kg m^2] of an <inertial>; None where it cannot be read."""
    element = None if inertial is None else inertial.find("inertia")
    six = [value for key in TENSOR if (value := doc.number(element, key)) is not None]
    return tensor(six) if len(six) == len(TENSOR) else None


def _laden(doc: Document) -> set[str]:
    """Links beyond which something has a mass."""
    above: dict[str, list[str]] = {name: [] for name in doc.link_by_name}
    for parent, child, _ in doc.edges:
        above[child].append(parent)
    todo = [name for name in above if _mass(doc, name)]
    laden: set[str] = set()
    for name in todo:
        todo += set(above[name]) - laden
        laden.update(above[name])
    return laden


def massless(doc: Document) -> Iterator[Finding]:
    """What a joint moves has a mass."""
    laden = _laden(doc)
    for name in doc.moving:
        part = doc.rigid_part(name)
        masses = [_mass(doc, m) for m in part if _inertial(doc, m) is not None]
        if any(masses) or None in masses:  # incomplete ones, or no numbers, other rules tell
            continue
        empty = _inertial(doc, name) is None
        shells = any(doc.link_by_name[m].find("collision") is not None for m in part)
        yield finding(
            doc.link_by_name[name],
            f"moves, and has no {'<inertial>' if empty else 'mass'}",
            None if shells else refuse("MuJoCo"),
            None if name in laden else complain("Pinocchio", "forward dynamics give NaN"),
            misread("Gazebo", "drops the link and all that hangs on it"),
            complain("PyBullet", "takes it for 1 kg") if empty else None,
            mend=f"give it a mass and a tensor; {ESTIMATE}",
        )


def massless_part(doc: Document) -> Iterator[Finding]:
    """A moving link has its mass itself, not in a part fixed to it."""
    effects = complain("PyBullet", "adds 1 kg"), misread("Gazebo", "may drop the link")
    for name in doc.moving:
        others = [m for m in doc.rigid_part(name)[1:] if _mass(doc, m)]
        if _inertial(doc, name) is None and others:
            message = f"has no <inertial>; its mass is in {', '.join(map(repr, others))}"
            mend = "move the mass to this link"
            yield finding(doc.link_by_name[name], message, *effects, mend=mend)


def massless_frame(doc: Document) -> Iterator[Finding]:
    """A frame on a fixed joint says that it weighs nothing."""
    frames = (n for n in doc.link_by_name if n in doc.moved and _inertial(doc, n) is None)
    silent = [name for name in frames if doc.kind(doc.joint_above[name]) == "fixed"]
    if silent:
        others = f"; nor has {', '.join(map(repr, silent[1:]))}" if len(silent) > 1 else ""
        taken = complain("PyBullet", "takes each for 1 kg")
        mend = "give it an <inertial> with mass 0 and a zero tensor"
        yield finding(doc.link_by_name[silent[0]], f"has no <inertial>{others}", taken, mend=mend)


def mass_negative(doc: Document) -> Iterator[Finding]:
    """No mass is negative."""
    effects = complain("Drake"), misread("Pinocchio", "computes with it")
    for name, link in doc.link_by_name.items():
        mass = _mass(doc, name)
        if mass is not None and mass < 0:
            refused = refuse("MuJoCo") if name in doc.moving else None  # it looks at what moves
            message = f"has a mass of {mass:g} kg"
            yield finding(link, message, refused, *effects, mend="mend the sign")


def inertial_incomplete(doc: Document) -> Iterator[Finding]:
    """An <inertial> has a mass and all six numbers of its tensor."""
    for inertial in (part for link in doc.links if (part := link.find("inertial")) is not None):
        mass, element = inertial.find("mass"), inertial.find("inertia")
        missing = [] if mass is not None and mass.get("value") is not None else ["mass"]
        none = element is None
        missing += ["tensor"] if none else [key for key in TENSOR if element.get(key) is None]
        if missing:
            yield finding(
                inertial,
                f"has no {', '.join(missing)}",
                refuse("PyBullet"),
                None if missing[0] in ("ixy", "ixz", "iyz") else refuse("MuJoCo"),
                complain("urdfdom", "leave the whole <inertial> out"),
                complain("Drake") if missing[0] == "mass" else None,
                mend="write what is missing, zeros where they are meant",
            )


def inertia_zero(doc: Document) -> Iterator[Finding]:
    """What a joint moves and has a mass has a tensor too."""
    laden = _laden(doc)
    for name in doc.moving:
        inertial = _inertial(doc, name)
        inertia = _tensor(doc, inertial)
        alone = _mass(doc, name) and not any(_mass(doc, m) for m in doc.rigid_part(name)[1:])
        if inertial is not None and alone and inertia is not None and not inertia.any():
            idle = name not in laden and _on_axis(doc, name, inertial)
            nan = complain("Pinocchio", "may compute NaN") if idle else None
            mend = f"write the tensor of a body of that size; {ESTIMATE}"
            message = "is a point: a mass without a tensor"
            yield finding(inertial, message, refuse("MuJoCo"), nan, mend=mend)


def _on_axis(doc: Document, name: str, inertial: etree._Element) -> bool:
    """True where the centre of mass lies on the axis: turning it takes no torque."""
    joint = doc.joint_above[name]
    if doc.kind(joint) not in MOVING or doc.kind(joint) == "prismatic":
        return False
    com = np.array(doc.numbers(inertial.find("origin"), "xyz") or (0.0, 0.0, 0.0))
    axis = np.array(doc.numbers(joint.find("axis"), "xyz") or (1.0, 0.0, 0.0))
    return bool(np.allclose(np.cross(com, axis), 0.0))


def _impossible(doc: Document, *, positive: bool, mend: str) -> Iterator[Finding]:
    """Tensors, but zeros, that no body has, those with positive principal moments or the rest."""
    effects = refuse("MuJoCo"), complain("Drake"), complain("PyBullet", "takes the tensor for zero")
    computed = misread("Pinocchio", "computes with it")
    for link in doc.links:
        inertial = link.find("inertial")
        inertia = _tensor(doc, inertial)
        if inertial is None or inertia is None or not inertia.any():
            continue
        why = why_impossible(inertia)
        if why and (np.linalg.eigvalsh(inertia)[0] > 0) == positive:
            message = f"no body has this tensor: {why}"
            yield finding(inertial, message, *effects, computed, mend=mend)


def inertia_not_positive(doc: Document) -> Iterator[Finding]:
    """The principal moments of a tensor are positive."""
    mend = "mend the signs of the products of inertia, or the units"
    yield from _impossible(doc, positive=False, mend=mend)


def inertia_triangle(doc: Document) -> Iterator[Finding]:
    """No principal moment of a tensor exceeds the sum of the other two."""
    mend = "raise the smaller moments; MuJoCo does it itself with "
    mend += '<mujoco><compiler balanceinertia="true"/></mujoco>'
    yield from _impossible(doc, positive=True, mend=mend)


def root_inertia(doc: Document) -> Iterator[Finding]:
    """The root link has no mass."""
    for name in doc.roots[:1]:
        if doc.moving and _mass(doc, name):
            taken = complain("KDL", "takes no root with inertia: leaves it out with a warning")
            message = "is the root and has an <inertial>"
            mend = "hang the mass on a child of the root by a fixed joint"
            yield finding(doc.link_by_name[name], message, taken, mend=mend)
