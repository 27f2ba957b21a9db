"""What the time of a call is made of: entry into a kernel, the kernel, the answer's memory."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numba import njit
from numpy.typing import NDArray

from benchmarks.arms import arm_named
from benchmarks.clock import Block, interleaved
from benchmarks.results import Results, Row
from dh2urdf import Robot

__all__ = ["KEYS", "QUICK", "run"]

Array = NDArray[np.float64]

KEYS = QUICK = ("puma560", "ur5")
MANY = 64
"""Poses of the batch that is set against the single pose."""


@njit
def _empty(a, b, c, d, e, f, g, h, i, j, k):  # type: ignore[no-untyped-def]
    """A kernel that does nothing with ten arrays and a flag."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """The single call of the closed forms, and forward kinematics of the last arm."""
    for key in keys:
        _add(results, key, _inverse_parts(key))
    _add(results, keys[-1], _forward_parts(keys[-1]))


def _add(results: Results, key: str, parts: dict[str, tuple[Callable[[], object], int]]) -> None:
    blocks = {name: _block(call, units) for name, (call, units) in parts.items()}
    for name, timing in interleaved(blocks, 0.2 if results.quick else 3.0, most=400).items():
        results.add(Row.timed("breakdown", key, name, timing, size=parts[name][1]))


def _block(call: Callable[[], object], units: int) -> Block:
    repeats = max(1, 64 // units)

    def block() -> int:
        for _ in range(repeats):
            call()
        return repeats * units

    return block


def _outputs(m: int, kmax: int, n: int) -> tuple[NDArray[np.generic], ...]:
    """Arrays as ``Solver.solve_batch`` fills them."""
    codes = np.zeros((2, m, kmax), np.int64)
    return (
        np.empty((m, kmax, n)),
        np.empty((m, kmax)),
        np.empty(m, np.int64),
        codes[0],
        codes[1],
    )


def _inverse_parts(key: str) -> dict[str, tuple[Callable[[], object], int]]:
    arm = arm_named(key)
    robot = Robot.from_dh(arm.table)
    _, T = arm.draw(MANY)
    solver = robot.solver
    one, many = (_outputs(m, solver.kmax, arm.n) for m in (1, MANY))
    single = T[:1].copy()
    arrays = [single] * 5 + list(one)
    return {
        "robot.ik": (lambda: robot.ik(T[0], within_limits=False), 1),
        "solver, one pose": (lambda: solver.solve_batch(single, False, *one), 1),
        "entry into an empty kernel": (lambda: _empty(*arrays, False), 1),
        "arrays of the answer": (lambda: _outputs(1, solver.kmax, arm.n), 1),
        "solver, a pose of many": (lambda: solver.solve_batch(T, False, *many), MANY),
    }


def _forward_parts(key: str) -> dict[str, tuple[Callable[[], object], int]]:
    arm = arm_named(key)
    robot = Robot.from_dh(arm.table)
    m = 10_000
    q, _ = arm.draw(m)
    return {
        "robot.fk, a configuration of many": (lambda: robot.fk(q), m),
        "cosines and sines by NumPy": (lambda: (np.cos(q), np.sin(q)), m),
        "filling the poses": (lambda: np.full((m, 4, 4), 1.0), m),
    }
