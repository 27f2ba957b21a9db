"""Edge poses: stretched arms, straight elbows, wrists at zero; how many solutions come back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks import referee
from benchmarks.arms import arm_named
from benchmarks.peers import contestants
from benchmarks.results import Results, Row

__all__ = ["EDGES", "KEYS", "QUICK", "Edge", "run"]


@dataclass(frozen=True)
class Edge:
    """A configuration [deg] whose pose is asked for, and what is special about it."""

    key: str
    arm: str
    degrees: tuple[float, ...]
    words: str

    @property
    def q(self) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """The configuration in radians."""
        return np.radians(self.degrees)


EDGES = (
    Edge("ur5 home", "ur5", (0, -90, 0, -90, 0, 0), "elbow straight, wrist at zero"),
    Edge("ur5 elbow straight", "ur5", (20, -70, 0, 40, 60, 10), "q3 = 0: two branches merge"),
    Edge("ur5 wrist at zero", "ur5", (20, -70, 60, 40, 0, 10), "q5 = 0: one-parameter family"),
    Edge(
        "puma560 stretched",
        "puma560",
        (20, 30, float(np.degrees(np.arctan2(0.0203, 0.4318))) - 90.0, 40, 50, 60),
        "forearm in line with the upper arm: two branches merge",
    ),
    Edge(
        "puma560 wrist at 1e-6",
        "puma560",
        (20, 30, 40, 40, float(np.degrees(1e-6)), 60),
        "q5 = 1e-6 rad: nearly singular",
    ),
    Edge("puma560 wrist at zero", "puma560", (20, 30, 40, 40, 0, 60), "one-parameter family"),
    Edge("puma560 all zero", "puma560", (0, 0, 0, 0, 0, 0), "wrist at zero, family"),
)


KEYS = QUICK = ("ur5", "puma560")
"""Arms with edge poses."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """Count the exact solutions of each edge pose of these arms."""
    for edge in (e for e in EDGES if e.arm in keys):
        arm = arm_named(edge.arm)
        T = referee.fk(arm.table, edge.q[None])
        for c in contestants(arm, results):
            answer = c.configurations(c.solve(c.encode(T)[0]))
            verdict = referee.judge(arm.table, T, [answer])
            results.add(
                Row(
                    "ik edge",
                    edge.key,
                    c.name,
                    wrong=verdict.wrong,
                    residual=verdict.worst if verdict.claimed > verdict.wrong else None,
                    extra={"solutions": len(verdict.exact[0]), "words": edge.words},
                )
            )
