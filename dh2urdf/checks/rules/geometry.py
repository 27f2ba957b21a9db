"""Rules of what is seen and touched: shapes, meshes, materials."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Finding, accept, complain, finding, misread, refuse
from dh2urdf.checks.mesh_files import is_remote, locate, stl_extent

SHAPES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "mesh": ()}

MUJOCO_MESHES = (".stl", ".obj", ".msh")

LARGE = 10.0
"""Length [m] above which the mesh of a robot's part is probably in millimetres."""


def geometry_empty(doc: Document) -> Iterator[Finding]:
    """Every visual and collision has a shape."""
    refused, left_out = refuse("yourdfpy PyBullet"), complain("urdfdom", "leave it out")
    for link in doc.links:
        for shell in link.iterchildren("visual", "collision"):
            geometry = shell.find("geometry")
            if geometry is None or not len(geometry):
                mend = "write a shape, or drop the element"
                yield finding(shell, "has no shape", refused, left_out, mend=mend)


def _shapes(doc: Document) -> Iterator[tuple[etree._Element, etree._Element]]:
    for shell, geometry in doc.geometries():
        for shape in geometry.iterchildren(etree.Element):
            yield shell, shape


def geometry_unknown(doc: Document) -> Iterator[Finding]:
    """Shapes are boxes, spheres, cylinders and meshes."""
    effects = refuse("yourdfpy"), complain("urdfdom", "leave it out")
    for shell, shape in _shapes(doc):
        if shape.tag not in SHAPES:
            message = f"<{shape.tag}> is none of <{'>, <'.join(SHAPES)}>"
            mend = "a capsule is a cylinder and two spheres"
            yield finding(shell, message, *effects, mend=mend)


def geometry_size(doc: Document) -> Iterator[Finding]:
    """Sizes are positive."""
    no_extent = misread("RViz Gazebo", "show nothing, or make contact with nothing")
    for shell, shape in _shapes(doc):
        refused = refuse("MuJoCo") if doc.mujoco_reads(shell) else None
        for key in SHAPES.get(shape.tag, ()):
            values = doc.numbers(shape, key)
            if values is not None and min(values) <= 0:
                message = f'<{shape.tag} {key}="{shape.get(key)}"> has no extent'
                mend = "write positive sizes, or drop the shape"
                yield finding(shell, message, refused, no_extent, mend=mend)


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
                path = locate(name, doc.path, doc.packages)
                yield _Mesh(shell, mesh, name, path, doc.mujoco_reads(shell))


def mesh_missing(doc: Document) -> Iterator[Finding]:
    """Mesh files are there."""
    for mesh in _meshes(doc):
        if mesh.path is None:
            mend = "mend the path; plain paths start at the URDF's folder"
            if mesh.name.startswith(("package://", "model://")):
                mend = "give --package NAME=DIR, or put its folder on ROS_PACKAGE_PATH"
            visual = mesh.shell.tag == "visual"
            yield finding(
                mesh.element,
                f"no file {mesh.name!r}" if mesh.name else "names no file",
                refuse("MuJoCo") if mesh.mujoco else None,
                refuse("PyBullet"),
                complain("Pinocchio", "loads the joints, not the geometry"),
                complain("RViz Gazebo", "leave it out"),
                complain("yourdfpy", "leaves it out") if visual else None,
                mend=mend,
            )


def mesh_path(doc: Document) -> Iterator[Finding]:
    """Meshes are named by package:// or file://."""
    plain = [mesh for mesh in _meshes(doc) if "://" not in mesh.name and mesh.path]
    if plain:
        more = f", and {len(plain) - 1} more" if len(plain) > 1 else ""
        message = f"{plain[0].name!r} is a plain path{more}"
        by_ros = accept("RViz MoveIt", "find meshes by package:// or file:// only")
        told = accept("Pinocchio", "must be told the folder")
        yield finding(plain[0].element, message, by_ros, told, mend="for ROS, write package://...")


def mesh_package(doc: Document) -> Iterator[Finding]:
    """MuJoCo is given no package:// to resolve."""
    refused = refuse("MuJoCo", "looks for a folder named package:")
    for mesh in _meshes(doc):
        if mesh.name.startswith("package://") and mesh.mujoco and mesh.path:
            message = f"{mesh.name!r} is found by ROS only"
            mend = "give MuJoCo a copy of the file with plain paths"
            yield finding(mesh.element, message, refused, mend=mend)


def mesh_format(doc: Document) -> Iterator[Finding]:
    """MuJoCo is given STL, OBJ or MSH."""
    reads = refuse("MuJoCo", f"reads {', '.join(MUJOCO_MESHES)}")
    for mesh in _meshes(doc):
        plain = mesh.mujoco and not mesh.name.startswith("package://")
        if plain and mesh.path and mesh.path.suffix.lower() not in MUJOCO_MESHES:
            message = f"is a {mesh.path.suffix} file"
            yield finding(mesh.element, message, reads, mend="convert it to STL or OBJ")


def mesh_scale(doc: Document) -> Iterator[Finding]:
    """Scales are not zero."""
    for mesh in _meshes(doc):
        scale = doc.numbers(mesh.element, "scale")
        if scale is not None and not all(scale) and mesh.path:
            message = f'scale="{mesh.element.get("scale")}" leaves nothing of it'
            mend = "0.001 0.001 0.001 is from millimetres"
            yield finding(mesh.element, message, refuse("yourdfpy"), mend=mend)


def mesh_units(doc: Document) -> Iterator[Finding]:
    """Meshes are in metres."""
    in_metres = misread("RViz Gazebo MuJoCo yourdfpy", "take STL files to be in metres")
    for mesh in _meshes(doc):
        scale = doc.numbers(mesh.element, "scale") or [1.0, 1.0, 1.0]
        extent = None if mesh.path is None else stl_extent(mesh.path)
        size = (extent or 0.0) * max(map(abs, scale))
        if size > LARGE:
            message = f"is {size:.6g} m long; is it in millimetres?"
            yield finding(mesh.element, message, in_metres, mend='write scale="0.001 0.001 0.001"')


def _colours(material: etree._Element) -> bool:
    return material.find("color") is not None or material.find("texture") is not None


def material_undefined(doc: Document) -> Iterator[Finding]:
    """Materials that are used are defined somewhere."""
    effects = complain("check_urdf"), misread("RViz", "draws it in a colour of its own")
    used = [m for shell, _ in doc.geometries() for m in shell.iterchildren("material")]
    told = {m.get("name") for m in (*doc.root.iterchildren("material"), *used) if _colours(m)}
    for material in used:
        name = material.get("name")
        if name and name not in told:
            told.add(name)
            mend = 'add <color rgba="..."/>, or drop it'
            yield finding(material, "is defined nowhere", *effects, mend=mend)


def material_name(doc: Document) -> Iterator[Finding]:
    """Every material has a name."""
    effects = refuse("PyBullet"), complain("urdfdom", "leave the visual out")
    for material in doc.root.iter("material"):
        owner = material.getparent()
        if material.get("name") is None and owner is not None and owner.tag == "visual":
            yield finding(material, "has no name", *effects, mend='write name="..."')


def material_twice(doc: Document) -> Iterator[Finding]:
    """No two materials of the robot share a name."""
    seen: set[str] = set()
    effects = refuse("urdfdom Drake"), complain("PyBullet")
    for material in doc.root.iterchildren("material"):
        name = str(material.get("name"))
        if name in seen:
            message = "a second material of this name"
            yield finding(material, message, *effects, mend="define it once")
        seen.add(name)
