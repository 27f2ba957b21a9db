"""A robot as data, for other processes; each builds it once."""

import pickle
import threading
from functools import lru_cache
from typing import Any

_one_at_a_time = threading.Lock()


def packed(robot: object) -> bytes:
    """A robot as bytes that :func:`unpacked` of the same version of the package takes."""
    return pickle.dumps(robot, pickle.HIGHEST_PROTOCOL)


def unpacked(data: bytes) -> Any:
    """The robot of bytes, the same object for all threads of a process."""
    with _one_at_a_time:
        return _built(data)


@lru_cache(maxsize=8)
def _built(data: bytes) -> Any:
    return pickle.loads(data)
