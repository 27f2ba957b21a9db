"""Links and joints of a robot file as a tree, and the way between two of its links.

What a URDF and an MJCF have in common, read without interpretation: every joint keeps the
place in the file that messages name.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import NoReturn

from dh2urdf.conversions.inertia import Inertial
from dh2urdf.exceptions import NameNotFoundError, UrdfError
from dh2urdf.transforms import Array

__all__ = [
    "MOVING",
    "KinematicTree",
    "Step",
    "TreeJoint",
    "TreeLink",
    "choose_ends",
    "find_path",
    "rigid_part",
]

MOVING = ("revolute", "continuous", "prismatic")
"""Kinds of joints that a serial chain takes."""

TIP_NAMES = ("tool0", "tcp", "tool", "flange", "ee_link", "end_effector")
"""Names by which files call the end of an arm, tried in this order among equal chains."""


@dataclass(frozen=True, eq=False)
class TreeLink:
    """A rigid body; ``inertial`` is in the link's own frame."""

    name: str
    where: str
    inertial: Inertial | None = None


@dataclass(frozen=True, eq=False)
class TreeJoint:
    """A joint between two links.

    Parameters
    ----------
    kind : str
        ``revolute``, ``continuous``, ``prismatic``, ``fixed``, or any other name of the file.
    origin : array, shape (4, 4)
        Joint frame in the parent link's frame.
    axis : array, shape (3,)
        Unit vector in the joint frame; the child link moves along or about it.
    lower, upper, velocity, effort, damping, friction : float or None
        In [rad] or [m], per second, [N m] or [N].
    mimic : str
        Name of the joint that this one follows in the file, or empty.
    where : str
        ``file:line: <joint name="...">``.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Array
    axis: Array
    where: str
    lower: float | None = None
    upper: float | None = None
    velocity: float | None = None
    effort: float | None = None
    damping: float | None = None
    friction: float | None = None
    mimic: str = ""


@dataclass(frozen=True, eq=False)
class Step:
    """One joint on the way; ``forward`` from parent to child."""

    joint: TreeJoint
    forward: bool

    @property
    def link(self) -> str:
        """The link that the step leads to."""
        return self.joint.child if self.forward else self.joint.parent


@dataclass(frozen=True, eq=False)
class KinematicTree:
    """A robot file; ``warnings`` are remarks of its reader."""

    where: str
    name: str
    root: str
    links: dict[str, TreeLink]
    joints: tuple[TreeJoint, ...]
    warnings: tuple[str, ...] = field(default=())

    @cached_property
    def parent_joint(self) -> dict[str, TreeJoint]:
        """The joint above each link but the root."""
        return {joint.child: joint for joint in self.joints}

    @cached_property
    def leaves(self) -> tuple[str, ...]:
        """Links that nothing hangs on, in the order of the file."""
        parents = {joint.parent for joint in self.joints}
        return tuple(name for name in self.links if name not in parents)

    @cached_property
    def neighbours(self) -> dict[str, list[Step]]:
        """Joints at each link, up and down."""
        out: dict[str, list[Step]] = {name: [] for name in self.links}
        for joint in self.joints:
            out[joint.parent].append(Step(joint, True))
            out[joint.child].append(Step(joint, False))
        return out

    def above(self, link: str) -> list[TreeJoint]:
        """Joints from a link up to the root."""
        joints = []
        while link in self.parent_joint:
            joints.append(self.parent_joint[link])
            link = joints[-1].parent
        return joints

    def check_link(self, name: str) -> str:
        """The name, if the file has such a link.

        Raises
        ------
        NameNotFoundError
        """
        if name in self.links:
            return name
        close = difflib.get_close_matches(name, self.links, 1)
        hint = f"; did you mean {close[0]!r}?" if close else ""
        raise NameNotFoundError(
            f"{self.where}: no link named {name!r}; the file has {', '.join(self.links)}{hint}"
        )


def find_path(tree: KinematicTree, base: str, tip: str) -> list[Step]:
    """All joints from base up to the common ancestor and down to the tip.

    Raises
    ------
    NameNotFoundError, UrdfError
        No such link, nothing moves between them, or a joint of another kind is on the way.
    """
    up = tree.above(tree.check_link(base))
    down = tree.above(tree.check_link(tip))
    while up and down and up[-1] is down[-1]:
        up.pop()
        down.pop()
    steps = [Step(joint, False) for joint in up]
    steps += [Step(joint, True) for joint in reversed(down)]
    for step in steps:
        if step.joint.kind not in (*MOVING, "fixed"):
            raise UrdfError(
                f"{step.joint.where}: a {step.joint.kind} joint between {base!r} and {tip!r}; "
                f"a chain takes {', '.join(MOVING)} and fixed joints"
            )
    if not any(step.joint.kind in MOVING for step in steps):
        tips = ", ".join(tree.leaves)
        raise UrdfError(f"{tree.where}: no joint moves between {base!r} and {tip!r}; tips: {tips}")
    return steps


def choose_ends(tree: KinematicTree, base: str | None, tip: str | None) -> tuple[str, str]:
    """Base and tip, chosen where not given: the root and the end of the longest chain.

    Among leaves on one last joint a usual name (``tool0``, ...) wins, then the deepest, then the
    last in the file. Where several branches are equally long but share most of their joints, a
    hand on an arm, the chain ends at the link where they part.

    Raises
    ------
    NameNotFoundError
    UrdfError
        Several chains of the same length; the message offers their tips.
    """
    start = tree.root if base is None else tree.check_link(base)
    if tip is not None:
        return start, tree.check_link(tip)
    chains: dict[tuple[str, ...], list[str]] = {}
    for leaf in tree.leaves:
        moving = _moving_names(tree, start, leaf)
        if moving:
            chains.setdefault(moving, []).append(leaf)
    if not chains:
        _explain_no_chain(tree, start)
    most = max(map(len, chains))
    longest = {moving: tips for moving, tips in chains.items() if len(moving) == most}
    if len(longest) == 1:
        (tips,) = longest.values()
        usual = [name for name in TIP_NAMES if name in tips]
        deepest = max(tips, key=lambda tip: (len(tree.above(tip)), tips.index(tip)))
        return start, usual[0] if usual else deepest
    trunk = _shared(list(longest))
    if len(trunk) > most - len(trunk):
        return start, _fork(tree, start, [tips[0] for tips in longest.values()])
    offered = ", ".join(tip for tips in longest.values() for tip in tips)
    raise UrdfError(
        f"{tree.where}: {len(longest)} chains of {most} joints; choose the tip, one of: {offered}"
    )


def _explain_no_chain(tree: KinematicTree, start: str) -> NoReturn:
    """Raise UrdfError; name a joint of another kind that stands before the moving ones."""
    moves = any(joint.kind in MOVING for joint in tree.joints)
    for joint in tree.joints:
        if moves and joint.kind not in (*MOVING, "fixed"):
            raise UrdfError(
                f"{joint.where}: a {joint.kind} joint on the way from {start!r}; choose a base "
                f"behind it, such as {joint.child!r}"
            )
    raise UrdfError(f"{tree.where}: no revolute, continuous or prismatic joint below {start!r}")


def _moving_names(tree: KinematicTree, base: str, tip: str) -> tuple[str, ...]:
    """Names of the moving joints from base to tip; empty where another kind is on the way."""
    up, down = tree.above(base), tree.above(tip)
    while up and down and up[-1] is down[-1]:
        up.pop()
        down.pop()
    way = [*up, *reversed(down)]
    if any(joint.kind not in (*MOVING, "fixed") for joint in way):
        return ()
    return tuple(joint.name for joint in way if joint.kind in MOVING)


def _shared(chains: list[tuple[str, ...]]) -> tuple[str, ...]:
    """Joints that all chains begin with."""
    trunk = []
    for names in zip(*chains, strict=False):
        if len(set(names)) > 1:
            break
        trunk.append(names[0])
    return tuple(trunk)


def _fork(tree: KinematicTree, base: str, tips: list[str]) -> str:
    """The last link that the ways from the base to all tips have in common."""
    ways = [[base, *(step.link for step in find_path(tree, base, tip))] for tip in tips]
    common: list[str] = [names[0] for names in zip(*ways, strict=False) if len(set(names)) == 1]
    return common[-1]


def rigid_part(tree: KinematicTree, link: str, cut: frozenset[str]) -> Iterator[list[Step]]:
    """Ways from a link to all links that hang together with it when some joints are cut.

    Parameters
    ----------
    cut : frozenset of joint names
    """
    todo: list[tuple[str, list[Step]]] = [(link, [])]
    seen = {link}
    while todo:
        name, way = todo.pop()
        yield way
        for step in tree.neighbours[name]:
            if step.joint.name not in cut and step.link not in seen:
                seen.add(step.link)
                todo.append((step.link, [*way, step]))
