"""What no program could do without: the entry, the arctangents, the memory of an answer.

Beside each is our own time of the same work, so that the table can say how far it is from there.
All on one thread but for **two threads**.

* **entry**: a kernel called with no pose: arguments checked, the function found and left.
* **memory**: the arrays of the answers written once, where they have been written before, and
  where the system has never handed them out; all poses of a batch, 8 bytes at a time.
* **two threads**: a batch into the same arrays as before, on two.
* **in the cache**: a batch whose answers fit into a processor's own cache, solved again and again
  into the same arrays.
* **v3**: a batch into the same arrays by the code for processors of level x86-64-v3.
* **arctangents**: as many as the joint values of all solutions need that are no mirror images of
  others, by NumPy, which has them as vector instructions where the processor does.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import dh2urdf._kernels as kernels
import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm, arm_named
from benchmarks.clock import Block, interleaved
from benchmarks.results import Results, Row
from benchmarks.work.processes import child
from dh2urdf import Robot
from dh2urdf.kernels.blocks import OWN
from dh2urdf.kernels.chain import chain_fk_batch
from dh2urdf.kernels.parallel_axes import blocks as parallel
from dh2urdf.kernels.redundant import held_wrist_blocks as held
from dh2urdf.kernels.spherical_wrist import common as wrist

__all__ = ["KEYS", "QUICK", "run"]

Array = NDArray[np.float64]

ANGLES = {
    "puma560": wrist.ANGLES,
    "kuka_kr6_r700": wrist.ANGLES,
    "ur5": parallel.ANGLES,
    "franka_fer": held.ANGLES,
    "kuka_iiwa14": held.ANGLES,
}
"""How the joint values of each arm are found: rows of source, kind, and arms that need it."""

KEYS = tuple(ANGLES)
QUICK = ("puma560", "franka_fer")
MANY = 20_000
CACHED, AGAIN = 1_000, 20
"""Poses whose answers, some 600 bytes each, fit into the cache of one core; how often they are
solved in a turn, since what others do between two turns empties the cache."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """A batch of inverse kinematics, one pose, and a batch of forward kinematics."""
    m = 500 if results.quick else MANY
    for key in keys:
        arm = arm_named(key)
        parts = {**_inverse(arm, m), **_forward(arm, m), **_cached(arm)}
        blocks = {name: _block(call, units) for name, (call, units) in parts.items()}
        budget = 0.3 if results.quick else 4.0
        for name, timing in interleaved(blocks, budget, most=100).items():
            results.add(Row.timed("limit", key, name, timing, size=parts[name][1]))
        if kernels.LEVEL != "v4":
            continue
        found = child("batch", key, str(m), DH2URDF_LEVEL="v3")
        results.add(Row("limit", key, found["level"], found["total"], size=m))


def _block(call: Callable[[], object], units: int) -> Block:
    repeats = max(1, 500 // units)

    def block() -> int:
        for _ in range(repeats):
            call()
        return repeats * units

    return block


def _inverse(arm: Arm, m: int) -> dict[str, tuple[Callable[[], object], int]]:
    """Calls and how many poses each takes."""
    robot = Robot.from_dh(arm.table)
    _, T = arm.draw(m, seed=1)
    asked = {"within_limits": False, "locked": arm.locked}
    room = robot.ik_batch(T, threads=1, **asked)
    kmax, chain = robot.solver_for(locked=arm.locked).kmax, robot.chain
    no_q, no_T = np.empty((0, arm.n)), np.empty((0, 4, 4))
    written = sum(getattr(room, name).nbytes for name in ("q", "residual", "count")) // (8 * m)
    written += 2 * kmax  # codes of branches, masks of free joints
    again = np.empty((m, written))
    own = ANGLES[arm.key][:, 1] == OWN
    y, x = np.random.default_rng(0).normal(size=(2, m, int(ANGLES[arm.key][own, 2].sum())))
    target = np.empty_like(y)

    return {
        "one pose": (lambda: robot.ik(T[0], **asked), 1),
        "entry": (lambda: chain_fk_batch(chain.links, chain.prismatic, no_q, no_T), 1),
        "batch": (lambda: robot.ik_batch(T, threads=1, **asked), m),
        "batch, out": (lambda: robot.ik_batch(T, threads=1, out=room, **asked), m),
        "batch, out, two threads": (lambda: robot.ik_batch(T, threads=2, out=room, **asked), m),
        "memory": (lambda: again.fill(1.0), m),
        "fresh memory": (lambda: np.full((m, written), 1.0), m),
        "arctangents": (lambda: np.arctan2(y, x, out=target), m),
    }


def _cached(arm: Arm) -> dict[str, tuple[Callable[[], object], int]]:
    """A batch whose answers are in the cache already."""
    robot, (_, T) = Robot.from_dh(arm.table), arm.draw(CACHED, seed=1)
    asked: dict[str, Any] = {"within_limits": False, "locked": arm.locked, "threads": 1}
    room = robot.ik_batch(T, **asked)

    def solve() -> None:
        for _ in range(AGAIN):
            robot.ik_batch(T, out=room, **asked)

    return {"in the cache": (solve, AGAIN * CACHED)}


def _forward(arm: Arm, m: int) -> dict[str, tuple[Callable[[], object], int]]:
    """The same of forward kinematics."""
    robot = Robot.from_dh(arm.table)
    q, _ = arm.draw(m)
    again = np.empty((m, 4, 4))
    return {"fk": (lambda: robot.fk(q), m), "fk: memory": (lambda: again.fill(1.0), m)}
