"""Forward kinematics: one configuration a call, and many at once."""

from __future__ import annotations

import numpy as np

from benchmarks import referee
from benchmarks.arms import Arm, arm_named
from benchmarks.clock import Block, each, interleaved
from benchmarks.contestant import FKContestant
from benchmarks.marker import at_work
from benchmarks.peers.forward import forward_contestants
from benchmarks.results import Results, Row

__all__ = ["KEYS", "QUICK", "run"]

KEYS = ("ur5", "kuka_kr6_r700", "franka_fer")
"""Arms that most peers know."""

QUICK = KEYS[:1]
MANY = 100_000


def run(results: Results, keys: tuple[str, ...]) -> None:
    """FK of these arms."""
    for key in keys:
        arm = arm_named(key)
        contestants = [c for c in forward_contestants(arm, results) if _right(c, arm)]
        _single(results, arm, contestants)
        _batch(results, arm, contestants)


def _right(contestant: FKContestant, arm: Arm) -> bool:
    """Compare with the referee before anything is timed."""
    q, T = arm.draw(100, seed=1)
    found = [contestant.to_poses(contestant.one(v)) for v in contestant.encode(q)]
    error = referee.residuals(np.array(found), T).max()
    if error > 1e-9:
        raise AssertionError(f"{contestant.name} differs from the referee by {error:.2g}")
    return True


def _single(results: Results, arm: Arm, contestants: list[FKContestant]) -> None:
    q, _ = arm.draw(500)
    blocks = {c.name: each(c.one, list(c.encode(q))) for c in contestants if c.one}
    timings = interleaved(blocks, 0.2 if results.quick else 6.0, most=400)
    for name, timing in timings.items():
        results.add(Row.timed("fk one", arm.key, name, timing, size=1))


def _batch(results: Results, arm: Arm, contestants: list[FKContestant]) -> None:
    m = 10_000 if results.quick else MANY
    q, T = arm.draw(m)
    blocks: dict[str, Block] = {}
    errors = {}
    for c in contestants:
        if c.many is None:
            continue
        at_work(c.name)
        found = c.to_poses(c.many(q))
        errors[c.name] = float(referee.residuals(found, T).max())

        def block(c: FKContestant = c) -> int:
            c.many(q)
            return m

        blocks[c.name] = block
    for name, timing in interleaved(blocks, 0.2 if results.quick else 10.0, most=25).items():
        results.add(Row.timed("fk batch", arm.key, name, timing, residual=errors[name]))
