"""The arms that are solved, the class that each stands for, and the poses asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks import referee
from dh2urdf import DHRow, DHTable, Robot, extract_dh, load_table

__all__ = ["ARMS", "FAMILIES", "Arm", "arm_named"]

Array = NDArray[np.float64]

FAMILIES = (
    "spherical wrist",
    "three parallel axes",
    "calibrated",
    "five joints",
    "non-Pieper 6R",
    "any 6R",
    "7R, one held",
    "7R, no wrist",
)
"""Classes in the order in which tables show them."""


@dataclass(frozen=True)
class Arm:
    """One arm: a shipped table or one of ``benchmarks/arms``, and the joint held in a 7R arm."""

    key: str
    family: str
    held: tuple[int, float] | None = None

    @cached_property
    def table(self) -> DHTable:
        """The DH table, in metres and radians; a row a joint, as the peers take it."""
        own = Path(__file__).parent / "arms" / f"{self.key}.yaml"
        table = load_table(own if own.exists() else self.key)
        if all(row.is_joint for row in table.rows):
            return table
        rows = extract_dh(Robot.from_dh(table).chain, compact=False).table
        return replace(rows, name=self.key, source=table.source)

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.table.rows)

    @property
    def locked(self) -> dict[int, float] | None:
        """The held joint as ``Robot.ik`` takes it."""
        return dict([self.held]) if self.held else None

    def draw(self, m: int, seed: int = 0) -> tuple[Array, Array]:
        """Random configurations (m, n) within limits and one turn, and their poses (m, 4, 4)."""
        low = np.array([max(r.lower if r.lower is not None else -np.pi, -np.pi) for r in self.rows])
        high = np.array([min(r.upper if r.upper is not None else np.pi, np.pi) for r in self.rows])
        q = np.random.default_rng(seed).uniform(low, high, (m, self.n))
        if self.held:
            q[:, self.held[0]] = self.held[1]
        return q, np.ascontiguousarray(referee.fk(self.table, q))

    @property
    def rows(self) -> tuple[DHRow, ...]:
        """Rows of the table."""
        return self.table.rows


ARMS = (
    Arm("puma560", "spherical wrist"),
    Arm("kuka_kr6_r700", "spherical wrist"),
    Arm("ur5", "three parallel axes"),
    Arm("ur5e_calibrated", "calibrated"),
    Arm("so101", "five joints"),
    Arm("fanuc_crx10ia", "non-Pieper 6R"),
    Arm("jaco2_urdf", "non-Pieper 6R"),
    Arm("xarm6_urdf", "non-Pieper 6R"),
    Arm("abb_gofa5", "non-Pieper 6R"),
    Arm("generic_6r", "any 6R"),
    Arm("franka_fer", "7R, one held", held=(6, 0.5)),
    Arm("kuka_iiwa14", "7R, one held", held=(2, 0.4)),
    Arm("flexiv_rizon4", "7R, no wrist", held=(2, 0.4)),
)


def arm_named(key: str) -> Arm:
    """The arm of :data:`ARMS` with this key."""
    return next(arm for arm in ARMS if arm.key == key)
