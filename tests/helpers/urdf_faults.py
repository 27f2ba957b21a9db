"""Small URDFs, each with one fault, by the rule that finds it."""

import struct

BODY = (
    '<inertial><origin xyz="0 0 0.5"/><mass value="1"/>'
    '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
)
LIMIT = '<limit lower="-1" upper="1" effort="5" velocity="2"/>'
axis = '<axis xyz="{}"/>'.format


def box(tag="visual", size="0.1 0.1 0.1", extra=""):
    """A visual or collision box."""
    return f'<{tag}><geometry><box size="{size}"/></geometry>{extra}</{tag}>'


def mesh(filename, tag="visual", extra=""):
    """A visual or collision mesh."""
    return f'<{tag}><geometry><mesh filename="{filename}"{extra}/></geometry></{tag}>'


def joint(
    name="elbow", kind="revolute", parent="upper", child="fore", origin="0 0 1", rpy="0 0 0",
    axis='<axis xyz="0 1 0"/>', limit=LIMIT, extra="",
):  # fmt: skip
    """A joint element."""
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="{origin}" rpy="{rpy}"/>'
        f'<parent link="{parent}"/><child link="{child}"/>{axis}{limit}{extra}</joint>'
    )


def fixed(name, parent, child, extra=""):
    """A fixed joint."""
    return (
        f'<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/>'
        f"{extra}</joint>"
    )


def arm(upper=BODY, fore=BODY, elbow=None, base="", extra="", name='name="arm"'):
    """base_link - shoulder - upper - elbow - fore, sound unless told otherwise."""
    return f"""<?xml version="1.0"?>
<robot {name}>
  <link name="base_link">{base}</link>
  <link name="upper">{upper}</link>
  <link name="fore">{fore}</link>
  {joint("shoulder", parent="base_link", child="upper", axis=axis("0 0 1"))}
  {joint() if elbow is None else elbow}
  {extra}
</robot>
"""


def elbow(**changes):
    """The arm with its elbow changed."""
    return arm(elbow=joint(**changes))


def limit(*values):
    """A limit of lower, upper, effort and velocity, as many as there are."""
    names = zip(("lower", "upper", "effort", "velocity"), values, strict=False)
    return "<limit {}/>".format(" ".join(f'{name}="{value}"' for name, value in names))


def inertia(**changes):
    """The body's inertial with attributes of its tensor changed."""
    six = {"ixx": "0.1", "iyy": "0.1", "izz": "0.1", "ixy": "0", "ixz": "0", "iyz": "0"} | changes
    words = " ".join(f'{key}="{value}"' for key, value in six.items() if value is not None)
    return f'<inertial><mass value="1"/><inertia {words}/></inertial>'


