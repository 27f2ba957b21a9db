"""Whose row is compared with whose, and how a figure is written."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from benchmarks.arms import Arm
from benchmarks.peers.ours import OURS
from benchmarks.results import Results, Row

__all__ = [
    "COMPLETE",
    "arm_name",
    "fastest",
    "is_peer",
    "most_threads",
    "own",
    "per_solution",
    "seconds",
    "share",
    "table",
    "times",
]

COMPLETE = 0.9
"""Share of the solutions that a peer has to find to count as a row's fastest."""


def seconds(value: float | None) -> str:
    """A duration with its unit, three digits."""
    if value is None:
        return "–"
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= scale:
            return f"{value / scale:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def times(ratio: float) -> str:
    """How many times, in two digits."""
    if ratio < 0.1:
        return f"1/{1.0 / ratio:.2g} ×" if ratio > 0.01 else f"1/{1.0 / ratio:.0f} ×"
    return f"{ratio:.2g} ×" if ratio < 100 else f"{ratio:.0f} ×"


def share(value: float | None) -> str:
    """A share in percent."""
    return "–" if value is None else f"{100 * value:.4g} %"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A Markdown table."""
    columns = tuple(head)
    lines = [columns, tuple("---" for _ in columns), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def arm_name(arm: Arm) -> str:
    """An arm's name in a table."""
    return arm.key.replace("_urdf", " (URDF)")


def most_threads(results: Results) -> int:
    """Threads of the batches that are shown: of a busy machine there are processor times of one."""
    return 1 if results.busy else 2


def own(rows: Iterable[Row], threads: int | None = None) -> Row | None:
    """Our row."""
    return next((r for r in rows if r.contestant == OURS and threads in (None, r.threads)), None)


def is_peer(row: Row) -> bool:
    """Whether a row is a peer's, and has a time."""
    return row.contestant != OURS and bool(row.seconds)


def fastest(rows: Iterable[Row]) -> Row | None:
    """The fastest row of a peer that finds nearly everything."""
    able = [r for r in rows if is_peer(r) and (r.recall is None or r.recall >= COMPLETE)]
    return min(able, key=lambda r: r.seconds or 0.0, default=None)


def per_solution(row: Row) -> Row:
    """The row with its time for each solution that held."""
    return replace(row, seconds=(row.seconds or 0.0) / max(row.extra["solutions"], 1e-9))
