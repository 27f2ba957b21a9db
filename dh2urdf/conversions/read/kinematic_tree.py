"""Links and joints of a robot file as a tree, and the way between two of its links.

What a URDF and an MJCF have in common, read without interpretation: every joint keeps the
place in the file that messages name.
"""

import difflib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile

import numpy as np

from dh2urdf.bounds import JOINTS
from dh2urdf.conversions.write import Inertial
from dh2urdf.dh import Mimic
from dh2urdf.dh_io.files import shown
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError, NameNotFoundError, UrdfError
from dh2urdf.transforms import Array, inverse

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


@dataclass(frozen=True)
class Actuation:
    """What a joint's drive can do, as far as the file says: per second, in [N m] or [N]."""

    velocity: float | None = None
    effort: float | None = None
    damping: float | None = None
    friction: float | None = None


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
    lower, upper : float or None
        In [rad] or [m].
    mimic : Mimic, optional
        What the joint follows in the file.
    where : str
        ``file:line: <joint name="...">``.
    fault : str
        What cannot be meant of it, with its place: no matter unless the joint is on the chain.
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
    drive: Actuation = Actuation()
    mimic: Mimic | None = None
    fault: str = ""


@dataclass(frozen=True, eq=False)
class Step:
    """One joint on the way; ``forward`` from parent to child."""

    joint: TreeJoint
    forward: bool

    @property
    def link(self) -> str:
        """The link that the step leads to."""
        return self.joint.child if self.forward else self.joint.parent

    @property
    def at_rest(self) -> Array:
        """The step at q = 0."""
        return self.joint.origin if self.forward else inverse(self.joint.origin)


@dataclass(frozen=True, eq=False)
class KinematicTree:
    """A robot file; ``mends`` tells what its reader set right, ``remarks`` what is odd."""

    where: str
    name: str
    root: str
    links: dict[str, TreeLink]
    joints: tuple[TreeJoint, ...]
    remarks: tuple[str, ...] = ()
    mends: tuple[str, ...] = ()

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
        """The name, if the file has such a link."""
        if name in self.links:
            return name
        wrong = no_such(name, self.links, "the file")
        raise NameNotFoundError(f"{self.where}: no link named {wrong}")


def find_path(tree: KinematicTree, base: str, tip: str) -> list[Step]:
    """All joints from base up to the common ancestor and down to the tip, some of them moving."""
    steps = _way(tree, tree.check_link(base), tree.check_link(tip))
    ends, moving = f"{shown(base)!r} and {shown(tip)!r}", 0
    for step in steps:
        if step.joint.fault:
            raise UrdfError(step.joint.fault)
        moving += step.joint.kind in MOVING
        if moving and step.joint.kind not in (*MOVING, "fixed"):
            raise UrdfError(
                f"{step.joint.where}: a {step.joint.kind} joint between {ends}; "
                f"a chain takes {', '.join(MOVING)} and fixed joints"
            )
    if not moving:
        tips = listed(tree.leaves)
        raise UrdfError(f"{tree.where}: no joint moves between {ends}; tips: {tips}")
    if moving > JOINTS:
        raise UrdfError(f"{tree.where}: {moving} joints between {ends}; a chain has up to {JOINTS}")
    return steps


def choose_ends(tree: KinematicTree, base: str | None, tip: str | None) -> tuple[str, str]:
    """Base and tip, chosen where not given: the root and the end of the longest chain.

    Among leaves on one last joint a usual name (``tool0``, ...) wins, then the deepest, then the
    last in the file. Where several branches are equally long but share most of their joints, a
    hand on an arm, the chain ends at the link where they part; else UrdfError offers their tips.
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
        faults = (joint.fault for joint in tree.joints if joint.fault)
        none = f"{tree.where}: no revolute, continuous or prismatic joint below {shown(start)!r}"
        raise UrdfError(next(faults, none))
    most = max(map(len, chains))
    longest = {moving: tips for moving, tips in chains.items() if len(moving) == most}
    if len(longest) == 1:
        (tips,) = longest.values()
        usual = [name for name in TIP_NAMES if name in tips]
        deepest = max(tips, key=lambda tip: (len(tree.above(tip)), tips.index(tip)))
        return start, usual[0] if usual else deepest
    alike = takewhile(lambda names: len(set(names)) == 1, zip(*longest, strict=True))
    trunk = sum(1 for _ in alike)  # joints that all chains begin with
    if trunk > most - trunk:
        return start, _fork(tree, start, [tips[0] for tips in longest.values()])
    offered = listed(tip for tips in longest.values() for tip in tips)
    raise UrdfError(
        f"{tree.where}: {len(longest)} chains of {most} joints; choose the tip, one of: {offered}"
    )


def _moving_names(tree: KinematicTree, base: str, tip: str) -> tuple[str, ...]:
    """Names of the moving joints from base to tip; empty where another kind is among them."""
    names: list[str] = []
    for step in _way(tree, base, tip):
        if step.joint.kind in MOVING:
            names.append(step.joint.name)
        elif names and step.joint.kind != "fixed":
            return ()
    return tuple(names)


def _way(tree: KinematicTree, base: str, tip: str) -> list[Step]:
    """All joints from base up to the common ancestor and down to the tip."""
    up, down = tree.above(base), tree.above(tip)
    while up and down and up[-1] is down[-1]:
        up.pop()
        down.pop()
    return [Step(joint, False) for joint in up] + [Step(joint, True) for joint in reversed(down)]


def _fork(tree: KinematicTree, base: str, tips: list[str]) -> str:
    """The last link that the ways from the base to all tips have in common."""
    ways = [[base, *(step.link for step in find_path(tree, base, tip))] for tip in tips]
    common: list[str] = [names[0] for names in zip(*ways, strict=False) if len(set(names)) == 1]
    return common[-1]


def rigid_part(
    tree: KinematicTree, link: str, cut: frozenset[str]
) -> Iterator[tuple[str, Step | None, Array]]:
    """All links that hang together with a link when some joints (by name) are cut.

    Each with the step that leads to it and its pose in the first link's frame, joints at 0.
    """
    todo: list[tuple[str, Step | None, Array]] = [(link, None, np.eye(4))]
    seen = {link}
    while todo:
        name, last, T = todo.pop()
        yield name, last, T
        for step in tree.neighbours[name]:
            if step.joint.name not in cut and step.link not in seen:
                seen.add(step.link)
                todo.append((step.link, step, T @ step.at_rest))


def listed(names: Iterable[str]) -> str:
    """The first forty names, and how many more."""
    everyone = list(names)
    more = f" and {len(everyone) - 40} more" if len(everyone) > 40 else ""
    return ", ".join(map(shown, everyone[:40])) + more


def no_such(name: object, names: Iterable[str], owner: str) -> str:
    """What to say of a name that is not among those there are."""
    everyone = list(names)
    near = {other[:60]: other for other in everyone}
    close = difflib.get_close_matches(name[:60], near, 1) if isinstance(name, str) else []
    hint = f"; did you mean {shown(near[close[0]])!r}?" if close else ""
    said = repr(shown(name)) if isinstance(name, str) else found(name)
    return f"{said}; {owner} has {listed(everyone)}{hint}"


def link_name(name: object, what: str) -> str | None:
    """The name of an end of the chain, in characters that a file can have."""
    if name is None or isinstance(name, str):
        return None if name is None else name.encode(errors="replace").decode()
    raise ArgumentError(f"{what}: expected the name of a link, got {found(name)}")
