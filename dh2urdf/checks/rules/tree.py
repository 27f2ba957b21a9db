"""Rules of names, of what joints join, of roots and loops."""

from collections.abc import Iterator, Sequence

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import (
    CHECK_URDF,
    DRAKE,
    IKFAST,
    IKPY,
    KDL,
    MOVEIT,
    MUJOCO,
    PINOCCHIO,
    PYBULLET,
    RVIZ,
    STRICT,
    URDFDOM,
    YOURDFPY,
    Effect,
    Found,
    accept,
    complain,
    misread,
    refuse,
)
from dh2urdf.conversions.read import MOVING

KINDS = (*MOVING, "fixed", "floating", "planar")

EVERYONE = refuse(*STRICT, YOURDFPY, IKPY)

CRASHES = refuse(PYBULLET, text="crashes")

CUT = "cut one of the joints; closed loops need SDF or MJCF"


def robot_name(doc: Document) -> Iterator[Found]:
    """<robot> has a name."""
    if not doc.root.get("name"):
        refused = refuse(*URDFDOM, YOURDFPY, PYBULLET, DRAKE)
        yield Found(doc.root, "the robot has no name", refused, mend='write <robot name="...">')


def version(doc: Document) -> Iterator[Found]:
    """The version of the format is one that urdfdom knows."""
    text = doc.root.get("version")
    if text is not None and text not in ("1.0", "1.1", "1.2", "1"):
        yield Found(
            doc.root,
            f'version="{text}" is no version of URDF',
            refuse(*URDFDOM),
            complain(DRAKE, text="ignores the attribute"),
            mend="leave the attribute out, or write 1.0",
        )


def no_links(doc: Document) -> Iterator[Found]:
    """There are links."""
    if not doc.links:
        yield Found(
            doc.root,
            "the robot has no links",
            refuse(*URDFDOM, PYBULLET, IKPY),
            mend="is this the right file, or a xacro that was not expanded?",
        )


def no_name(doc: Document) -> Iterator[Found]:
    """Every link and joint has a name."""
    empty = (refuse(PYBULLET), complain(YOURDFPY, text="does not validate it"))
    for element in (*doc.links, *doc.joints):
        name = element.get("name")
        if not name:
            effects = (EVERYONE,) if name is None else empty
            yield Found(element, "has no name", *effects, mend='write name="..."')


def _repeated(elements: Sequence[etree._Element], *effects: Effect) -> Iterator[Found]:
    seen: set[str] = set()
    for element in elements:
        name = element.get("name")
        if name and name in seen:
            message = f"a second {element.tag} of this name"
            yield Found(element, message, *effects, mend="rename one of them")
        seen.add(str(name))


def duplicate_link(doc: Document) -> Iterator[Found]:
    """No two links share a name."""
    dropped = misread(YOURDFPY, IKPY, text="take one and drop the other")
    yield from _repeated(doc.links, refuse(*STRICT), dropped)


def duplicate_joint(doc: Document) -> Iterator[Found]:
    """No two joints share a name."""
    shadowed = misread(YOURDFPY, MUJOCO, text="take the file; one shadows the other")
    yield from _repeated(doc.joints, refuse(*URDFDOM, DRAKE), CRASHES, shadowed)


def joint_named_as_link(doc: Document) -> Iterator[Found]:
    """No joint has the name of a link."""
    for joint in doc.joints:
        if joint.get("name") in doc.link_by_name:
            yield Found(
                joint,
                "a link has this name too",
                accept(PINOCCHIO, text="getFrameId without a FrameType raises on the name"),
                mend="name the joint otherwise, such as ..._joint",
            )


def joint_ends(doc: Document) -> Iterator[Found]:
    """Every joint names a parent and a child."""
    for joint in doc.joints:
        for tag in ("parent", "child"):
            if not doc.end(joint, tag):
                yield Found(joint, f"has no <{tag}>", EVERYONE, mend=f'write <{tag} link="..."/>')


def _unknown(doc: Document, tag: str, *effects: Effect) -> Iterator[Found]:
    for joint in doc.joints:
        name = doc.end(joint, tag)
        if name and name not in doc.link_by_name:
            message = f"its {tag} {name!r} is no link of the file"
            yield Found(joint, message, *effects, mend="mend the name, or add the link")


def unknown_child(doc: Document) -> Iterator[Found]:
    """The child of every joint is a link of the file."""
    taken = misread(IKPY, text="takes the joint as a link of its chain")
    yield from _unknown(doc, "child", refuse(*STRICT, YOURDFPY), taken)


def unknown_parent(doc: Document) -> Iterator[Found]:
    """The parent of every joint is a link of the file."""
    taken = misread(YOURDFPY, IKPY, text="take the file all the same")
    yield from _unknown(doc, "parent", refuse(*STRICT), taken)


def joins_itself(doc: Document) -> Iterator[Found]:
    """No joint joins a link to itself."""
    for joint in doc.joints:
        if doc.end(joint, "parent") == doc.end(joint, "child") != "":
            yield Found(
                joint,
                f"joins {doc.end(joint, 'child')!r} to itself",
                refuse(CHECK_URDF, IKPY, text="do not come back"),
                CRASHES,
                refuse(PINOCCHIO, YOURDFPY, MUJOCO, DRAKE),
                mend="mend its parent or its child",
            )


