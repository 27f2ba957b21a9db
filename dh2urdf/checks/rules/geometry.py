"""Rules of what is seen and touched: shapes, meshes, materials."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import (
    CHECK_URDF,
    DRAKE,
    GAZEBO,
    MOVEIT,
    MUJOCO,
    PINOCCHIO,
    PYBULLET,
    RVIZ,
    URDFDOM,
    YOURDFPY,
    Found,
    accept,
    complain,
    misread,
    refuse,
)
from dh2urdf.checks.mesh_files import is_remote, locate, stl_extent

SHAPES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "mesh": ()}

MUJOCO_MESHES = (".stl", ".obj", ".msh")

LEFT_OUT = "leave it out"

LARGE = 10.0
"""Length [m] above which the mesh of a robot's part is probably in millimetres."""


NO_EXTENT = misread(RVIZ, GAZEBO, text="show nothing, or make contact with nothing")

IN_METRES = misread(RVIZ, GAZEBO, MUJOCO, YOURDFPY, text="take STL files to be in metres")


def geometry_empty(doc: Document) -> Iterator[Found]:
    """Every visual and collision has a shape."""
    for link in doc.links:
        for shell in link.iterchildren("visual", "collision"):
            geometry = shell.find("geometry")
            if geometry is None or not len(geometry):
                refused, left_out = refuse(YOURDFPY, PYBULLET), complain(*URDFDOM, text=LEFT_OUT)
                mend = "write a shape, or drop the element"
                yield Found(shell, "has no shape", refused, left_out, mend=mend)


def _shapes(doc: Document) -> Iterator[tuple[etree._Element, etree._Element]]:
    for shell, geometry in doc.geometries():
        for shape in geometry.iterchildren(etree.Element):
            yield shell, shape


def geometry_unknown(doc: Document) -> Iterator[Found]:
    """Shapes are boxes, spheres, cylinders and meshes."""
    for shell, shape in _shapes(doc):
        if shape.tag not in SHAPES:
            yield Found(
                shell,
                f"<{shape.tag}> is none of <{'>, <'.join(SHAPES)}>",
                refuse(YOURDFPY),
                complain(*URDFDOM, text=LEFT_OUT),
                mend="a capsule is a cylinder and two spheres",
            )


def geometry_size(doc: Document) -> Iterator[Found]:
    """Sizes are positive."""
    for shell, shape in _shapes(doc):
        for key in SHAPES.get(shape.tag, ()):
            values = doc.numbers(shape, key)
            if values is not None and min(values) <= 0:
                yield Found(
                    shell,
                    f'<{shape.tag} {key}="{shape.get(key)}"> has no extent',
                    refuse(MUJOCO) if doc.mujoco_reads(shell) else None,
                    NO_EXTENT,
                    mend="write positive sizes, or drop the shape",
                )


class _Mesh(NamedTuple):
    """A mesh, its file where there is one, and whether MuJoCo reads it."""

    shell: etree._Element
    element: etree._Element
    name: str
    path: Path | None
    mujoco: bool


def _meshes(doc: Document) -> Iterator[_Mesh]:
    for shell, geometry in doc.geometries():
        for mesh in geometry.iterchildren("mesh"):
            name = mesh.get("filename", "")
            if not is_remote(name) and "${" not in name and "$(" not in name:
                path = locate(name, doc.path)
                yield _Mesh(shell, mesh, name, path, doc.mujoco_reads(shell))


def mesh_missing(doc: Document) -> Iterator[Found]:
    """Mesh files are there."""
    for mesh in _meshes(doc):
        if mesh.path is None:
            mend = "mend the path; plain paths start at the URDF's folder"
            if mesh.name.startswith(("package://", "model://")):
                mend = "put the package on ROS_PACKAGE_PATH, or beside the URDF's folder"
            visual = mesh.shell.tag == "visual"
            yield Found(
                mesh.element,
                f"no file {mesh.name!r}" if mesh.name else "names no file",
                refuse(MUJOCO) if mesh.mujoco else None,
                refuse(PYBULLET),
                complain(PINOCCHIO, text="loads the joints, not the geometry"),
                complain(RVIZ, GAZEBO, text=LEFT_OUT),
                complain(YOURDFPY, text="leaves it out") if visual else None,
                mend=mend,
            )


def mesh_path(doc: Document) -> Iterator[Found]:
    """Meshes are named by package:// or file://."""
    plain = [mesh for mesh in _meshes(doc) if "://" not in mesh.name and mesh.path]
    if plain:
        more = f", and {len(plain) - 1} more" if len(plain) > 1 else ""
        yield Found(
            plain[0].element,
            f"{plain[0].name!r} is a plain path{more}",
            accept(RVIZ, MOVEIT, text="find meshes by package:// or file:// only"),
            accept(PINOCCHIO, text="must be told the folder"),
            mend="for ROS, write package://...",
        )


def mesh_package(doc: Document) -> Iterator[Found]:
    """MuJoCo is given no package:// to resolve."""
    for mesh in _meshes(doc):
        if mesh.name.startswith("package://") and mesh.mujoco and mesh.path:
            yield Found(
                mesh.element,
                f"{mesh.name!r} is found by ROS only",
                refuse(MUJOCO, text="looks for a folder named package:"),
                mend="give MuJoCo a copy of the file with plain paths",
            )


def mesh_format(doc: Document) -> Iterator[Found]:
    """MuJoCo is given STL, OBJ or MSH."""
    for mesh in _meshes(doc):
        plain = mesh.mujoco and not mesh.name.startswith("package://")
        if plain and mesh.path and mesh.path.suffix.lower() not in MUJOCO_MESHES:
            reads = refuse(MUJOCO, text=f"reads {', '.join(MUJOCO_MESHES)}")
            message = f"is a {mesh.path.suffix} file"
            yield Found(mesh.element, message, reads, mend="convert it to STL or OBJ")


def mesh_scale(doc: Document) -> Iterator[Found]:
    """Scales are not zero."""
    for mesh in _meshes(doc):
        scale = doc.numbers(mesh.element, "scale")
        if scale is not None and not all(scale) and mesh.path:
            message = f'scale="{mesh.element.get("scale")}" leaves nothing of it'
            mend = "0.001 0.001 0.001 is from millimetres"
            yield Found(mesh.element, message, refuse(YOURDFPY), mend=mend)


def mesh_units(doc: Document) -> Iterator[Found]:
    """Meshes are in metres."""
    for mesh in _meshes(doc):
        scale = doc.numbers(mesh.element, "scale") or [1.0, 1.0, 1.0]
        extent = None if mesh.path is None else stl_extent(mesh.path)
        size = (extent or 0.0) * max(map(abs, scale))
        if size > LARGE:
            message = f"is {size:.6g} m long; is it in millimetres?"
            yield Found(mesh.element, message, IN_METRES, mend='write scale="0.001 0.001 0.001"')


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
                complain(CHECK_URDF),
                misread(RVIZ, text="draws it in a colour of its own"),
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
                refuse(PYBULLET),
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
                refuse(*URDFDOM, DRAKE),
                complain(PYBULLET),
                mend="define it once",
            )
        seen.add(name)
