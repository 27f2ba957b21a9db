"""Rules of joints: limits, axes, dynamics."""

import math
from collections.abc import Iterator, Sequence

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import (
    CHECK_URDF,
    DRAKE,
    GAZEBO,
    IKFAST,
    IKPY,
    KDL,
    MOVEIT,
    MUJOCO,
    PINOCCHIO,
    PYBULLET,
    URDFDOM,
    YOURDFPY,
    Found,
    accept,
    complain,
    misread,
    refuse,
)
from dh2urdf.conversions.read import MOVING

_Pair = tuple[etree._Element, etree._Element | None]

BOUNDED = ("revolute", "prismatic")

UNIT = 1e-6
"""How far from 1 the length of an axis may be: six written digits."""

INVALID = complain(YOURDFPY, text="does not validate it")

UNLIMITED = misread(MUJOCO, DRAKE, IKPY, text="take the joint as unlimited")


def _parts(doc: Document, tag: str, kinds: Sequence[str] = MOVING) -> Iterator[_Pair]:
    """``(joint, part)`` of the joints of some kinds; the part is None where there is none."""
    for joint in doc.joints:
        if doc.kind(joint) in kinds:
            yield joint, joint.find(tag)


def _missing(limit: etree._Element | None, keys: Sequence[str]) -> list[str]:
    return [] if limit is None else [key for key in keys if limit.get(key) is None]


def limit_missing(doc: Document) -> Iterator[Found]:
    """Revolute and prismatic joints have a <limit>."""
    for joint, limit in _parts(doc, "limit", BOUNDED):
        if limit is None:
            mend = 'write <limit lower="..." upper="..." effort="..." velocity="..."/>; wide '
            refused = refuse(*URDFDOM, PYBULLET)
            effects = (refused, INVALID, UNLIMITED)
            yield Found(joint, "has no <limit>", *effects, mend=f"{mend}ones rather than none")


def limit_incomplete(doc: Document) -> Iterator[Found]:
    """A <limit> has effort and velocity."""
    for _, limit in _parts(doc, "limit"):
        missing = _missing(limit, ("effort", "velocity"))
        if missing:
            yield Found(
                limit,
                f"has no {' and no '.join(missing)}",
                refuse(*URDFDOM),
                INVALID,
                misread(PYBULLET, text="reads 0: motors without force"),
                mend=f"add {' '.join(f'{key}=...' for key in missing)}; URDF requires both",
            )


def limit_without_bounds(doc: Document) -> Iterator[Found]:
    """A <limit> of a revolute or prismatic joint has lower and upper."""
    for _, limit in _parts(doc, "limit", BOUNDED):
        missing = _missing(limit, ("lower", "upper"))
        if missing:
            both = len(missing) == 2
            text = "read 0: the joint cannot move" if both else "read 0 for it"
            yield Found(
                limit,
                f"has no {' and no '.join(missing)}",
                misread(*URDFDOM, text=text),
                INVALID,
                UNLIMITED if both else None,
                mend="write both bounds",
            )


def limit_reversed(doc: Document) -> Iterator[Found]:
    """The lower bound is not above the upper one."""
    for _, limit in _parts(doc, "limit", BOUNDED):
        lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
        if lower is not None and upper is not None and lower > upper:
            yield Found(
                limit,
                f"lower {lower:g} lies above upper {upper:g}",
                refuse(DRAKE, text="aborts"),
                misread(MUJOCO, text="takes the joint as unlimited"),
                misread(*URDFDOM, text="keep an empty range"),
                mend="exchange them, or mend the signs",
            )


def limit_zero(doc: Document) -> Iterator[Found]:
    """Effort, velocity and range are not zero."""
    still = "may hold the joint still: a limit of 0 is a limit"
    for joint, limit in _parts(doc, "limit"):
        zero = [key for key in ("effort", "velocity") if doc.number(limit, key) == 0]
        lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
        if doc.kind(joint) in BOUNDED and lower is not None and lower == upper:
            yield Found(
                limit,
                f"lower and upper are both {lower:g}",
                complain(MUJOCO, text="takes the joint as unlimited"),
                mend="write a range, or make the joint a fixed one",
            )
        if zero:
            yield Found(
                limit,
                f"{' and '.join(zero)} 0",
                accept(MOVEIT, GAZEBO, PYBULLET, text=still),
                mend="write the maker's figures, or large ones",
            )


