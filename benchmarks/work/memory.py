"""Memory of a batch: growth of a fresh process while it solves, beside its output arrays."""

from __future__ import annotations

from benchmarks.arms import arm_named
from benchmarks.contestant import BatchContestant
from benchmarks.peers import contestants
from benchmarks.results import Results, Row
from benchmarks.work.processes import child

__all__ = ["KEYS", "QUICK", "run"]

KEYS = ("puma560", "ur5")
QUICK = KEYS[:1]
GIVE_BACK = {"MALLOC_MMAP_THRESHOLD_": "65536"}
"""Environment in which freed arrays go back to the system: none is there to be filled again."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """All batch solvers on the closed-form arms."""
    m = 20_000 if results.quick else 200_000
    for key in keys:
        for c in contestants(arm_named(key), results, slow=False):
            if isinstance(c, BatchContestant):
                found = child("memory", key, c.name, str(m), **GIVE_BACK)
                results.add(Row("memory", key, c.name, size=m, threads=2, extra=found))
