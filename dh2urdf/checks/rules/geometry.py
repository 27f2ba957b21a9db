"""Rules of what is seen and touched: shapes, meshes, materials."""

from __future__ import annotations

from collections.abc import Iterator

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import URDFDOM, Consumer, accept, complain, misread, refuse
from dh2urdf.checks.meshes import is_remote, locate, stl_extent
from dh2urdf.checks.report import Found

__all__ = [
    "geometry_empty",
    "geometry_size",
    "geometry_unknown",
    "material_name",
    "material_twice",
    "material_undefined",
    "mesh_format",
    "mesh_missing",
    "mesh_package",
    "mesh_path",
    "mesh_scale",
    "mesh_units",
]

SHAPES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "mesh": ()}

MUJOCO_MESHES = (".stl", ".obj", ".msh")

LARGE = 10.0
"""Length [m] above which the mesh of a robot's part is probably in millimetres."""


def geometry_empty(doc: Document) -> Iterator[Found]:
    """Every visual and collision has a shape."""
    for link in doc.links:
        for shell in link.iterchildren("visual", "collision"):
            geometry = shell.find("geometry")
            if geometry is None or not len(geometry):
                yield Found(
                    shell,
                    "has no shape",
                    refuse(Consumer.YOURDFPY, Consumer.PYBULLET),
                    complain(*URDFDOM, text="leave it out"),
                    mend="write a shape, or drop the element",
                )


def geometry_unknown(doc: Document) -> Iterator[Found]:
    """Shapes are boxes, spheres, cylinders and meshes."""
    for shell, geometry in doc.geometries():
        for shape in geometry.iterchildren(etree.Element):
            if shape.tag not in SHAPES:
                yield Found(
                    shell,
                    f"<{shape.tag}> is none of <{'>, <'.join(SHAPES)}>",
                    refuse(Consumer.YOURDFPY),
                    complain(*URDFDOM, text="leave it out"),
                    mend="a capsule is a cylinder and two spheres",
                )


def geometry_size(doc: Document) -> Iterator[Found]:
    """Sizes are positive."""
    for shell, geometry in doc.geometries():
        for shape in geometry.iterchildren(etree.Element):
            for key in SHAPES.get(shape.tag, ()):
                values = doc.numbers(shape, key)
                if values is not None and min(values) <= 0:
                    yield Found(
                        shell,
                        f'<{shape.tag} {key}="{shape.get(key)}"> has no extent',
                        *([refuse(Consumer.MUJOCO)] if doc.mujoco_reads(shell) else []),
                        misread(
                            Consumer.RVIZ,
                            Consumer.GAZEBO,
                            text="show nothing, or make contact with nothing",
                        ),
                        mend="write positive sizes, or drop the shape",
                    )


def _meshes(doc: Document) -> Iterator[tuple[etree._Element, etree._Element, str]]:
    for shell, geometry in doc.geometries():
        for mesh in geometry.iterchildren("mesh"):
            filename = mesh.get("filename", "")
            if not is_remote(filename) and "${" not in filename and "$(" not in filename:
                yield shell, mesh, filename


def mesh_missing(doc: Document) -> Iterator[Found]:
    """Mesh files are there."""
    for shell, mesh, filename in _meshes(doc):
        if locate(filename, doc.path) is None:
            package = filename.startswith(("package://", "model://"))
            effects = [
                refuse(Consumer.PYBULLET),
                complain(Consumer.PINOCCHIO, text="loads the joints, not the geometry"),
                complain(Consumer.RVIZ, Consumer.GAZEBO, text="leave it out"),
            ]
            if shell.tag == "visual":
                effects.append(complain(Consumer.YOURDFPY, text="leaves it out"))
            if doc.mujoco_reads(shell):
                effects.insert(0, refuse(Consumer.MUJOCO))
            yield Found(
                mesh,
                f"no file {filename!r}" if filename else "names no file",
                *tuple(effects),
                mend="put the package on ROS_PACKAGE_PATH, or beside the URDF's folder"
                if package
                else "mend the path; plain paths start at the URDF's folder",
            )