def continuous(doc: Document) -> Iterator[Found]:
    """No joint is continuous."""
    two = "q has two numbers for it, cosine and sine: model.nq exceeds model.nv"
    for joint, _ in _parts(doc, "limit", ("continuous",)):
        yield Found(
            joint,
            "turns without end",
            accept(PINOCCHIO, text=two),
            accept(IKFAST, text="takes it with a range of one turn"),
            mend="if programs expect one number a joint, write a revolute one with limits of "
            "+-6.283185307179586",
        )


def axis_missing(doc: Document) -> Iterator[Found]:
    """Moving joints say what their axis is."""
    for joint, axis in _parts(doc, "axis"):
        if axis is None or axis.get("xyz") is None:
            yield Found(
                joint,
                "has no <axis>; that means x",
                complain(PYBULLET, text="says that it takes x"),
                mend='write <axis xyz="1 0 0"/> if x is meant; most arms turn about z',
            )


def axis_zero(doc: Document) -> Iterator[Found]:
    """The axis of a moving joint has a direction."""
    for _, axis in _parts(doc, "axis"):
        values = doc.numbers(axis, "xyz")
        if values is not None and not any(values):
            yield Found(
                axis,
                "is a zero vector",
                refuse(MUJOCO, DRAKE),
                complain(PINOCCHIO, YOURDFPY, text="compute NaN"),
                misread(CHECK_URDF, IKPY, text="take it as it is"),
                mend="write the direction",
            )


def axis_not_unit(doc: Document) -> Iterator[Found]:
    """The axis of a moving joint has length 1."""
    for joint, axis in _parts(doc, "axis"):
        values = doc.numbers(axis, "xyz") or (0.0,)
        length = math.hypot(*values)
        if any(values) and abs(length - 1) > UNIT and math.isfinite(length):
            effect = misread(IKPY, text="gives a matrix that is no rotation")
            if doc.kind(joint) == "prismatic":
                effect = misread(YOURDFPY, IKPY, text=f"move {length:.4g} times as far")
            unit = " ".join(repr(v / length + 0.0) for v in values)
            mend = f'write <axis xyz="{unit}"/>'
            yield Found(axis, f"has length {length:.6g}", effect, mend=mend)


def mimic_leader(doc: Document) -> Iterator[Found]:
    """A <mimic> names another moving joint."""
    for joint, element in _followers(doc):
        leader = element.get("joint")
        known = doc.joint_by_name.get(leader)
        itself = leader is not None and leader == joint.get("name")
        if leader is None:
            yield Found(
                element,
                "names no joint",
                refuse(*URDFDOM, MUJOCO, DRAKE),
                complain(YOURDFPY),
                mend='write <mimic joint="..."/>',
            )
        elif itself or known is None or doc.kind(known) not in MOVING:
            what = "the joint itself" if itself else f"{leader!r}, which is no moving joint"
            yield Found(
                element,
                f"follows {what}",
                refuse(DRAKE),
                (refuse if itself else complain)(MUJOCO),
                complain(YOURDFPY, text="takes the leader as 0"),
                accept(PINOCCHIO, CHECK_URDF, IKPY, text="do not look at it"),
                mend="mend the name of the joint that it follows",
            )


def mimic(doc: Document) -> Iterator[Found]:
    """No joint follows another."""
    own = "move it on its own; Pinocchio follows when asked (mimic=True)"
    for joint, element in _followers(doc):
        leader = doc.joint_by_name.get(element.get("joint", ""))
        if leader is not None and leader is not joint and doc.kind(leader) in MOVING:
            yield Found(
                element,
                f"follows {leader.get('name')!r}",
                accept(PINOCCHIO, PYBULLET, KDL, IKPY, text=own),
                mend="couple the joints in your own program",
            )


def _followers(doc: Document) -> Iterator[tuple[etree._Element, etree._Element]]:
    """Joints with a <mimic>, and that."""
    pairs = ((joint, joint.find("mimic")) for joint in doc.joints)
    return ((joint, element) for joint, element in pairs if element is not None)


def damping_negative(doc: Document) -> Iterator[Found]:
    """Damping and friction are not negative."""
    for joint in doc.joints:
        dynamics = joint.find("dynamics")
        for key in ("damping", "friction"):
            value = doc.number(dynamics, key)
            if value is not None and value < 0:
                yield Found(
                    dynamics,
                    f"{key} {value:g} drives the joint",
                    refuse(DRAKE) if key == "damping" else None,
                    misread(MUJOCO, PYBULLET, text="simulate it as it stands"),
                    mend="mend the sign",
                )
