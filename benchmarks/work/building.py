"""Building a solver for an arm, kernels compiled and packages imported.

Where it takes seconds it is timed once, in :mod:`benchmarks.work.inverse`, and not here.
"""

from __future__ import annotations

from benchmarks.arms import ARMS, Arm, arm_named
from benchmarks.clock import Block, interleaved
from benchmarks.contestant import IKContestant, NotCoveredError
from benchmarks.peers import contestants
from benchmarks.results import Results, Row

__all__ = ["KEYS", "QUICK", "run"]

KEYS = tuple(arm.key for arm in ARMS)
QUICK = ("puma560", "ur5")


def run(results: Results, keys: tuple[str, ...]) -> None:
    """Construction alone; ours includes the robot, its model and its first solution."""
    for arm in map(arm_named, keys):
        quick = (c for c in contestants(arm, results, slow=False))
        blocks = {c.name: _block(type(c), arm) for c in quick}
        for name, timing in interleaved(blocks, 0.1 if results.quick else 3.0, most=20).items():
            results.add(Row.timed("build", arm.key, name, timing))


def _block(cls: type[IKContestant], arm: Arm) -> Block:
    def block() -> int:
        try:
            cls(arm)
        except NotCoveredError:
            raise AssertionError(f"{cls.name} took {arm.key} before") from None
        return 1

    return block