KEEP = '<mujoco><compiler fusestatic="false" discardvisual="false"/></mujoco>'
TOOL = '<link name="tool0"/>' + fixed("tool_joint", "fore", "tool0")
WEIGHTLESS = '<inertial><mass value="0"/>' + "<inertia {}/></inertial>".format(
    " ".join(f'{key}="0"' for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
)

SOUND = arm()
GONE = ("package://nowhere/", "file:///nowhere/")

FAULTS = {
    "robot-name": [arm(name="")],
    "version": [arm(name='name="arm" version="2.0"')],
    "no-name": [
        arm(extra="<link/>"),
        arm(extra='<link name="c"/>' + fixed("", "fore", "c").replace(' name=""', "")),
        arm(extra='<link name="c"/>' + fixed("", "fore", "c")),
    ],
    "duplicate-link": [arm(extra='<link name="fore"/>')],
    "duplicate-joint": [arm(extra='<link name="c"/>' + fixed("elbow", "fore", "c"))],
    "joint-named-as-link": [elbow(name="fore")],
    "joint-ends": [
        arm(extra=f'<joint name="j" type="fixed"><{end} link="fore"/></joint>')
        for end in ("parent", "child")
    ],
    "unknown-child": [arm(extra=fixed("j", "fore", "nowhere"))],
    "unknown-parent": [arm(extra='<link name="c"/>' + fixed("j", "nowhere", "c"))],
    "joins-itself": [arm(extra=fixed("j", "fore", "fore"))],
    "two-parents": [
        arm(extra='<link name="c"/>' + fixed("j1", "base_link", "c") + fixed("j2", "fore", "c"))
    ],
    "loop": [arm(extra=fixed("j", "fore", "base_link"))],
    "several-roots": [arm(extra='<link name="c"/>')],
    "no-links": ['<robot name="arm"/>'],
    "joint-type": [
        arm(extra='<link name="c"/>' + fixed("j", "fore", "c").replace("fixed", "hinge")),
        arm(extra='<link name="c"/>' + fixed("j", "fore", "c").replace(' type="fixed"', "")),
    ],
    "many-degrees": [elbow(kind="floating", axis="", limit=""), elbow(kind="planar", limit="")],
    "repeated-element": [arm(upper=BODY + BODY), elbow(limit=LIMIT + LIMIT)],
    "limit-missing": [elbow(limit=""), elbow(kind="prismatic", limit="")],
    "limit-incomplete": [elbow(limit=limit(-1, 1)), elbow(limit=limit(-1, 1, 1))],
    "limit-without-bounds": [elbow(limit='<limit effort="1" velocity="1"/>')],
    "limit-reversed": [elbow(limit=limit(1, -1, 1, 1))],
    "limit-zero": [elbow(limit=limit(*v)) for v in ((-1, 1, 0, 0), (-1, 1, 1, 0), (0, 0, 1, 1))],
    "continuous": [elbow(kind="continuous", limit="")],
    "axis-missing": [elbow(axis="")],
    "axis-zero": [elbow(axis=axis("0 0 0"))],
    "axis-not-unit": [elbow(axis=axis("0 0 2")), elbow(kind="prismatic", axis=axis("0 2 0"))],
    "mimic-leader": [
        elbow(extra=f"<mimic{leader}/>") for leader in (' joint="nowhere"', ' joint="elbow"', "")
    ],
    "mimic": [elbow(extra='<mimic joint="shoulder"/>')],
    "damping-negative": [elbow(extra='<dynamics damping="-1"/>')],
    "xacro": [
        elbow(origin="0 0 ${length}"),
        arm(extra='<xacro:property xmlns:xacro="http://www.ros.org/wiki/xacro" name="a"/>'),
    ],
    "number": [
        *(elbow(origin=xyz) for xyz in ("0 0 pi/2", "0,0,1", "0 0 1_0")),
        elbow(axis=axis("0 0 up")),
        elbow(limit=LIMIT.replace('"5"', '"5Nm"')),
        arm(fore=BODY.replace('mass value="1"', 'mass value="1kg"')),
        arm(fore=inertia(ixx="0.1kgm2")),
        arm(fore=BODY + box(size="0.1 0.1 wide")),
    ],
    "number-count": [elbow(origin="0 1"), elbow(origin="0 1 2 3"), elbow(axis=axis("0 1"))],
    "not-finite": [
        *(elbow(origin=f"0 0 {word}") for word in ("nan", "inf", "1e400")),
        elbow(limit=limit("-inf", "inf", 1, 1)),
        arm(fore=BODY.replace('mass value="1"', 'mass value="nan"')),
    ],
    "negative-zero": [elbow(origin="0 -0.0 1")],
    "rounded-angle": [elbow(rpy=rpy) for rpy in ("1.5708 0 0", "0 0 -3.1416", "0 0.785398 0")],
    "massless": [arm(fore=""), arm(fore=WEIGHTLESS), arm(fore=box() + box("collision"))],
    "massless-part": [
        arm(fore="", extra=f'{KEEP}<link name="c">{BODY}</link>' + fixed("j", "fore", "c"))
    ],
    "massless-frame": [arm(extra=KEEP + TOOL)],
    "mass-negative": [arm(fore=BODY.replace('mass value="1"', 'mass value="-1"'))],
    "inertial-incomplete": [
        arm(fore=BODY.replace('<mass value="1"/>', "")),
        arm(fore='<inertial><mass value="1"/></inertial>'),
        arm(fore=inertia(izz=None)),
    ],
    "inertia-zero": [arm(fore=inertia(ixx="0", iyy="0", izz="0"))],
    "inertia-not-positive": [arm(fore=inertia(ixy="0.2")), arm(fore=inertia(ixx="-0.1"))],
    "inertia-triangle": [
        arm(fore=inertia(ixx="0.5")),
        arm(extra=f'<link name="c">{inertia(ixx="0.5")}</link>' + fixed("j", "base_link", "c")),
    ],
    "root-inertia": [arm(base=BODY)],
    "geometry-empty": [
        arm(fore=BODY + "<visual><geometry/></visual>"),
        arm(fore=BODY + "<visual/>"),
    ],
    "geometry-unknown": [
        arm(fore=BODY + '<visual><geometry><capsule radius="1" length="1"/></geometry></visual>')
    ],
    "geometry-size": [
        arm(fore=BODY + box("collision", "0 0.1 0.1")),
        arm(fore=BODY + box("visual", "0 0.1 0.1"), extra=KEEP),
    ],
    "mesh-missing": [
        *(arm(fore=BODY + mesh(f"{at}nowhere.stl")) for at in ("", *GONE)),
        arm(fore=BODY + mesh("nowhere.stl", "collision")),
    ],
    "mesh-path": [arm(fore=BODY + mesh("small.stl"))],
    "mesh-package": [arm(fore=BODY + mesh("package://meshes/small.stl", "collision"))],
    "mesh-format": [arm(fore=BODY + mesh("meshes/small.dae", "collision"))],
    "mesh-scale": [arm(fore=BODY + mesh("small.stl", extra=' scale="0 0 0"'))],
    "mesh-units": [arm(fore=BODY + mesh("big.stl"))],
    "material-undefined": [arm(fore=BODY + box(extra='<material name="blue"/>'))],
    "material-name": [arm(fore=BODY + box(extra='<material><color rgba="1 0 0 1"/></material>'))],
    "material-twice": [
        arm(
            extra='<material name="m"><color rgba="1 0 0 1"/></material>'
            '<material name="m"><color rgba="0 0 1 1"/></material>'
        )
    ],
    "name-characters": [
        SOUND.replace("fore", name) for name in ("fore arm", "Vorderärmel", "left/fore")
    ],
    "fused-frames": [arm(extra=TOOL.replace('"tool0"/>', f'"tool0">{WEIGHTLESS}</link>', 1))],
    "side-frame-first": [
        arm(
            extra=f'{KEEP}<link name="dh">{WEIGHTLESS}</link>',
            elbow=fixed("dh_joint", "upper", "dh") + joint(),
        )
    ],
}
"""Rule: files in which it finds something."""


def write_meshes(folder):
    """A cube of 0.1 m as STL and Collada, one of 100 m as STL."""
    (folder / "meshes").mkdir()
    for name, size in (("small.stl", 0.1), ("meshes/small.stl", 0.1), ("big.stl", 100.0)):
        (folder / name).write_bytes(cube(size))
    (folder / "meshes" / "small.dae").write_text(TRIANGLE)


def cube(size):
    """A cube as binary STL."""
    corner = [[(k >> i & 1) * size for i in (2, 1, 0)] for k in range(8)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [tri for a, b, c, d in quads for tri in ((a, b, c), (a, c, d))]
    body = b"".join(
        struct.pack("<12fH", 0, 0, 0, *(v for k in face for v in corner[k]), 0) for face in faces
    )
    return b"\0" * 80 + struct.pack("<I", len(faces)) + body


TRIANGLE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 0.1 0 0 0 0.1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
</accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""
