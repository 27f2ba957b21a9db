"""Rules of joints: limits, axes, dynamics."""

from __future__ import annotations

import math
from collections.abc import Iterator

from dh2urdf.checks.document import MOVING, Document
from dh2urdf.checks.findings import URDFDOM, Consumer, accept, complain, misread, refuse
from dh2urdf.checks.report import Found

__all__ = [
    "axis_missing",
    "axis_not_unit",
    "axis_zero",
    "continuous",
    "damping_negative",
    "limit_incomplete",
    "limit_missing",
    "limit_reversed",
    "limit_without_bounds",
    "limit_zero",
]

BOUNDED = ("revolute", "prismatic")

UNIT = 1e-6
"""How far from 1 the length of an axis may be: six written digits."""


def limit_missing(doc: Document) -> Iterator[Found]:
    """Revolute and prismatic joints have a <limit>."""
    for joint in doc.joints:
        if doc.kind(joint) in BOUNDED and joint.find("limit") is None:
            yield Found(
                joint,
                "has no <limit>",
                refuse(*URDFDOM, Consumer.PYBULLET),
                complain(Consumer.YOURDFPY, text="does not validate it"),
                misread(
                    Consumer.MUJOCO,
                    Consumer.DRAKE,
                    Consumer.IKPY,
                    text="take the joint as unlimited",
                ),
                mend='write <limit lower="..." upper="..." effort="..." velocity="..."/>; wide '
                "ones rather than none",
            )


def limit_incomplete(doc: Document) -> Iterator[Found]:
    """A <limit> has effort and velocity."""
    for joint in doc.joints:
        limit = joint.find("limit")
        if doc.kind(joint) not in MOVING or limit is None:
            continue
        missing = [key for key in ("effort", "velocity") if limit.get(key) is None]
        if missing:
            yield Found(
                limit,
                f"has no {' and no '.join(missing)}",
                refuse(*URDFDOM),
                complain(Consumer.YOURDFPY, text="does not validate it"),
                misread(Consumer.PYBULLET, text="reads 0: motors without force"),
                mend=f"add {' '.join(f'{key}=...' for key in missing)}; URDF requires both",
            )


def limit_without_bounds(doc: Document) -> Iterator[Found]:
    """A <limit> of a revolute or prismatic joint has lower and upper."""
    for joint in doc.joints:
        limit = joint.find("limit")
        if doc.kind(joint) not in BOUNDED or limit is None:
            continue
        missing = [key for key in ("lower", "upper") if limit.get(key) is None]
        if missing:
            both = len(missing) == 2
            yield Found(
                limit,
                f"has no {' and no '.join(missing)}",
                misread(
                    *URDFDOM, text="read 0: the joint cannot move" if both else "read 0 for it"
                ),
                complain(Consumer.YOURDFPY, text="does not validate it"),
                *(
                    [
                        misread(
                            Consumer.MUJOCO,
                            Consumer.DRAKE,
                            Consumer.IKPY,
                            text="take the joint as unlimited",
                        )
                    ]
                    if both
                    else []
                ),
                mend="write both bounds",
            )


def limit_reversed(doc: Document) -> Iterator[Found]:
    """The lower bound is not above the upper one."""
    for joint in doc.joints:
        limit = joint.find("limit")
        lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
        if doc.kind(joint) in BOUNDED and lower is not None and upper is not None and lower > upper:
            yield Found(
                limit,
                f"lower {lower:g} lies above upper {upper:g}",
                refuse(Consumer.DRAKE, text="aborts"),
                misread(Consumer.MUJOCO, text="takes the joint as unlimited"),
                misread(*URDFDOM, text="keep an empty range"),
                mend="exchange them, or mend the signs",
            )


