"""Rules of names, of what joints join, of roots and loops."""

from collections.abc import Iterator, Sequence

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Effect, Finding, accept, complain, finding, misread, refuse
from dh2urdf.conversions.read import MOVING

KINDS = (*MOVING, "fixed", "floating", "planar")

VERSIONS = ("1.0", "1.1", "1.2", "1")
"""Versions of the format that urdfdom knows."""

EVERYONE = refuse("strict yourdfpy ikpy")

CRASHES = refuse("PyBullet", "crashes")

CUT = "cut one of the joints; closed loops need SDF or MJCF"


def robot_name(doc: Document) -> Iterator[Finding]:
    """<robot> has a name."""
    if not doc.root.get("name"):
        refused = refuse("urdfdom yourdfpy PyBullet Drake")
        yield finding(doc.root, "the robot has no name", refused, mend='write <robot name="...">')


def version(doc: Document) -> Iterator[Finding]:
    """The version of the format is one that urdfdom knows."""
    text = doc.root.get("version")
    if text is not None and text not in VERSIONS:
        effects = refuse("urdfdom"), complain("Drake", "ignores the attribute")
        mend = "leave the attribute out, or write 1.0"
        yield finding(doc.root, f'version="{text}" is no version of URDF', *effects, mend=mend)


def no_links(doc: Document) -> Iterator[Finding]:
    """There are links."""
    if not doc.links:
        mend = "is this the right file, or a xacro that was not expanded?"
        refused = refuse("urdfdom PyBullet ikpy")
        yield finding(doc.root, "the robot has no links", refused, mend=mend)


def no_name(doc: Document) -> Iterator[Finding]:
    """Every link and joint has a name."""
    empty = refuse("PyBullet"), complain("yourdfpy", "does not validate it")
    for element in (*doc.links, *doc.joints):
        name = element.get("name")
        if not name:
            effects = (EVERYONE,) if name is None else empty
            yield finding(element, "has no name", *effects, mend='write name="..."')


def _repeated(elements: Sequence[etree._Element], *effects: Effect) -> Iterator[Finding]:
    seen: set[str] = set()
    for element in elements:
        name = element.get("name")
        if name and name in seen:
            message = f"a second {element.tag} of this name"
            yield finding(element, message, *effects, mend="rename one of them")
        seen.add(str(name))


def duplicate_link(doc: Document) -> Iterator[Finding]:
    """No two links share a name."""
    dropped = misread("yourdfpy ikpy", "take one and drop the other")
    yield from _repeated(doc.links, refuse("strict"), dropped)


def duplicate_joint(doc: Document) -> Iterator[Finding]:
    """No two joints share a name."""
    shadowed = misread("yourdfpy MuJoCo", "take the file; one shadows the other")
    yield from _repeated(doc.joints, refuse("urdfdom Drake"), CRASHES, shadowed)


def joint_named_as_link(doc: Document) -> Iterator[Finding]:
    """No joint has the name of a link."""
    raises = accept("Pinocchio", "getFrameId without a FrameType raises on the name")
    for joint in doc.joints:
        if joint.get("name") in doc.link_by_name:
            mend = "name the joint otherwise, such as ..._joint"
            yield finding(joint, "a link has this name too", raises, mend=mend)


def joint_ends(doc: Document) -> Iterator[Finding]:
    """Every joint names a parent and a child."""
    for joint in doc.joints:
        for tag in ("parent", "child"):
            if not doc.end(joint, tag):
                mend = f'write <{tag} link="..."/>'
                yield finding(joint, f"has no <{tag}>", EVERYONE, mend=mend)


def _unknown(doc: Document, tag: str, *effects: Effect) -> Iterator[Finding]:
    for joint in doc.joints:
        name = doc.end(joint, tag)
        if name and name not in doc.link_by_name:
            message = f"its {tag} {name!r} is no link of the file"
            yield finding(joint, message, *effects, mend="mend the name, or add the link")


def unknown_child(doc: Document) -> Iterator[Finding]:
    """The child of every joint is a link of the file."""
    taken = misread("ikpy", "takes the joint as a link of its chain")
    yield from _unknown(doc, "child", refuse("strict yourdfpy"), taken)


def unknown_parent(doc: Document) -> Iterator[Finding]:
    """The parent of every joint is a link of the file."""
    taken = misread("yourdfpy ikpy", "take the file all the same")
    yield from _unknown(doc, "parent", refuse("strict"), taken)


