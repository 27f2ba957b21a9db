"""A URDF's links and joints as one tree, with every fault named by element and line."""

from dataclasses import replace
from typing import NoReturn

from lxml import etree

from dh2urdf.bounds import ANGLE, LINKS
from dh2urdf.conversions.read.kinematic_tree import (
    MOVING,
    KinematicTree,
    TreeJoint,
    TreeLink,
    listed,
)
from dh2urdf.conversions.read.urdf_elements import UrdfReader
from dh2urdf.dh import Mimic
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import TableError, UrdfError


def read_urdf(
    root: etree._Element, where: str, base: str | None = None, tip: str | None = None
) -> KinematicTree:
    """Links and joints of a ``<robot>``; what is mended is mended in the document too.

    ``base`` and ``tip`` are the ends of the chain that is wanted: they tell what of a broken tree
    matters. A file that is too large raises UrdfError, as do links and joints that matter and do
    not form one tree; ``where`` names the file in messages.
    """
    if root.tag != "robot":
        raise UrdfError(f"{where}:{root.sourceline}: root element is <{root.tag}>, not <robot>")
    for tag in ("link", "joint"):
        if count_elements(root, tag, where) == 0:
            raise UrdfError(f"{where}:{root.sourceline}: <robot> has no {tag}s")
    return _Forest(root, UrdfReader(where)).tree(base, tip)


def count_elements(root: etree._Element, tag: str, where: str) -> int:
    """Number of links or joints of a ``<robot>``; more than are read raise UrdfError."""
    count = sum(1 for _ in root.iterchildren(tag))
    if count > LINKS:
        raise UrdfError(f"{where}:{root.sourceline}: {count} {tag}s; up to {LINKS} are read")
    return count


class _Forest:
    """All links and joints of a file, one tree or not."""

    def __init__(self, root: etree._Element, reader: UrdfReader) -> None:
        self.root, self.reader = root, reader
        self.links: dict[str, TreeLink] = {}
        self.joints: dict[str, TreeJoint] = {}
        self.above: dict[str, TreeJoint] = {}
        self.below: dict[str, list[TreeJoint]] = {}
        self.lost: list[tuple[str, bool]] = []
        for element in list(root.iterchildren("link")):
            self.add_link(element)
        for element in list(root.iterchildren("joint")):
            self.add_joint(element)
        for element in root.iterchildren("joint"):
            self.check_mimic(element)

    def add_link(self, element: etree._Element) -> None:
        link = self.reader.link(element)
        if link.name and link.name not in self.links:
            self.links[link.name] = link
            return
        what = "a second link of this name" if link.name else "has no name"
        self.reader.mends.append(f"{link.where}: {what}; left out")
        self.root.remove(element)

    def add_joint(self, element: etree._Element) -> None:
        """Take a joint in, or leave out one that does not hang a link on another."""
        reader = self.reader
        try:
            joint = reader.joint(element, self.links, self.joints)
            if joint.child in self.above:
                self.hang_twice(joint)
        except UrdfError as error:
            self.lost.append((str(error), element.get("type") in MOVING))
            reader.mends.append(f"{error}; left out")
            self.root.remove(element)
            return
        self.joints[joint.name] = self.above[joint.child] = joint
        self.below.setdefault(joint.parent, []).append(joint)

    def hang_twice(self, joint: TreeJoint) -> NoReturn:
        """Refuse a second joint to a link; the first is no way to go either."""
        first = self.above[joint.child]
        child, other = shown(joint.child), shown(first.name)
        fault = f"{joint.where}: link {child!r} hangs on joint {other!r} already; a URDF is a tree"
        self.joints[first.name] = self.above[joint.child] = replace(first, fault=fault)
        raise UrdfError(fault)

    def check_mimic(self, element: etree._Element) -> None:
        """Leave out a ``<mimic>`` of nothing."""
        mimic, reader = element.find("mimic"), self.reader
        if mimic is None:
            return
        try:
            factor, offset = (
                reader.numbers(mimic, key, (default,), ANGLE)[0]
                for key, default in (("multiplier", 1.0), ("offset", 0.0))
            )
            leader, name = mimic.get("joint", ""), element.get("name")
            if leader not in self.joints or leader == name:
                reader.fail(mimic, f"no joint {shown(leader)!r} to follow")
            follows = Mimic(leader, factor, offset)
            joint = self.joints[name] = replace(self.joints[name], mimic=follows)
            self.above[joint.child] = joint
        except (UrdfError, TableError) as error:
            reader.mends.append(f"{error}; left out")
            element.remove(mimic)

    def tree(self, base: str | None, tip: str | None) -> KinematicTree:
        """The tree that holds base and tip, or else the one with the most moving joints."""
        where, roots = self.reader.where, [name for name in self.links if name not in self.above]
        parts = {name: self.part(name) for name in roots}
        wanted = [name for name in (base, tip) if name in self.links]
        fits = [r for r, part in parts.items() if all(name in part for name in wanted)]
        moving = {
            r: sum(j.kind in MOVING for n in parts[r] for j in self.below.get(n, ())) for r in fits
        }
        best = sorted(fits, key=lambda r: -moving[r])[:2]
        if self.lost and not (base and tip and best):
            moves = sum(j.kind in MOVING for j in self.joints.values())
            for message, turns in self.lost:
                if not best or turns or moving[best[0]] < moves:
                    raise UrdfError(message)
        if not best:
            self.explain(parts, wanted)
        if len(best) == 2 and 0 < moving[best[1]] == moving[best[0]]:
            raise UrdfError(
                f"{self.links[best[1]].where}: a second root; {listed(roots)} hang on nothing"
            )
        kept = parts[best[0]]
        self.leave_out(kept)
        links = {name: link for name, link in self.links.items() if name in kept}
        joints = tuple(joint for joint in self.joints.values() if joint.parent in kept)
        name, reader = self.reader.name(self.root) or "robot", self.reader
        return KinematicTree(
            where, name, best[0], links, joints, tuple(reader.remarks), tuple(reader.mends)
        )

    def part(self, root: str) -> set[str]:
        """Links that hang on a root."""
        part, todo = {root}, [root]
        while todo:
            for joint in self.below.get(todo.pop(), ()):
                part.add(joint.child)
                todo.append(joint.child)
        return part

    def explain(self, parts: dict[str, set[str]], wanted: list[str]) -> None:
        """Say why no tree holds the chain that is wanted."""
        reached = set().union(*parts.values())
        circle = [joint for joint in self.joints.values() if joint.child not in reached]
        if circle:
            raise UrdfError(f"{circle[0].where}: closes a loop of links; a URDF is a tree")
        ends = " and ".join(repr(shown(name)) for name in wanted)
        raise UrdfError(f"{self.links[wanted[-1]].where}: {ends} do not hang together")

    def leave_out(self, kept: set[str]) -> None:
        """Take all that does not hang on the root out of the document."""
        for element in list(self.root.iterchildren("link")):
            name = element.get("name", "")
            if name not in kept:
                above = self.above.get(name)
                what = "a second root" if above is None else f"hangs on {shown(above.parent)!r}"
                self.reader.mend(element, f"{what}; left out")
                self.root.remove(element)
        for element in list(self.root.iterchildren("joint")):
            if element.find("child").get("link") not in kept:
                self.root.remove(element)
