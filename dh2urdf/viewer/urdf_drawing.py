"""The visuals of a URDF, meshes included, where they are on disk."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from dh2urdf.checks import locate
from dh2urdf.conversions.chains import frame_id
from dh2urdf.conversions.read import description_bytes
from dh2urdf.conversions.write import Body
from dh2urdf.dh_io.xml import parse_xml
from dh2urdf.drawing.surfaces import Node, Surface, body_surface
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, moved, origin_matrix

Find = Callable[[str], Path | None]
"""The file that a mesh's name means."""

GREY = (200, 204, 212)
"""Colour of a visual that has none."""

MESH_BYTES = 200_000_000
"""Largest mesh file that is read."""


class UrdfDrawing:
    """Links of a URDF with their visuals, a node each of its name, placed by Pinocchio."""

    def __init__(self, robot: Robot, nodes: list[Node]) -> None:
        self.robot, self.nodes = robot, tuple(nodes)
        model = robot.model
        self._data = model.createData()
        self._ids = [model.getFrameId(node.name, pin.FrameType.BODY) for node in nodes]
        self._base = frame_id(model, robot.base)

    def poses(self, q: Array) -> Array:
        """``T_base_link`` at q (n,), shape (links, 4, 4)."""
        model, data = self.robot.model, self._data
        pin.framesForwardKinematics(model, data, self.robot.model_configuration(q))
        M_base_world = data.oMf[self._base].inverse()
        return np.stack([(M_base_world * data.oMf[i]).homogeneous for i in self._ids])


def urdf_drawing(robot: Robot) -> tuple[UrdfDrawing | None, list[str]]:
    """The drawing of the robot's URDF, None where it has no visuals; and what is missing."""
    source = robot.source
    if source is None or source.suffix.lower() not in (".urdf", ".xacro"):
        return None, []
    root = parse_xml(*description_bytes(source, robot.xacro))
    find = partial(locate, urdf=source, packages=robot.xacro.packages)
    missing: set[str] = set()
    nodes, notes = [], []
    known = {f.name for f in robot.model.frames if f.type == pin.FrameType.BODY}
    materials = [m for m in root.iter("material") if m.find("color") is not None]
    colours = {m.get("name", ""): _rgb(m.find("color")) for m in materials}
    for link in root.iterfind("link"):
        name = link.get("name", "")
        surfaces: list[Surface] = []
        for visual in link.iterfind("visual"):
            surfaces += _visual(visual, colours, find, missing)
        if surfaces and name in known:
            nodes.append(Node(name, tuple(surfaces)))
    if missing:
        names = ", ".join(sorted(missing)[:3])
        names += f" and {len(missing) - 3} more" if len(missing) > 3 else ""
        where = "Give --package NAME=DIR, or set ROS_PACKAGE_PATH to their folder."
        notes.append(f"Meshes not found or not readable: {names}. {where}")
    return (UrdfDrawing(robot, nodes) if nodes else None), notes


def _rgb(colour: Any) -> tuple[int, int, int]:
    r, g, b, _ = [round(255 * min(max(float(v), 0.0), 1.0)) for v in colour.get("rgba").split()]
    return r, g, b


def _visual(
    visual: Any, colours: dict[str, tuple[int, int, int]], find: Find, missing: set[str]
) -> list[Surface]:
    """Surfaces of one ``<visual>`` in the frame of its link."""
    shape = visual.find("geometry/*")
    if shape is None:
        return []
    origin = visual.find("origin")
    given = origin.attrib if origin is not None else {}
    T_link_visual = origin_matrix(*(_numbers(given.get(key, "0 0 0")) for key in ("xyz", "rpy")))
    material = visual.find("material")
    colour = None
    if material is not None:
        own = material.find("color")
        colour = _rgb(own) if own is not None else colours.get(material.get("name", ""))
    if shape.tag == "mesh":
        return _mesh(shape, T_link_visual, colour, find, missing)
    keys = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",)}
    if shape.tag not in keys:
        return []
    size = _numbers(" ".join(shape.get(key, "0") for key in keys[shape.tag]))
    return [body_surface(Body(shape.tag, size, T_link_visual, "link"), colour or GREY)]


def _numbers(text: str) -> tuple[float, ...]:
    return tuple(float(v) for v in text.split())


def _mesh(
    shape: Any,
    T_link_visual: Array,
    colour: tuple[int, int, int] | None,
    find: Find,
    missing: set[str],
) -> list[Surface]:
    """Surfaces of a mesh file, scaled and placed."""
    name = shape.get("filename", "")
    path = find(name)
    scene = _load(path) if path else None
    if scene is None:
        missing.add(name)
        return []
    scale = np.array(_numbers(shape.get("scale", "1 1 1")))
    out = []
    for mesh in scene:
        placed = moved(T_link_visual, np.asarray(mesh.vertices, float) * scale)
        faces = np.asarray(mesh.faces, np.uint32)
        out.append(Surface(placed, faces, colour or _mesh_colour(mesh)))
    return out


def _load(path: Path) -> list[Any] | None:
    """Meshes of a file in metres, None where it cannot be read."""
    import trimesh

    if path.stat().st_size > MESH_BYTES:
        return None
    try:
        loaded = trimesh.load(path, force="scene")
        return [m for m in loaded.dump() if hasattr(m, "faces") and len(m.faces)]
    except Exception:
        return None


def _mesh_colour(mesh: Any) -> tuple[int, int, int]:
    try:
        r, g, b = (int(v) for v in mesh.visual.main_color[:3])
    except (AttributeError, TypeError, ValueError):
        return GREY
    return (r, g, b)