def joins_itself(doc: Document) -> Iterator[Finding]:
    """No joint joins a link to itself."""
    hang = refuse("check_urdf ikpy", "do not come back")
    refused = refuse("Pinocchio yourdfpy MuJoCo Drake")
    for joint in doc.joints:
        if doc.end(joint, "parent") == doc.end(joint, "child") != "":
            message = f"joins {doc.end(joint, 'child')!r} to itself"
            mend = "mend its parent or its child"
            yield finding(joint, message, hang, CRASHES, refused, mend=mend)


def two_parents(doc: Document) -> Iterator[Finding]:
    """No link hangs on two joints."""
    effects = CRASHES, refuse("yourdfpy MuJoCo Drake")
    refused = refuse("Pinocchio", "or misreads, as the names fall")
    taken = misread("check_urdf", "takes the file as a tree without a word")
    above: dict[str, str] = {}
    for joint in doc.joints:
        child = doc.end(joint, "child")
        if child in above and doc.end(joint, "parent") != child:
            message = f"{child!r} hangs on joint {above[child]!r} already; a URDF is a tree"
            yield finding(joint, message, *effects, refused, taken, mend=CUT)
        above.setdefault(child, str(joint.get("name")))


def loop(doc: Document) -> Iterator[Finding]:
    """Links do not hang on themselves in a circle."""
    reached = doc.below(doc.roots)
    circle = [joint for _, child, joint in doc.edges if child not in reached]
    if circle:
        message = f"joints form a loop: {', '.join(str(joint.get('name')) for joint in circle)}"
        effects = refuse("strict ikpy"), misread("yourdfpy", "takes the file all the same")
        yield finding(circle[0], message, *effects, mend=CUT)


def several_roots(doc: Document) -> Iterator[Finding]:
    """One link only hangs on nothing."""
    hung = {doc.end(joint, "child") for joint in doc.joints}
    loose = [name for name in doc.roots if name not in hung]
    for name in loose[1:]:
        yield finding(
            doc.link_by_name[name],
            f"hangs on nothing, and so does {loose[0]!r}",
            refuse("urdfdom"),
            CRASHES,
            complain("yourdfpy", "hangs it on the base"),
            misread("Drake", "leaves it floating"),
            misread("MuJoCo", "welds it to the world"),
            mend="join it by a fixed joint, or drop it",
        )


def joint_type(doc: Document) -> Iterator[Finding]:
    """Every joint is of a type that URDF has."""
    mend = "a ball joint is three revolute joints; all else is one of the types above"
    for joint in doc.joints:
        kind = doc.kind(joint)
        if kind not in KINDS:
            refusing = "urdfdom Drake ikpy" if kind == "spherical" else "strict ikpy"
            message = f"type {kind!r} is none of {', '.join(KINDS)}" if kind else "has no type"
            yield finding(joint, message, refuse(refusing), complain("yourdfpy"), mend=mend)


def many_degrees(doc: Document) -> Iterator[Finding]:
    """No joint has more than one degree of freedom."""
    fixed = misread("KDL", "makes it a fixed joint")
    for joint in doc.joints:
        if doc.kind(joint) == "floating":
            below = doc.end(joint, "parent") not in doc.roots
            yield finding(
                joint,
                "has six degrees of freedom",
                refuse("ikpy"),
                refuse("MuJoCo", "refuses one below the top of the tree") if below else None,
                complain("Drake", "leaves the child a free body"),
                complain("PyBullet", "makes it a fixed joint"),
                fixed,
                mend="fix the base, and let the program that loads the file free it",
            )
        elif doc.kind(joint) == "planar":
            mend = "write two prismatic joints and a revolute one"
            yield finding(joint, "has three degrees of freedom", refuse("ikpy"), fixed, mend=mend)


def name_characters(doc: Document) -> Iterator[Finding]:
    """Names are of letters, digits and underscores."""
    become = accept("MoveIt IKFast", "names become ROS parameters, topics and C++ identifiers")
    slashes = accept("RViz", "frame names of tf hold no slashes")
    for element in (*doc.links, *doc.joints):
        name = str(element.get("name", ""))
        odd = [c for c in dict.fromkeys(name) if not (c.isascii() and (c.isalnum() or c in "_-."))]
        if odd:
            message = f"the name holds {' '.join(map(repr, odd))}"
            mend = "keep to ASCII letters, digits and underscores"
            yield finding(element, message, become, slashes, mend=mend)


def side_frame_first(doc: Document) -> Iterator[Finding]:
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
            text = f"follows the first joint of each link, and so ends at {child!r} unless told "
            effect = accept("ikpy", f"{text}every element of its way")
            message = f"stands before the joint of {link!r} that leads on along the arm"
            mend = "write joints of side frames behind those of the arm"
            yield finding(joint, message, effect, mend=mend)
