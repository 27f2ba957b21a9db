"""Floor, lights and the eye."""

import math
from typing import Any

import numpy as np

from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.surfaces import Drawing
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array

FIELD_OF_VIEW = math.radians(38.0)
DIRECTION = np.array([0.80, -1.0, 0.62])
"""From the arm to the eye."""

FILL = (-0.2, -1.0, 0.35)
"""Where the weak light comes from."""

SKY, GROUND = (255, 255, 255), (150, 158, 172)
"""Colours of the light from above and from below."""

DISTANCE = 2.1
"""From the arm to the eye, against the span of the arm as it stands."""


def look_at(client: Any, point: Array, distance: float) -> None:
    """Bring the eye of one visitor nearer to a point, from where it looks now."""
    camera = client.camera
    way = np.asarray(camera.position) - np.asarray(camera.look_at)
    way = way / max(float(np.linalg.norm(way)), 1e-9)
    with client.atomic():
        camera.position = point + distance * way
        camera.look_at = point


def set_stage(
    server: Any, robot: Robot, arm: DrawnArm, drawing: Drawing, q: Array
) -> tuple[Array, float]:
    """Lay the floor under the base and put the eye of new visitors before the arm.

    Returns where the eye looks, shape (3,), and from how far [m].
    """
    points = arm.frames(robot.chain_configuration(q))[:, :3, 3]
    points = np.concatenate([points, np.zeros((1, 3)), robot.fk(q)[None, :3, 3]])
    low, high = points.min(axis=0), points.max(axis=0)
    middle = (low + high) / 2
    span = max(float(np.linalg.norm(high - low)), 0.8 * arm.size)
    lowest = float(min([0.0, *(s.vertices[:, 2].min() for s in drawing.nodes[0].surfaces)]))
    cell = 10.0 ** math.floor(math.log10(max(arm.size, 1e-3) / 3.0))
    sizes = {"cell_size": cell, "section_size": 5.0 * cell, "fade_distance": 5.0 * span}
    colours = {"cell_color": (232, 234, 238), "section_color": (206, 210, 216)}
    style = {"infinite_grid": True, "shadow_opacity": 0.12}
    server.scene.add_grid("/floor", position=(0.0, 0.0, lowest), **sizes, **colours, **style)
    camera = server.initial_camera
    eye = middle + DISTANCE * span * DIRECTION / float(np.linalg.norm(DIRECTION))
    camera.position = eye
    camera.look_at = middle
    camera.fov = FIELD_OF_VIEW
    camera.near = 0.01 * span
    camera.far = 200.0 * span
    return middle, DISTANCE * span


def light(server: Any) -> None:
    """A sun, sky and ground, and a weak light from the side.

    An environment map would delay the first picture: pages fade in only once it is unpacked.
    """
    scene = server.scene
    scene.configure_environment_map(hdri=None)
    scene.configure_default_lights(enabled=True, cast_shadow=False)
    scene.add_light_hemisphere(
        "/light/sky", sky_color=SKY, ground_color=GROUND, intensity=1.7, position=(0.0, 0.0, 1.0)
    )
    scene.add_light_directional("/light/fill", intensity=0.7, position=FILL, cast_shadow=False)


def cast_shadows(server: Any) -> None:
    """Let the sun cast shadows, which without a GPU take longer to draw than all the rest."""
    server.scene.configure_default_lights(enabled=True, cast_shadow=True)