def mesh_path(doc: Document) -> Iterator[Found]:
    """Meshes are named by package:// or file://."""
    plain = [mesh for _, mesh, name in _meshes(doc) if "://" not in name and locate(name, doc.path)]
    if plain:
        more = f", and {len(plain) - 1} more" if len(plain) > 1 else ""
        yield Found(
            plain[0],
            f"{plain[0].get('filename')!r} is a plain path{more}",
            accept(
                Consumer.RVIZ, Consumer.MOVEIT, text="find meshes by package:// or file:// only"
            ),
            accept(Consumer.PINOCCHIO, text="must be told the folder"),
            mend="for ROS, write package://...",
        )


def mesh_package(doc: Document) -> Iterator[Found]:
    """MuJoCo is given no package:// to resolve."""
    for shell, mesh, filename in _meshes(doc):
        if (
            filename.startswith("package://")
            and doc.mujoco_reads(shell)
            and locate(filename, doc.path)
        ):
            yield Found(
                mesh,
                f"{filename!r} is found by ROS only",
                refuse(Consumer.MUJOCO, text="looks for a folder named package:"),
                mend="give MuJoCo a copy of the file with plain paths",
            )


def mesh_format(doc: Document) -> Iterator[Found]:
    """MuJoCo is given STL, OBJ or MSH."""
    for shell, mesh, filename in _meshes(doc):
        path = locate(filename, doc.path)
        plain = not filename.startswith("package://")
        if (
            path is not None
            and plain
            and path.suffix.lower() not in MUJOCO_MESHES
            and doc.mujoco_reads(shell)
        ):
            yield Found(
                mesh,
                f"is a {path.suffix} file",
                refuse(Consumer.MUJOCO, text=f"reads {', '.join(MUJOCO_MESHES)}"),
                mend="convert it to STL or OBJ",
            )


def mesh_scale(doc: Document) -> Iterator[Found]:
    """Scales are not zero."""
    for _, mesh, filename in _meshes(doc):
        scale = doc.numbers(mesh, "scale")
        if scale is not None and not all(scale) and locate(filename, doc.path):
            yield Found(
                mesh,
                f'scale="{mesh.get("scale")}" leaves nothing of it',
                refuse(Consumer.YOURDFPY),
                mend="0.001 0.001 0.001 is from millimetres",
            )


def mesh_units(doc: Document) -> Iterator[Found]:
    """Meshes are in metres."""
    for _, mesh, filename in _meshes(doc):
        path = locate(filename, doc.path)
        scale = doc.numbers(mesh, "scale") or [1.0, 1.0, 1.0]
        extent = None if path is None else stl_extent(path)
        size = 0.0 if extent is None else extent * max(map(abs, scale))
        if size > LARGE:
            yield Found(
                mesh,
                f"is {size:.6g} m long; is it in millimetres?",
                misread(
                    Consumer.RVIZ,
                    Consumer.GAZEBO,
                    Consumer.MUJOCO,
                    Consumer.YOURDFPY,
                    text="take STL files to be in metres",
                ),
                mend='write scale="0.001 0.001 0.001"',
            )


def _colours(material: etree._Element) -> bool:
    return material.find("color") is not None or material.find("texture") is not None


def material_undefined(doc: Document) -> Iterator[Found]:
    """Materials that are used are defined somewhere."""
    used = [m for shell, _ in doc.geometries() for m in shell.iterchildren("material")]
    defined = {m.get("name") for m in (*doc.root.iterchildren("material"), *used) if _colours(m)}
    told = set()
    for material in used:
        name = material.get("name")
        if name and name not in defined and name not in told:
            told.add(name)
            yield Found(
                material,
                "is defined nowhere",
                complain(Consumer.CHECK_URDF),
                misread(Consumer.RVIZ, text="draws it in a colour of its own"),
                mend='add <color rgba="..."/>, or drop it',
            )


def material_name(doc: Document) -> Iterator[Found]:
    """Every material has a name."""
    for material in doc.root.iter("material"):
        owner = material.getparent()
        if material.get("name") is None and owner is not None and owner.tag == "visual":
            yield Found(
                material,
                "has no name",
                refuse(Consumer.PYBULLET),
                complain(*URDFDOM, text="leave the visual out"),
                mend='write name="..."',
            )


def material_twice(doc: Document) -> Iterator[Found]:
    """No two materials of the robot share a name."""
    seen: set[str] = set()
    for material in doc.root.iterchildren("material"):
        name = str(material.get("name"))
        if name in seen:
            yield Found(
                material,
                "a second material of this name",
                refuse(*URDFDOM, Consumer.DRAKE),
                complain(Consumer.PYBULLET),
                mend="define it once",
            )
        seen.add(name)
