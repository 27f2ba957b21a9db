"""Rules of mass: what moves needs some, and a tensor that a body could have."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from lxml import etree

from dh2urdf.checks.document import MOVING, TENSOR, Document
from dh2urdf.checks.findings import URDFDOM, Consumer, Effect, complain, misread, refuse
from dh2urdf.checks.report import Found
from dh2urdf.conversions.write import tensor, why_impossible
from dh2urdf.transforms import Array

__all__ = [
    "inertia_not_positive",
    "inertia_triangle",
    "inertia_zero",
    "inertial_incomplete",
    "mass_negative",
    "massless",
    "massless_frame",
    "massless_part",
    "root_inertia",
]

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
        effects = [
            *([] if shells else [refuse(Consumer.MUJOCO)]),
            *(
                [complain(Consumer.PINOCCHIO, text="forward dynamics give NaN")]
                if name not in laden
                else []
            ),
            misread(Consumer.GAZEBO, text="drops the link and all that hangs on it"),
        ]
        if empty:
            effects.append(complain(Consumer.PYBULLET, text="takes it for 1 kg"))
        yield Found(
            link,
            "moves, and has no <inertial>" if empty else "moves, and has no mass",
            *tuple(effects),
            mend=f"give it a mass and a tensor; {ESTIMATE}",
        )


def _unreadable(doc: Document, part: list[str]) -> bool:
    """True where an <inertial> is there but incomplete or no number, which other rules say."""
    for member in part:
        inertial = doc.link_by_name[member].find("inertial")
        if inertial is not None and _mass(doc, member) is None:
            return True
    return False


def massless_part(doc: Document) -> Iterator[Found]:
    """A moving link has its mass itself, not in a part fixed to it."""
    for name in doc.moving:
        link = doc.link_by_name[name]
        others = [m for m in doc.rigid_part(name)[1:] if _mass(doc, m)]
        if link.find("inertial") is None and others:
            yield Found(
                link,
                f"has no <inertial>; its mass is in {', '.join(map(repr, others))}",
                complain(Consumer.PYBULLET, text="adds 1 kg"),
                misread(Consumer.GAZEBO, text="may drop the link"),
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
        yield Found(
            doc.link_by_name[silent[0]],
            f"has no <inertial>{_and_others(silent)}",
            complain(Consumer.PYBULLET, text="takes each for 1 kg"),
            mend="give it an <inertial> with mass 0 and a zero tensor",
        )


def _and_others(names: list[str]) -> str:
    return f"; nor has {', '.join(map(repr, names[1:]))}" if len(names) > 1 else ""


def mass_negative(doc: Document) -> Iterator[Found]:
    """No mass is negative."""
    for name, link in doc.link_by_name.items():
        mass = _mass(doc, name)
        if mass is not None and mass < 0:
            yield Found(
                link,
                f"has a mass of {mass:g} kg",
                *_by_mujoco(doc, name),
                complain(Consumer.DRAKE),
                misread(Consumer.PINOCCHIO, text="computes with it"),
                mend="mend the sign",
            )


def _by_mujoco(doc: Document, link: str) -> list[Effect]:
    """MuJoCo looks at the mass of what moves."""
    return [refuse(Consumer.MUJOCO)] if link in doc.moving else []


def inertial_incomplete(doc: Document) -> Iterator[Found]:
    """An <inertial> has a mass and all six numbers of its tensor."""
    for link in doc.links:
        inertial = link.find("inertial")
        if inertial is None:
            continue
        mass, element = inertial.find("mass"), inertial.find("inertia")
        missing = [] if mass is not None and mass.get("value") is not None else ["mass"]
        if element is None:
            missing.append("tensor")
        else:
            missing += [key for key in TENSOR if element.get(key) is None]
        if missing:
            yield Found(
                inertial,
                f"has no {', '.join(missing)}",
                refuse(Consumer.PYBULLET),
                *([] if missing[0] in ("ixy", "ixz", "iyz") else [refuse(Consumer.MUJOCO)]),
                complain(*URDFDOM, text="leave the whole <inertial> out"),
                *([complain(Consumer.DRAKE)] if missing[0] == "mass" else []),
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
            yield Found(
                inertial,
                "is a point: a mass without a tensor",
                refuse(Consumer.MUJOCO),
                *(
                    [complain(Consumer.PINOCCHIO, text="may compute NaN")]
                    if name not in laden and _on_axis(doc, name, inertial)
                    else []
                ),
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


def _impossible(doc: Document) -> Iterator[tuple[etree._Element, Array, str]]:
    """``(inertial, tensor, why)`` of the tensors, but zeros, that no body has."""
    for link in doc.links:
        inertial = link.find("inertial")
        inertia = None if inertial is None else _tensor(doc, inertial)
        if inertia is not None and inertia.any():
            why = why_impossible(inertia)
            if why:
                yield inertial, inertia, why


TENSOR_READERS = (
    refuse(Consumer.MUJOCO),
    complain(Consumer.DRAKE),
    complain(Consumer.PYBULLET, text="takes the tensor for zero"),
    misread(Consumer.PINOCCHIO, text="computes with it"),
)


def inertia_not_positive(doc: Document) -> Iterator[Found]:
    """The principal moments of a tensor are positive."""
    for inertial, inertia, why in _impossible(doc):
        if np.linalg.eigvalsh(inertia)[0] <= 0:
            yield Found(
                inertial,
                f"no body has this tensor: {why}",
                *TENSOR_READERS,
                mend="mend the signs of the products of inertia, or the units",
            )


def inertia_triangle(doc: Document) -> Iterator[Found]:
    """No principal moment of a tensor exceeds the sum of the other two."""
    for inertial, inertia, why in _impossible(doc):
        if np.linalg.eigvalsh(inertia)[0] > 0:
            yield Found(
                inertial,
                f"no body has this tensor: {why}",
                *TENSOR_READERS,
                mend="raise the smaller moments; MuJoCo does it itself with "
                '<mujoco><compiler balanceinertia="true"/></mujoco>',
            )


def root_inertia(doc: Document) -> Iterator[Found]:
    """The root link has no mass."""
    for name in doc.roots[:1]:
        if doc.moving and _mass(doc, name):
            yield Found(
                doc.link_by_name[name],
                "is the root and has an <inertial>",
                complain(
                    Consumer.KDL, text="takes no root with inertia: leaves it out with a warning"
                ),
                mend="hang the mass on a child of the root by a fixed joint",
            )
