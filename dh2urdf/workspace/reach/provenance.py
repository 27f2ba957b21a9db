"""Where a map came from, as attributes that are read without this package."""

import hashlib
import json
from importlib.metadata import version
from typing import Any

import numpy as np

from dh2urdf.bounds import LENGTH
from dh2urdf.dh import JointType
from dh2urdf.dh_io import table_to_text
from dh2urdf.robot import Robot
from dh2urdf.workspace.reach.dataset import KEY
from dh2urdf.workspace.reach.settings import MapSettings

LAYOUT = 2
"""Number of the layout of stores; it grows when a variable changes its meaning."""


def provenance(robot: Robot, settings: MapSettings) -> dict[str, Any]:
    """Attributes of a map: the arm's table and chain, the package's version, all settings."""
    chain = robot.chain
    arm = {
        "links": chain.links.tolist(),
        "joint_types": [str(kind.value) for kind in chain.joint_types],
        "joint_names": list(chain.names),
        "lower": _finite(chain.lower),
        "upper": _finite(chain.upper),
        **_values(robot),
    }
    return {
        "title": f"Reach of {robot.model.name}, {robot.tip} in {robot.base}",
        "source": f"dh2urdf {version('dh2urdf')}, dh2urdf.workspace.reach_map",
        "robot": robot.model.name,
        "task": settings.task,
        "joint_limits": "kept" if settings.within_limits else "ignored",
        "step": settings.grid.step,
        "table": table_to_text(robot.table, "yaml") if robot.table else "",
        "chain": json.dumps(arm),
        KEY: {
            "layout": LAYOUT,
            "version": version("dh2urdf"),
            "robot": robot.model.name,
            "chain": _digest(json.dumps(arm).encode()),
            "step": settings.grid.step,
            "low": list(settings.grid.low),
            "shape": list(settings.grid.shape),
            "orientations": list(settings.turns.shape[:2]),
            "rotations": _digest(settings.turns.tobytes()),
            "task": settings.task,
            "within_limits": settings.within_limits,
            "each": settings.each,
            "refine": settings.refine,
            "block": settings.side,
        },
    }


def _values(robot: Robot) -> dict[str, Any]:
    """The values of q of an arm whose joints move together: ``joints = matrix @ q + offset``."""
    if robot.coupling is None:
        return {}
    kinds = (JointType.PRISMATIC if slides else JointType.REVOLUTE for slides in robot.slides)
    return {
        "value_types": [str(kind.value) for kind in kinds],
        "value_names": list(robot.joint_names),
        "value_lower": _finite(robot.lower),
        "value_upper": _finite(robot.upper),
        "matrix": robot.coupling.matrix.tolist(),
        "offset": robot.coupling.offset.tolist(),
    }


def _finite(bounds: Any) -> list[float | None]:
    """Numbers as JSON knows them."""
    return [float(b) if np.isfinite(b) and abs(b) < LENGTH else None for b in bounds]


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]
