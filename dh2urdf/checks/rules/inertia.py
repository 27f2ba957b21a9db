"""Rules of mass: what moves needs some, and a tensor that a body could have."""

from collections.abc import Iterator

import numpy as np
from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import (
    DRAKE,
    GAZEBO,
    KDL,
    MUJOCO,
    PINOCCHIO,
    PYBULLET,
    URDFDOM,
    Found,
    complain,
    misread,
    refuse,
)
from dh2urdf.conversions.read import MOVING
from dh2urdf.conversions.write import TENSOR, tensor, why_impossible
from dh2urdf.transforms import Array

ESTIMATE = "dh2urdf convert estimates masses from the drawn bodies of a DH table"


def _mass(doc: Document, link: str) -> float | None:
    """Mass of a link [kg]; None where there is no <inertial>, or none that can be read."""
    inertial = doc.link_by_name[link].find("inertial")
    return None if inertial is None else doc.number(inertial.find("mass"), "value")


def _tensor(doc: Document, inertial: etree._Element) -> Array | None:
    """Tensor (3, 3) [kg m^2] of an <inertial>; None where it cannot be read."""
    element = inertial.find("inertia")
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


def massless(doc: Document) -> Iterator[Found]:
    """What a joint moves has a mass."""
    laden = _laden(doc)
    for name in doc.moving:
        link, part = doc.link_by_name[name], doc.rigid_part(name)
        if any(_mass(doc, member) for member in part) or _unreadable(doc, part):
            continue
        empty = link.find("inertial") is None
        shells = any(doc.link_by_name[m].find("collision") is not None for m in part)
        nan = complain(PINOCCHIO, text="forward dynamics give NaN")
        yield Found(
            link,
            "moves, and has no <inertial>" if empty else "moves, and has no mass",
            None if shells else refuse(MUJOCO),
            None if name in laden else nan,
            misread(GAZEBO, text="drops the link and all that hangs on it"),
            complain(PYBULLET, text="takes it for 1 kg") if empty else None,
            mend=f"give it a mass and a tensor; {ESTIMATE}",
        )


def _unreadable(doc: Document, part: list[str]) -> bool:
    """True where an <inertial> is there but incomplete or no number, which other rules say."""
    there = (m for m in part if doc.link_by_name[m].find("inertial") is not None)
    return any(_mass(doc, member) is None for member in there)


def massless_part(doc: Document) -> Iterator[Found]:
    """A moving link has its mass itself, not in a part fixed to it."""
    for name in doc.moving:
        link = doc.link_by_name[name]
        others = [m for m in doc.rigid_part(name)[1:] if _mass(doc, m)]
        if link.find("inertial") is None and others:
            yield Found(
                link,
                f"has no <inertial>; its mass is in {', '.join(map(repr, others))}",
                complain(PYBULLET, text="adds 1 kg"),
                misread(GAZEBO, text="may drop the link"),
                mend="move the mass to this link",
            )


def massless_frame(doc: Document) -> Iterator[Found]:
    """A frame on a fixed joint says that it weighs nothing."""
    silent = [
        name
        for name in doc.link_by_name
        if name in doc.moved
        and doc.kind(doc.joint_above[name]) == "fixed"
        and doc.link_by_name[name].find("inertial") is None
    ]
    if silent:
        others = f"; nor has {', '.join(map(repr, silent[1:]))}" if len(silent) > 1 else ""
        yield Found(
            doc.link_by_name[silent[0]],
            f"has no <inertial>{others}",
            complain(PYBULLET, text="takes each for 1 kg"),
            mend="give it an <inertial> with mass 0 and a zero tensor",
        )


def mass_negative(doc: Document) -> Iterator[Found]:
    """No mass is negative."""
    for name, link in doc.link_by_name.items():
        mass = _mass(doc, name)
        if mass is not None and mass < 0:
            yield Found(
                link,
                f"has a mass of {mass:g} kg",
                refuse(MUJOCO) if name in doc.moving else None,  # it looks at what moves
                complain(DRAKE),
                misread(PINOCCHIO, text="computes with it"),
                mend="mend the sign",
            )


