"""Robot descriptions: URDF, xacro, MJCF, typed axes."""

import re
from pathlib import Path
from unittest.mock import patch

import numpy as np
from hostile import outcome

from dh2urdf import DHTable, Robot, extract_dh
from dh2urdf.bounds import LENGTH
from dh2urdf.checks import check_urdf
from dh2urdf.conversions.read import apart
from dh2urdf.exceptions import Dh2UrdfError
from tests.fuzz.door import Door
from tests.fuzz.reader import forked
from tests.fuzz.shapes import AXES, URDFS, XACROS

SECONDS = 0.4
"""Time of a reader, of which most files need a hundredth."""


def read_urdf(data: bytes, folder: Path) -> None:
    """A file is built, extracted and checked or refused; what is built agrees with itself."""
    path = folder / "arm.urdf"
    path.write_bytes(data)
    robot = outcome(Robot.from_urdf, path)
    found = outcome(extract_dh, path, embedded=False)
    outcome(extract_dh, path)
    outcome(check_urdf, path)
    path.unlink()
    if isinstance(robot, Robot):
        q = np.clip(robot.random_configuration(0), -3, 3)
        np.testing.assert_allclose(robot.fk(q[None])[0], robot.fk(q), rtol=1e-9, atol=1e-9)
    if not isinstance(found, Dh2UrdfError):
        assert found.max_error <= 1e-9 * max(1.0, found.table.length)


def extract(suffix: str):
    """A file of a suffix is extracted or refused, and nothing is left of its reader."""

    def enter(data: bytes, folder: Path) -> None:
        path = folder / f"arm{suffix}"
        path.write_bytes(data)
        quick = patch.object(apart, "APART_SECONDS", SECONDS)
        with patch.object(apart.subprocess, "run", forked), quick:
            found = outcome(extract_dh, path)
        path.unlink()
        if not isinstance(found, Dh2UrdfError):
            assert isinstance(found.table, DHTable)
            far = farthest(data) if suffix == ".yaml" else 0.0
            assert found.max_error <= 1e-9 * max(1.0, found.table.length, far)

    return enter


def farthest(data: bytes) -> float:
    """The largest number up to the bound of lengths: typed points are as far as their rounding."""
    numbers = map(float, re.findall(rb"\d+\.?\d*(?:[eE][-+]?\d+)?", data))
    return max((x for x in numbers if x <= LENGTH), default=0.0)


DOORS = [
    Door("urdf", read_urdf, ("robots",), shaped=URDFS),
    Door("xacro", extract(".xacro"), ("robots", "xacro"), shaped=XACROS),
    Door("mjcf", extract(".xml"), ("robots", "mjcf")),
    Door("axes", extract(".yaml"), ("axes",), shaped=AXES),
]
