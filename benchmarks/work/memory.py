"""Memory of a batch: growth of a fresh process while it solves, beside its output arrays."""

from __future__ import annotations

from benchmarks.arms import arm_named
from benchmarks.contestant import BatchContestant
from benchmarks.peers import contestants
from benchmarks.results import Results, Row
from benchmarks.work.processes import child

__all__ = ["run"]

ARMS = ("puma560", "ur5")


def run(results: Results) -> None:
    """All batch solvers on the closed-form arms."""
    m = 20_000 if results.quick else 200_000
    for key in ARMS[:1] if results.quick else ARMS:
        for c in contestants(arm_named(key), results.left_out):
            if isinstance(c, BatchContestant):
                found = child("memory", key, c.name, str(m))
                results.add(Row("memory", key, c.name, size=m, threads=2, extra=found))
