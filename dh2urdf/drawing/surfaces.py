"""Triangles of the drawn bodies, and what moves with what."""

from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from dh2urdf.conversions.write import Body
from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.colours import MATERIAL, rgb
from dh2urdf.transforms import Array, moved

AROUND = 32
"""Corners of a circle."""

Faces = NDArray[np.uint32]


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles (f, 3) of one colour, their vertices (v, 3) [m] in the frame of the node.

    ``solids`` tells where the vertices of each solid end, and is empty for one.
    """

    vertices: Array
    faces: Faces
    colour: tuple[int, int, int]
    solids: tuple[int, ...] = ()

    def shrunk(self, share: float) -> Self:
        """The same with every solid shrunk about its own middle."""
        ends = self.solids or (len(self.vertices),)
        parts = np.split(self.vertices, ends[:-1])
        small = [part.mean(axis=0) + share * (part - part.mean(axis=0)) for part in parts]
        return replace(self, vertices=np.concatenate(small))


@dataclass(frozen=True, eq=False)
class Node:
    """What moves as one: a link."""

    name: str
    surfaces: tuple[Surface, ...]

    def slim(self, share: float) -> Surface:
        """All of it as one surface, each part shrunk about its middle."""
        return merged([s.shrunk(share) for s in self.surfaces])


class Drawing(Protocol):
    """An arm as nodes that move."""

    nodes: tuple[Node, ...]

    def poses(self, q: Array) -> Array:
        """``T_base_node`` at q (n,), shape (nodes, 4, 4)."""
        ...


class TableDrawing:
    """The drawn bodies of a DH table."""

    def __init__(self, arm: DrawnArm) -> None:
        self.arm = arm
        self.nodes = tuple(
            Node(name, tuple(_by_material(bodies)))
            for name, bodies in zip(_names(arm), arm.bodies, strict=True)
        )

    def poses(self, q: Array) -> Array:
        """``T_base_node`` at joints q (n,), shape (nodes, 4, 4)."""
        return self.arm.link_poses(q)


def _names(arm: DrawnArm) -> list[str]:
    links = [f"link_{i}" for i in range(1, arm.table.n + 1)]
    return ["base", *links, *(f"bar_{k}" for k in range(1, len(arm.bars) + 1))]


def _by_material(bodies: list[Body]) -> list[Surface]:
    """One surface a material."""
    materials = dict.fromkeys(body.material for body in bodies)
    return [
        merged([body_surface(b, rgb(MATERIAL[m])) for b in bodies if b.material == m])
        for m in materials
    ]


def merged(surfaces: list[Surface]) -> Surface:
    """Several surfaces as one, in the colour of the first."""
    offsets = np.cumsum([0, *[len(s.vertices) for s in surfaces[:-1]]]).tolist()
    placed = list(zip(surfaces, offsets, strict=True))
    vertices = np.concatenate([s.vertices for s in surfaces])
    faces = np.concatenate([s.faces + np.uint32(at) for s, at in placed])
    ends = [at + end for s, at in placed for end in s.solids or (len(s.vertices),)]
    return Surface(vertices, faces, surfaces[0].colour, tuple(ends))


def body_surface(body: Body, colour: tuple[int, int, int]) -> Surface:
    """Triangles of a body in its link's frame; sharp edges have their own vertices."""
    if body.shape == "sphere":
        vertices, faces = _ball(body.size[0])
    elif body.shape == "cylinder":
        vertices, faces = _drum(*body.size)
    else:
        vertices, faces = _box(np.array(body.size))
    return Surface(moved(body.pose, vertices), faces.astype(np.uint32), colour)


def _ball(radius: float) -> tuple[Array, NDArray[np.int64]]:
    polar, turn = np.meshgrid(
        np.linspace(0, np.pi, AROUND // 2 + 1), np.linspace(0, 2 * np.pi, AROUND + 1), indexing="ij"
    )
    across = np.sin(polar)
    grid = np.stack([across * np.cos(turn), across * np.sin(turn), np.cos(polar)], axis=-1)
    return radius * grid.reshape(-1, 3), _strips(AROUND // 2, AROUND)


def _strips(rows: int, columns: int) -> NDArray[np.int64]:
    """Triangles of a grid of (rows + 1) by (columns + 1) vertices."""
    r, c = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    a = (r * (columns + 1) + c).ravel()
    b, d = a + 1, a + columns + 1
    return np.concatenate([np.stack([a, d, b], axis=1), np.stack([b, d, d + 1], axis=1)])


def _drum(radius: float, length: float) -> tuple[Array, NDArray[np.int64]]:
    angle = np.linspace(0, 2 * np.pi, AROUND + 1)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    low, high = (np.c_[rim, np.full(len(rim), z)] for z in (length / 2, -length / 2))
    vertices = [np.concatenate([low, high])]
    faces = [_strips(1, AROUND)]
    for ring, flip in ((low, False), (high, True)):
        at = sum(len(v) for v in vertices)
        k = np.arange(AROUND)
        fan = np.stack([np.full(AROUND, at), at + 1 + k, at + 2 + k], axis=1)
        vertices.append(np.concatenate([[[0.0, 0.0, ring[0, 2]]], ring]))
        faces.append(fan[:, ::-1] if flip else fan)
    return np.concatenate(vertices), np.concatenate(faces)


def _box(size: Array) -> tuple[Array, NDArray[np.int64]]:
    vertices: list[Array] = []
    faces: list[NDArray[np.int64]] = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (1.0, -1.0):
            corners = np.zeros((4, 3))
            corners[:, axis] = side
            corners[:, u] = side * np.array([-1, 1, 1, -1])
            corners[:, v] = [-1, -1, 1, 1]
            at = 4 * len(vertices)
            vertices.append(corners * size / 2)
            faces.append(np.array([[at, at + 1, at + 2], [at, at + 2, at + 3]]))
    return np.concatenate(vertices), np.concatenate(faces)