def two_parents(doc: Document) -> Iterator[Found]:
    """No link hangs on two joints."""
    above: dict[str, str] = {}
    for joint in doc.joints:
        child = doc.end(joint, "child")
        if child in above and doc.end(joint, "parent") != child:
            yield Found(
                joint,
                f"{child!r} hangs on joint {above[child]!r} already; a URDF is a tree",
                CRASHES,
                refuse(YOURDFPY, MUJOCO, DRAKE),
                refuse(PINOCCHIO, text="or misreads, as the names fall"),
                misread(CHECK_URDF, text="takes the file as a tree without a word"),
                mend=CUT,
            )
        above.setdefault(child, str(joint.get("name")))


def loop(doc: Document) -> Iterator[Found]:
    """Links do not hang on themselves in a circle."""
    reached = doc.below(doc.roots)
    circle = [joint for _, child, joint in doc.edges if child not in reached]
    if circle:
        yield Found(
            circle[0],
            f"joints form a loop: {', '.join(str(joint.get('name')) for joint in circle)}",
            refuse(*STRICT, IKPY),
            misread(YOURDFPY, text="takes the file all the same"),
            mend=CUT,
        )


def several_roots(doc: Document) -> Iterator[Found]:
    """One link only hangs on nothing."""
    hung = {doc.end(joint, "child") for joint in doc.joints}
    loose = [name for name in doc.roots if name not in hung]
    for name in loose[1:]:
        yield Found(
            doc.link_by_name[name],
            f"hangs on nothing, and so does {loose[0]!r}",
            refuse(*URDFDOM),
            CRASHES,
            complain(YOURDFPY, text="hangs it on the base"),
            misread(DRAKE, text="leaves it floating"),
            misread(MUJOCO, text="welds it to the world"),
            mend="join it by a fixed joint, or drop it",
        )


def joint_type(doc: Document) -> Iterator[Found]:
    """Every joint is of a type that URDF has."""
    for joint in doc.joints:
        kind = doc.kind(joint)
        if kind not in KINDS:
            refusing = (*URDFDOM, DRAKE) if kind == "spherical" else STRICT
            yield Found(
                joint,
                f"type {kind!r} is none of {', '.join(KINDS)}" if kind else "has no type",
                refuse(*refusing, IKPY),
                complain(YOURDFPY),
                mend="a ball joint is three revolute joints; all else is one of the types above",
            )


def many_degrees(doc: Document) -> Iterator[Found]:
    """No joint has more than one degree of freedom."""
    fixed = misread(KDL, text="makes it a fixed joint")
    for joint in doc.joints:
        if doc.kind(joint) == "floating":
            below = doc.end(joint, "parent") not in doc.roots
            yield Found(
                joint,
                "has six degrees of freedom",
                refuse(IKPY),
                refuse(MUJOCO, text="refuses one below the top of the tree") if below else None,
                complain(DRAKE, text="leaves the child a free body"),
                complain(PYBULLET, text="makes it a fixed joint"),
                fixed,
                mend="fix the base, and let the program that loads the file free it",
            )
        elif doc.kind(joint) == "planar":
            mend = "write two prismatic joints and a revolute one"
            yield Found(joint, "has three degrees of freedom", refuse(IKPY), fixed, mend=mend)


def name_characters(doc: Document) -> Iterator[Found]:
    """Names are of letters, digits and underscores."""
    for element in (*doc.links, *doc.joints):
        name = str(element.get("name", ""))
        odd = [c for c in dict.fromkeys(name) if not (c.isascii() and (c.isalnum() or c in "_-."))]
        if odd:
            text = "names become ROS parameters, topics and C++ identifiers"
            yield Found(
                element,
                f"the name holds {' '.join(map(repr, odd))}",
                accept(MOVEIT, IKFAST, text=text),
                accept(RVIZ, text="frame names of tf hold no slashes"),
                mend="keep to ASCII letters, digits and underscores",
            )


def side_frame_first(doc: Document) -> Iterator[Found]:
    """The first joint of each link leads on along the longest chain."""
    order = list(doc.roots)
    for name in order:
        order += [child for child, _ in doc.children[name]]
        if len(order) > len(doc.link_by_name):
            return
    below: dict[str, int] = {}

    def ways(link: str) -> list[int]:
        """Moving joints that each joint of a link leads to."""
        return [below.get(c, 0) + (doc.kind(j) in MOVING) for c, j in doc.children[link]]

    for name in reversed(order):
        below[name] = max(ways(name), default=0)
    for link, children in doc.children.items():
        along = ways(link)
        if len(along) > 1 and along[0] < max(along) and link in doc.moved | set(doc.roots):
            child, joint = children[0]
            text = f"follows the first joint of each link, and so ends at {child!r} "
            yield Found(
                joint,
                f"stands before the joint of {link!r} that leads on along the arm",
                accept(IKPY, text=f"{text}unless told every element of its way"),
                mend="write joints of side frames behind those of the arm",
            )
