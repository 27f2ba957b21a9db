"""Rules of joints: limits, axes, dynamics."""

import math
from collections.abc import Iterator, Sequence

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Finding, accept, complain, finding, misread, refuse
from dh2urdf.conversions.read import MOVING

_Pair = tuple[etree._Element, etree._Element | None]

BOUNDED = ("revolute", "prismatic")

UNIT = 1e-6
"""How far from 1 the length of an axis may be: six written digits."""

INVALID = complain("yourdfpy", "does not validate it")

UNLIMITED = misread("MuJoCo Drake ikpy", "take the joint as unlimited")


def _parts(doc: Document, tag: str, kinds: Sequence[str] = MOVING) -> Iterator[_Pair]:
    """``(joint, part)`` of the joints of some kinds; the part is None where there is none."""
    return ((joint, joint.find(tag)) for joint in doc.joints if doc.kind(joint) in kinds)


def _missing(limit: etree._Element | None, keys: Sequence[str]) -> list[str]:
    return [] if limit is None else [key for key in keys if limit.get(key) is None]


def limit_missing(doc: Document) -> Iterator[Finding]:
    """Revolute and prismatic joints have a <limit>."""
    effects = refuse("urdfdom PyBullet"), INVALID, UNLIMITED
    mend = 'write <limit lower="..." upper="..." effort="..." velocity="..."/>; wide ones rather '
    for joint, limit in _parts(doc, "limit", BOUNDED):
        if limit is None:
            yield finding(joint, "has no <limit>", *effects, mend=f"{mend}than none")


def limit_incomplete(doc: Document) -> Iterator[Finding]:
    """A <limit> has effort and velocity."""
    effects = refuse("urdfdom"), INVALID, misread("PyBullet", "reads 0: motors without force")
    for _, limit in _parts(doc, "limit"):
        missing = _missing(limit, ("effort", "velocity"))
        if missing:
            mend = f"add {' '.join(f'{key}=...' for key in missing)}; URDF requires both"
            yield finding(limit, f"has no {' and no '.join(missing)}", *effects, mend=mend)


def limit_without_bounds(doc: Document) -> Iterator[Finding]:
    """A <limit> of a revolute or prismatic joint has lower and upper."""
    for _, limit in _parts(doc, "limit", BOUNDED):
        missing = _missing(limit, ("lower", "upper"))
        if missing:
            both = len(missing) == 2
            text = "read 0: the joint cannot move" if both else "read 0 for it"
            effects = misread("urdfdom", text), INVALID, UNLIMITED if both else None
            message = f"has no {' and no '.join(missing)}"
            yield finding(limit, message, *effects, mend="write both bounds")


def limit_reversed(doc: Document) -> Iterator[Finding]:
    """The lower bound is not above the upper one."""
    effects = refuse("Drake", "aborts"), misread("MuJoCo", "takes the joint as unlimited")
    empty = misread("urdfdom", "keep an empty range")
    for _, limit in _parts(doc, "limit", BOUNDED):
        lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
        if lower is not None and upper is not None and lower > upper:
            message = f"lower {lower:g} lies above upper {upper:g}"
            mend = "exchange them, or mend the signs"
            yield finding(limit, message, *effects, empty, mend=mend)


def limit_zero(doc: Document) -> Iterator[Finding]:
    """Effort, velocity and range are not zero."""
    still = "may hold the joint still: a limit of 0 is a limit"
    for joint, limit in _parts(doc, "limit"):
        zero = [key for key in ("effort", "velocity") if doc.number(limit, key) == 0]
        lower, upper = doc.number(limit, "lower"), doc.number(limit, "upper")
        if doc.kind(joint) in BOUNDED and lower is not None and lower == upper:
            unlimited = complain("MuJoCo", "takes the joint as unlimited")
            mend = "write a range, or make the joint a fixed one"
            yield finding(limit, f"lower and upper are both {lower:g}", unlimited, mend=mend)
        if zero:
            effect = accept("MoveIt Gazebo PyBullet", still)
            mend = "write the maker's figures, or large ones"
            yield finding(limit, f"{' and '.join(zero)} 0", effect, mend=mend)


def continuous(doc: Document) -> Iterator[Finding]:
    """No joint is continuous."""
    two = "q has two numbers for it, cosine and sine: model.nq exceeds model.nv"
    effects = accept("Pinocchio", two), accept("IKFast", "takes it with a range of one turn")
    mend = "if programs expect one number a joint, write a revolute one with limits of +-"
    for joint, _ in _parts(doc, "limit", ("continuous",)):
        yield finding(joint, "turns without end", *effects, mend=f"{mend}{2 * math.pi}")


def axis_missing(doc: Document) -> Iterator[Finding]:
    """Moving joints say what their axis is."""
    taken = complain("PyBullet", "says that it takes x")
    for joint, axis in _parts(doc, "axis"):
        if axis is None or axis.get("xyz") is None:
            mend = 'write <axis xyz="1 0 0"/> if x is meant; most arms turn about z'
            yield finding(joint, "has no <axis>; that means x", taken, mend=mend)