def inertial_incomplete(doc: Document) -> Iterator[Found]:
    """An <inertial> has a mass and all six numbers of its tensor."""
    for link in doc.links:
        inertial = link.find("inertial")
        if inertial is None:
            continue
        mass, element = inertial.find("mass"), inertial.find("inertia")
        missing = [] if mass is not None and mass.get("value") is not None else ["mass"]
        none = element is None
        missing += ["tensor"] if none else [key for key in TENSOR if element.get(key) is None]
        if missing:
            yield Found(
                inertial,
                f"has no {', '.join(missing)}",
                refuse(PYBULLET),
                None if missing[0] in ("ixy", "ixz", "iyz") else refuse(MUJOCO),
                complain(*URDFDOM, text="leave the whole <inertial> out"),
                complain(DRAKE) if missing[0] == "mass" else None,
                mend="write what is missing, zeros where they are meant",
            )


def inertia_zero(doc: Document) -> Iterator[Found]:
    """What a joint moves and has a mass has a tensor too."""
    laden = _laden(doc)
    for name in doc.moving:
        inertial = doc.link_by_name[name].find("inertial")
        if inertial is None or not _mass(doc, name):
            continue
        alone = not any(_mass(doc, member) for member in doc.rigid_part(name)[1:])
        inertia = _tensor(doc, inertial)
        if alone and inertia is not None and not inertia.any():
            idle = name not in laden and _on_axis(doc, name, inertial)
            yield Found(
                inertial,
                "is a point: a mass without a tensor",
                refuse(MUJOCO),
                complain(PINOCCHIO, text="may compute NaN") if idle else None,
                mend=f"write the tensor of a body of that size; {ESTIMATE}",
            )


def _on_axis(doc: Document, name: str, inertial: etree._Element) -> bool:
    """True where the centre of mass lies on the axis: turning it takes no torque."""
    joint = doc.joint_above[name]
    if doc.kind(joint) not in MOVING or doc.kind(joint) == "prismatic":
        return False
    com = np.array(doc.numbers(inertial.find("origin"), "xyz") or (0.0, 0.0, 0.0))
    axis = np.array(doc.numbers(joint.find("axis"), "xyz") or (1.0, 0.0, 0.0))
    return bool(np.allclose(np.cross(com, axis), 0.0))


def _impossible(doc: Document, *, positive: bool, mend: str) -> Iterator[Found]:
    """Tensors, but zeros, that no body has, those with positive principal moments or the rest."""
    for link in doc.links:
        inertial = link.find("inertial")
        inertia = None if inertial is None else _tensor(doc, inertial)
        if inertia is None or not inertia.any():
            continue
        why = why_impossible(inertia)
        if why and (np.linalg.eigvalsh(inertia)[0] > 0) == positive:
            yield Found(
                inertial,
                f"no body has this tensor: {why}",
                refuse(MUJOCO),
                complain(DRAKE),
                complain(PYBULLET, text="takes the tensor for zero"),
                misread(PINOCCHIO, text="computes with it"),
                mend=mend,
            )


def inertia_not_positive(doc: Document) -> Iterator[Found]:
    """The principal moments of a tensor are positive."""
    mend = "mend the signs of the products of inertia, or the units"
    yield from _impossible(doc, positive=False, mend=mend)


def inertia_triangle(doc: Document) -> Iterator[Found]:
    """No principal moment of a tensor exceeds the sum of the other two."""
    mend = "raise the smaller moments; MuJoCo does it itself with "
    mend += '<mujoco><compiler balanceinertia="true"/></mujoco>'
    yield from _impossible(doc, positive=True, mend=mend)


def root_inertia(doc: Document) -> Iterator[Found]:
    """The root link has no mass."""
    for name in doc.roots[:1]:
        if doc.moving and _mass(doc, name):
            yield Found(
                doc.link_by_name[name],
                "is the root and has an <inertial>",
                complain(KDL, text="takes no root with inertia: leaves it out with a warning"),
                mend="hang the mass on a child of the root by a fixed joint",
            )
