"""What the time of a call is made of: entry into a kernel, the kernel, fresh memory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import cycle

import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm, arm_named
from benchmarks.clock import Block, interleaved
from benchmarks.results import Results, Row
from dh2urdf import Robot
from dh2urdf.conversions.write.table_chain import link_frames
from dh2urdf.conversions.write.unfiled_model import table_model
from dh2urdf.ik.arm import HeldSolver, Outputs
from dh2urdf.ik.families.general_6r import plan_general_6r
from dh2urdf.ik.redundant.special_values import HeldAtAnyValue

__all__ = ["KEYS", "QUICK", "run"]

Array = NDArray[np.float64]
Parts = dict[str, tuple[Callable[[], object], int]]
"""Calls by name, and how many poses each takes."""

QUICK = ("puma560", "ur5", "franka_fer")
PLANNED = ("generic_6r", "ur5e_calibrated")
"""Arms of which the general solver tries all eliminations when it is built."""
BUILT = ("so101", "kuka_iiwa14", "flexiv_rizon4")
"""Arms of which it is said what a robot takes, and Pinocchio's model of it."""
KEYS = (*QUICK, *PLANNED, *BUILT)
FRESH = 100_000
"""Poses of the batch whose memory is filled."""

MANY = 64
"""Poses of the batch that is set against the single pose."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """The single call of closed forms, and forward kinematics."""
    for key in keys:
        arm = arm_named(key)
        if key in PLANNED:
            _add(results, key, _planned(arm))
            continue
        if key in BUILT:
            _add(results, key, _built(arm))
            continue
        _add(results, key, _held_parts(arm) if arm.held else _inverse_parts(arm))
        if key == "ur5":
            _add(results, key, _forward_parts(arm))
        if key == "puma560":
            _add(results, key, _table_parts(arm))


def _add(results: Results, key: str, parts: Parts) -> None:
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


def _inverse_parts(arm: Arm) -> Parts:
    robot = Robot.from_dh(arm.table)
    _, T = arm.draw(MANY)
    solver = robot.solver
    none, one, many = (Outputs.of(m, solver.kmax, arm.n) for m in (0, 1, MANY))
    empty, single = T[:0].copy(), T[:1].copy()
    row = sum(a.nbytes for a in one) // 8
    return {
        "robot.ik": (lambda: robot.ik(T[0], within_limits=False), 1),
        "solver, one pose": (lambda: solver.solve_batch(single, False, one), 1),
        "solver, no pose": (lambda: solver.solve_batch(empty, False, none), 1),
        "solver, a pose of many": (lambda: solver.solve_batch(T, False, many), MANY),
        "filling fresh memory of its answer": (lambda: np.full((FRESH, row), 1.0), FRESH),
    }


def _held_parts(arm: Arm) -> Parts:
    """An arm of seven joints whose held one has its value in every pose."""
    robot = Robot.from_dh(arm.table)
    _, T = arm.draw(MANY)
    solver = robot.solver_for(locked=arm.locked)
    assert isinstance(solver, HeldSolver)
    values = np.full((MANY, 1), arm.held[1] if arm.held else 0.0)
    one, many = (Outputs.of(m, solver.kmax, arm.n) for m in (1, MANY))
    return {
        "robot.ik": (lambda: robot.ik(T[0], within_limits=False, locked=arm.locked), 1),
        "solver, one pose": (lambda: solver.solve_held(T[:1], values[:1], False, one), 1),
        "solver, a pose of many": (lambda: solver.solve_held(T, values, False, many), MANY),
    }


def _planned(arm: Arm) -> Parts:
    chain = Robot.from_dh(arm.table).chain
    return {"trying eliminations": (lambda: plan_general_6r(chain.links, chain.prismatic), 1)}


def _table_parts(arm: Arm) -> Parts:
    """A robot of a table that differs by a longer first offset."""
    robot, (first, *others) = Robot.from_dh(arm.table), arm.table.rows
    tables = cycle(
        replace(arm.table, rows=(replace(first, d=first.d + 1e-6 * k), *others))
        for k in range(1, 50)
    )
    frames = link_frames(arm.table)
    return {
        "with_table": (lambda: robot.with_table(next(tables)), 1),
        "Pinocchio model": (lambda: table_model(arm.table, frames), 1),
    }


def _built(arm: Arm) -> Parts:
    frames, solver = link_frames(arm.table), Robot.from_dh(arm.table).solver_for(locked=arm.locked)
    parts: Parts = {
        "robot, no solver": (lambda: Robot.from_dh(arm.table), 1),
        "Pinocchio model": (lambda: table_model(arm.table, frames), 1),
    }
    if isinstance(solver, HeldAtAnyValue):
        inner, task = solver.inner, solver.task
        parts["special values"] = (lambda: HeldAtAnyValue(inner, task).values, 1)
    return parts


def _forward_parts(arm: Arm) -> Parts:
    robot = Robot.from_dh(arm.table)
    m = 10_000
    q, _ = arm.draw(m)
    return {
        "robot.fk, a configuration of many": (lambda: robot.fk(q), m),
        "cosines and sines by NumPy": (lambda: (np.cos(q), np.sin(q)), m),
        "filling the poses": (lambda: np.full((m, 4, 4), 1.0), m),
    }
