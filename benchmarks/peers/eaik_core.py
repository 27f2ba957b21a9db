"""EAIK's core without Python: its source distribution, compiled and called in a loop in C++.

``pip download --no-deps --no-binary eaik eaik`` brings it, Debian's libeigen3-dev what it needs.
Its subproblems are those of ik-geo in C++.
"""

from __future__ import annotations

import ctypes
import subprocess
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import Arm

__all__ = ["eaik_core", "loop_of"]

Array = NDArray[np.float64]

PLACES = ("src", "src/IK", "src/IK/utils", "src/utils", "external/ik-geo/cpp/subproblems")


def eaik_core(source: Path, eigen: Path, library: Path) -> ctypes.CDLL:
    """The core of an unpacked source distribution, compiled with -O2 as a library once."""
    inner = source / "CPP"
    places = [f"-I{path}" for path in (eigen, *(inner / place for place in PLACES))]
    parts = [str(path) for path in sorted(inner.rglob("*.cpp"))]
    loop = str(Path(__file__).with_suffix(".cpp"))
    command = ["g++", "-std=c++17", "-O2", "-shared", "-fPIC", "-w", *places, loop, *parts]
    if not library.exists():
        subprocess.run([*command, "-o", str(library)], check=True)
    core = ctypes.CDLL(str(library))
    core.make.restype = ctypes.c_void_p
    core.many.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p]
    return core


def loop_of(core: ctypes.CDLL, arm: Arm, Ts: Array) -> Callable[[], int]:
    """All solutions of poses Ts (m, 4, 4) of an arm; how many these are."""
    axes, points, tool = referee.zero_frames(arm.table)
    steps = np.diff(np.vstack([np.zeros(3), *points, tool[:3, 3]]), axis=0)
    given = [np.ascontiguousarray(x, float) for x in (axes.T, steps.T, tool[:3, :3])]
    robot = core.make(*(ctypes.c_void_p(x.ctypes.data) for x in given), len(axes))
    poses = np.ascontiguousarray(Ts)
    many = partial(core.many, robot, len(poses), poses.ctypes.data)
    many.kept = poses  # type: ignore[attr-defined]
    return many
