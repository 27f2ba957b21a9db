"""Results of a run: rows of figures, and the JSON file that tables and plots are made of."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from benchmarks import machine
from benchmarks.clock import Timing

__all__ = ["LATEST", "Results", "Row"]

SCHEMA = 2
OTHERS = 0.25
"""Cores that other programs may use before the machine counts as busy."""
LATEST = Path(__file__).parent / "results" / "latest.json"
"""The run that the README shows."""


@dataclass(frozen=True)
class Row:
    """One figure of one contestant.

    ``seconds`` (median, with the 10 % and 90 % quantiles ``low`` and ``high``) are per unit:
    a pose, a configuration, a construction, a process. ``processor`` is the median processor
    time of this process per unit, all threads together: a busy machine does not stretch it.
    """

    work: str
    arm: str
    contestant: str
    seconds: float | None = None
    low: float | None = None
    high: float | None = None
    processor: float | None = None
    rounds: int = 0
    size: int = 1
    threads: int = 1
    recall: float | None = None
    wrong: int | None = None
    residual: float | None = None
    extra: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def timed(cls, work: str, arm: str, contestant: str, timing: Timing, **more: Any) -> Row:
        """A row from a timing."""
        return cls(
            work,
            arm,
            contestant,
            timing.median,
            timing.low,
            timing.high,
            timing.processor,
            timing.rounds,
            **{"size": timing.units, **more},
        )


@dataclass
class Results:
    """All rows of one run, and what it ran on.

    ``left_out`` says why a peer or a figure is missing, ``failed`` which work of ours broke, and
    ``excluded`` names the peers that have broken their process.
    """

    quick: bool = False
    rows: list[Row] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)
    excluded: set[str] = field(default_factory=set)
    about: dict[str, Any] = field(default_factory=dict)

    def add(self, row: Row) -> None:
        """Keep a row."""
        self.rows.append(row)

    def include(self, part: Results) -> None:
        """Keep what a part of the work found."""
        self.rows += part.rows
        self.left_out |= part.left_out

    def of(self, work: str, arm: str | None = None) -> Iterator[Row]:
        """Rows of one piece of work."""
        for row in self.rows:
            if row.work == work and arm in (None, row.arm):
                yield row

    @property
    def busy(self) -> bool:
        """Whether other work kept the machine from giving us its time."""
        return bool(self.about["others"] > OTHERS)

    def undisturbed(self) -> Results:
        """The same results with processor time in place of time on the clock.

        Work on two threads is left out: its processor time is that of both. So is the spread,
        which is that of the clock.
        """
        rows = [
            replace(r, seconds=r.processor or r.seconds, low=None, high=None)
            for r in self.rows
            if r.threads == 1 or r.work not in ("ik batch", "scaling")
        ]
        return replace(self, rows=rows)

    def describe(self, watch: machine.Watch) -> None:
        """Write down machine, versions, commit, duration and what others did meanwhile."""
        self.about = {
            "commit": machine.commit(),
            "machine": machine.describe(),
            "versions": machine.versions(),
            "load_average": [watch.load, machine.load_average()],
            "others": round(watch.others(), 2),
            "seconds": round(watch.seconds()),
        }

    def save(self, path: Path) -> None:
        """Write the JSON file."""
        path.parent.mkdir(parents=True, exist_ok=True)
        rows = [{k: v for k, v in asdict(r).items() if v not in (None, {})} for r in self.rows]
        document = {
            "schema": SCHEMA,
            "quick": self.quick,
            **self.about,
            "left_out": self.left_out,
            "failed": self.failed,
            "rows": rows,
        }
        path.write_text(json.dumps(document, indent=1) + "\n")

    @classmethod
    def load(cls, path: Path) -> Results:
        """Read a JSON file."""
        document = json.loads(path.read_text())
        if document.pop("schema") != SCHEMA:
            raise ValueError(f"{path}: another version's results; run the benchmarks again")
        rows = [Row(**row) for row in document.pop("rows")]
        known = {key: document.pop(key) for key in ("quick", "left_out", "failed")}
        return cls(rows=rows, about=document, **known)
