"""A robot as data, for other processes; each builds it once."""

import pickle
import threading
from functools import lru_cache

from dh2urdf.robot.robot import Robot

_one_at_a_time = threading.Lock()


def packed(robot: Robot) -> bytes:
    """A robot as bytes that :func:`unpacked` of the same version of the package takes."""
    return pickle.dumps(robot, pickle.HIGHEST_PROTOCOL)


def unpacked(data: bytes) -> Robot:
    """The robot of bytes, the same object for all threads of a process."""
    with _one_at_a_time:
        return _built(data)


@lru_cache(maxsize=8)
def _built(data: bytes) -> Robot:
    robot: Robot = pickle.loads(data)
    return robot