def axis_zero(doc: Document) -> Iterator[Finding]:
    """The axis of a moving joint has a direction."""
    effects = refuse("MuJoCo Drake"), complain("Pinocchio yourdfpy", "compute NaN")
    taken = misread("check_urdf ikpy", "take it as it is")
    for _, axis in _parts(doc, "axis"):
        values = doc.numbers(axis, "xyz")
        if values is not None and not any(values):
            yield finding(axis, "is a zero vector", *effects, taken, mend="write the direction")


def axis_not_unit(doc: Document) -> Iterator[Finding]:
    """The axis of a moving joint has length 1."""
    for joint, axis in _parts(doc, "axis"):
        values = doc.numbers(axis, "xyz") or (0.0,)
        length = math.hypot(*values)
        if any(values) and abs(length - 1) > UNIT and math.isfinite(length):
            effect = misread("ikpy", "gives a matrix that is no rotation")
            if doc.kind(joint) == "prismatic":
                effect = misread("yourdfpy ikpy", f"move {length:.4g} times as far")
            unit = " ".join(repr(v / length + 0.0) for v in values)
            mend = f'write <axis xyz="{unit}"/>'
            yield finding(axis, f"has length {length:.6g}", effect, mend=mend)


def mimic_leader(doc: Document) -> Iterator[Finding]:
    """A <mimic> names another moving joint."""
    for joint, element in _followers(doc):
        leader = element.get("joint")
        known = doc.joint_by_name.get(leader)
        itself = leader == joint.get("name")
        if leader is None:
            effects = refuse("urdfdom MuJoCo Drake"), complain("yourdfpy")
            yield finding(element, "names no joint", *effects, mend='write <mimic joint="..."/>')
        elif itself or known is None or doc.kind(known) not in MOVING:
            what = "the joint itself" if itself else f"{leader!r}, which is no moving joint"
            yield finding(
                element,
                f"follows {what}",
                refuse("Drake"),
                (refuse if itself else complain)("MuJoCo"),
                complain("yourdfpy", "takes the leader as 0"),
                accept("Pinocchio check_urdf ikpy", "do not look at it"),
                mend="mend the name of the joint that it follows",
            )


def mimic(doc: Document) -> Iterator[Finding]:
    """No joint follows another: some programs move it along, others on its own."""
    equality = "makes an equality of it from 3.13 on, which simulation keeps and qpos may not"
    constraint = "makes a constraint of it, which a SAP solver in discrete time keeps; else free"
    effects = (
        accept("MuJoCo", equality),
        accept("Drake", constraint),
        accept("PyBullet KDL ikpy", "move it on its own"),
    )
    moves = (
        accept("yourdfpy RViz", "move it along"),
        accept("Pinocchio", "moves it along when asked: buildModelFromUrdf(path, mimic=True)"),
    )
    stays = (
        complain("yourdfpy", "takes the leader as 0"),
        accept("Pinocchio", "moves it on its own; with mimic=True it refuses the file"),
        accept("RViz", "moves it along"),
    )
    for joint, element in _followers(doc):
        leader = doc.joint_by_name.get(element.get("joint", ""))
        if leader is not None and leader is not joint and doc.kind(leader) in MOVING:
            mend = "set both values in programs that move it on its own"
            words = f"follows {leader.get('name')!r}{_excluded(doc, joint, element, leader)}"
            moved = moves if leader.find("mimic") is None else stays
            if moved is stays:
                words = f"{words}, which follows another"
                mend = "name the joint that leads both, with the product of the multipliers"
            yield finding(element, words, *moved, *effects, mend=mend)


def _excluded(
    doc: Document, joint: etree._Element, mimic: etree._Element, leader: etree._Element
) -> str:
    """That the limits of a follower leave nothing of those of its leader; empty if they do."""
    factor, offset = doc.number(mimic, "multiplier"), doc.number(mimic, "offset") or 0.0
    factor = 1.0 if factor is None else factor
    own, led = (
        [doc.number(each.find("limit"), key) for key in ("lower", "upper")]
        if each.find("limit") is not None and doc.kind(each) in BOUNDED
        else [None, None]
        for each in (joint, leader)
    )
    if None in (*own, *led) or not factor:
        return ""
    low, high = sorted((float(end or 0.0) - offset) / factor + 0.0 for end in own)
    if max(low, float(led[0] or 0.0)) <= min(high, float(led[1] or 0.0)):
        return ""
    return f", but its limits leave that {low:.6g} to {high:.6g}, outside {led[0]:g} to {led[1]:g}"


def _followers(doc: Document) -> Iterator[tuple[etree._Element, etree._Element]]:
    """Joints with a <mimic>, and that."""
    pairs = ((joint, joint.find("mimic")) for joint in doc.joints)
    return ((joint, element) for joint, element in pairs if element is not None)


def damping_negative(doc: Document) -> Iterator[Finding]:
    """Damping and friction are not negative."""
    simulated = misread("MuJoCo PyBullet", "simulate it as it stands")
    for dynamics in (joint.find("dynamics") for joint in doc.joints):
        for key, refused in (("damping", refuse("Drake")), ("friction", None)):
            value = doc.number(dynamics, key)
            if value is not None and value < 0:
                message = f"{key} {value:g} drives the joint"
                yield finding(dynamics, message, refused, simulated, mend="mend the sign")