def limit_zero(doc: Document) -> Iterator[Found]:
    """Effort, velocity and range are not zero."""
    for joint in doc.joints:
        limit = joint.find("limit")
        if doc.kind(joint) not in MOVING:
            continue
        zero = [key for key in ("effort", "velocity") if doc.number(limit, key) == 0]
        lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
        if doc.kind(joint) in BOUNDED and lower is not None and lower == upper:
            yield Found(
                limit,
                f"lower and upper are both {lower:g}",
                complain(Consumer.MUJOCO, text="takes the joint as unlimited"),
                mend="write a range, or make the joint a fixed one",
            )
        if zero:
            yield Found(
                limit,
                f"{' and '.join(zero)} 0",
                accept(
                    Consumer.MOVEIT,
                    Consumer.GAZEBO,
                    Consumer.PYBULLET,
                    text="may hold the joint still: a limit of 0 is a limit",
                ),
                mend="write the maker's figures, or large ones",
            )


def continuous(doc: Document) -> Iterator[Found]:
    """No joint is continuous."""
    for joint in doc.joints:
        if doc.kind(joint) == "continuous":
            yield Found(
                joint,
                "turns without end",
                accept(
                    Consumer.PINOCCHIO,
                    text="q has two numbers for it, cosine and sine: model.nq exceeds model.nv",
                ),
                accept(Consumer.IKFAST, text="takes it with a range of one turn"),
                mend="if programs expect one number a joint, write a revolute one with limits of "
                "+-6.283185307179586",
            )


def axis_missing(doc: Document) -> Iterator[Found]:
    """Moving joints say what their axis is."""
    for joint in doc.joints:
        axis = joint.find("axis")
        if doc.kind(joint) in MOVING and (axis is None or axis.get("xyz") is None):
            yield Found(
                joint,
                "has no <axis>; that means x",
                complain(Consumer.PYBULLET, text="says that it takes x"),
                mend='write <axis xyz="1 0 0"/> if x is meant; most arms turn about z',
            )


def axis_zero(doc: Document) -> Iterator[Found]:
    """The axis of a moving joint has a direction."""
    for joint in doc.joints:
        values = doc.numbers(joint.find("axis"), "xyz")
        if doc.kind(joint) in MOVING and values is not None and not any(values):
            yield Found(
                joint.find("axis"),
                "is a zero vector",
                refuse(Consumer.MUJOCO, Consumer.DRAKE),
                complain(Consumer.PINOCCHIO, Consumer.YOURDFPY, text="compute NaN"),
                misread(Consumer.CHECK_URDF, Consumer.IKPY, text="take it as it is"),
                mend="write the direction",
            )


def axis_not_unit(doc: Document) -> Iterator[Found]:
    """The axis of a moving joint has length 1."""
    for joint in doc.joints:
        values = doc.numbers(joint.find("axis"), "xyz")
        if doc.kind(joint) not in MOVING or values is None or not any(values):
            continue
        length = math.hypot(*values)
        if abs(length - 1) > UNIT and math.isfinite(length):
            slides = doc.kind(joint) == "prismatic"
            movers = (Consumer.YOURDFPY, Consumer.IKPY) if slides else (Consumer.IKPY,)
            text = (
                f"move {length:.4g} times as far"
                if slides
                else "gives a matrix that is no rotation"
            )
            unit = " ".join(repr(v / length + 0.0) for v in values)
            yield Found(
                joint.find("axis"),
                f"has length {length:.6g}",
                misread(*movers, text=text),
                mend=f'write <axis xyz="{unit}"/>',
            )


def damping_negative(doc: Document) -> Iterator[Found]:
    """Damping and friction are not negative."""
    for joint in doc.joints:
        dynamics = joint.find("dynamics")
        for key in ("damping", "friction"):
            value = doc.number(dynamics, key)
            if value is not None and value < 0:
                refusing = (Consumer.DRAKE,) if key == "damping" else ()
                yield Found(
                    dynamics,
                    f"{key} {value:g} drives the joint",
                    *(refuse(c) for c in refusing),
                    misread(Consumer.MUJOCO, Consumer.PYBULLET, text="simulate it as it stands"),
                    mend="mend the sign",
                )
