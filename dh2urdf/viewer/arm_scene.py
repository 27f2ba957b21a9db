"""The arm in the scene: one node a link, and its ghosts as one batch of meshes a link."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from dh2urdf.drawing.colours import BRANCH_COLOURS, rgb
from dh2urdf.drawing.surfaces import Drawing, Surface
from dh2urdf.transforms import Array

TRANSLUCENT = 0.25
"""Opacity of the arm while a row is explained."""

GHOST_OPACITY = 0.32
"""Opacity of a ghost."""

SLIM = 0.93
"""Size of a ghost's bodies against the arm's, so that coinciding surfaces do not flicker."""

STAGGER = 0.004
"""How much smaller each ghost is than the one before it, for the same reason."""


def quaternions(R: Array) -> Array:
    """Unit quaternions, w first as the scene wants them, of rotations (..., 3, 3).

    The largest of the four components is taken from the diagonal, the others from sums and
    differences across it (Shepperd, "Quaternion from rotation matrix", 1978).
    """
    trace = np.trace(R, axis1=-2, axis2=-1)
    products = np.empty((*R.shape[:-2], 4, 4))  # four times the products of two components
    products[..., 0, 0] = 1 + trace
    products[..., 0, 1:] = R[..., [2, 0, 1], [1, 2, 0]] - R[..., [1, 2, 0], [2, 0, 1]]
    products[..., 1:, 0] = products[..., 0, 1:]
    products[..., 1:, 1:] = R + np.swapaxes(R, -1, -2) + (1 - trace)[..., None, None] * np.eye(3)
    best = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), axis=-1)
    chosen = np.take_along_axis(products, best[..., None, None], axis=-2)[..., 0, :]
    return np.asarray(chosen / np.linalg.norm(chosen, axis=-1, keepdims=True))


def set_poses(handles: Sequence[Any], poses: Array) -> None:
    """Bring handles of the scene to poses (k, 4, 4)."""
    turns = quaternions(poses[:, :3, :3])
    for handle, pose, turn in zip(handles, poses, turns, strict=True):
        handle.wxyz, handle.position = turn, pose[:3, 3]


def add_mesh(server: Any, name: str, surface: Surface, **options: Any) -> Any:
    """A mesh that catches no shadow, under a scene name."""
    vertices = surface.vertices.astype(np.float32)
    options = {"color": surface.colour, "receive_shadow": False} | options
    return server.scene.add_mesh_simple(name, vertices, surface.faces, **options)


class ArmScene:
    """The solid arm."""

    def __init__(self, server: Any, drawing: Drawing) -> None:
        self.server, self.drawing = server, drawing
        numbers = range(len(drawing.nodes))
        self.frames = [server.scene.add_frame(f"/arm/{k}", show_axes=False) for k in numbers]
        self.translucent = False
        self.meshes = [
            add_mesh(server, f"/arm/{k}/{m}", surface, cast_shadow=True, side="front")
            for k, node in enumerate(drawing.nodes)
            for m, surface in enumerate(node.surfaces)
        ]

    def show(self, q: Array) -> None:
        """Place every node at q (n,)."""
        set_poses(self.frames, self.drawing.poses(q))

    def set_translucent(self, on: bool) -> None:
        """See through the arm, or not."""
        if on == self.translucent:
            return
        self.translucent = on
        for mesh in self.meshes:
            mesh.opacity = TRANSLUCENT if on else None
            mesh.cast_shadow = not on

    def remove(self) -> None:
        """Take the arm out of the scene."""
        for handle in [*self.meshes, *self.frames]:
            handle.remove()


class Ghosts:
    """Other configurations of the arm, each in its colour: a batch of instances per link.

    There are ``count`` at most; ``on_click`` is called with the index of one that was clicked.
    """

    def __init__(
        self, server: Any, drawing: Drawing, count: int, on_click: Callable[[int], None]
    ) -> None:
        self.drawing, self.count = drawing, count
        self.moving = [k for k, node in enumerate(drawing.nodes) if k and node.surfaces]
        self.colours = np.resize(np.array([rgb(c) for c in BRANCH_COLOURS], np.uint8), (count, 3))
        self.handles = [self._batch(server, k) for k in self.moving]
        for handle in self.handles:
            handle.on_click(lambda event: on_click(int(event.instance_index or 0)))

    def _batch(self, server: Any, k: int) -> Any:
        surface = self.drawing.nodes[k].slim(SLIM)
        shape = surface.vertices.astype(np.float32), surface.faces
        poses = {
            "batched_wxyzs": np.tile([1.0, 0.0, 0.0, 0.0], (self.count, 1)).astype(np.float32),
            "batched_positions": np.zeros((self.count, 3), np.float32),
            "batched_scales": np.zeros(self.count, np.float32),
        }
        style: Any = {"batched_colors": self.colours, "opacity": GHOST_OPACITY, "lod": "off"}
        style |= dict.fromkeys(("cast_shadow", "receive_shadow", "visible"), False)
        return server.scene.add_batched_meshes_simple(f"/ghosts/{k}", *shape, **poses, **style)

    def show(self, configurations: Sequence[Array], skip: int = -1) -> None:
        """Show ghost k at configuration k; ``skip`` is the one where the arm itself stands."""
        poses = np.tile(np.eye(4), (self.count, len(self.drawing.nodes), 1, 1))
        scales = np.zeros(self.count, np.float32)
        for k, q in enumerate(configurations[: self.count]):
            poses[k] = self.drawing.poses(q)
            scales[k] = 0.0 if k == skip else 1.0 - STAGGER * k
        turns = quaternions(poses[..., :3, :3]).astype(np.float32)
        places = poses[..., :3, 3].astype(np.float32)
        for handle, node in zip(self.handles, self.moving, strict=True):
            handle.batched_scales = scales
            handle.batched_wxyzs = turns[:, node]
            handle.batched_positions = places[:, node]
            handle.visible = bool(scales.any())

    def remove(self) -> None:
        """Take the ghosts out of the scene."""
        for handle in self.handles:
            handle.remove()
