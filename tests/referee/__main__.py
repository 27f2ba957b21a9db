"""The referee's sweep: ``python -m tests.referee [CLASS...] [--arms N] [--poses M] [--seed S]``.

Arms that ship and random ones of each class are asked for all solutions of random poses, by the
code for this processor or, with ``DH2URDF_LEVEL``, for another. A search of NumPy alone, from
random starts, tells solutions of its own, each of which has to be among them, as has the
configuration that made the pose; each solution is measured on the product of the table.
``--record`` adds the figures to ``runs.csv``, from which the table of ``README.md`` is written.
Ends with 1 where something was lost or wrong.
"""

import argparse
import csv
import math
import sys
import time
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "helpers"))

from ik_referee import forward  # noqa: E402
from sweep import LEAST, MOST, REGULAR, ROUNDING, Tally, contains, judge_arm, smallest  # noqa: E402

import dh2urdf  # noqa: E402
from benchmarks.machine import commit, describe, versions  # noqa: E402
from dh2urdf.chain import CoupledChain, coupling_of  # noqa: E402
from dh2urdf.exceptions import NoSolverError  # noqa: E402
from dh2urdf.ik.arm import Task, spare_joints  # noqa: E402
from tests.referee import tasks  # noqa: E402
from tests.referee.arms import CLASSES, shipped, table_of  # noqa: E402
from tests.referee.search import search, starts  # noqa: E402
from tests.referee.tasks import TASKS  # noqa: E402

RUNS, PAGE, MARK = HERE / "runs.csv", HERE / "README.md", "<!-- runs -->\n"

FAULTS = ("regular lost", "search lost", "wrong", "twice", "no answer", "no family")
"""What must not be."""

COLUMNS = {
    "arms": "arms",
    "poses": "poses",
    "solutions": "solutions",
    "searched": "by the search",
    "search lost": "of them lost",
    "regular lost": "lost, regular",
    "singular": "singular poses",
    "singular lost": "lost there",
    "wrong": "wrong",
    "twice": "twice",
    "refused": "arms that the referee has no chain for",
}


def tables(name: str, arms: int, seed: int) -> Iterator[dh2urdf.DHTable]:
    """The arms of a class."""
    if name == "shipped":
        yield from shipped()
        return
    for k in range(arms):
        yield table_of(name, seed * 1_000_000 + k)


def sweep(name: str, arms: int, poses: int, begins: int, seed: int) -> Tally:
    """The figures of a class."""
    tally = Tally(name)
    for k, table in enumerate(tables(name, arms, seed)):
        try:
            if name in TASKS:
                tasks.one_arm(tally, table, name, poses, begins, [seed, k])
            else:
                one_arm(tally, table, poses, begins, [seed, k])
        except NoSolverError:
            tally.count["refused"] += 1
    return tally


def one_arm(tally: Tally, table: dh2urdf.DHTable, poses: int, begins: int, seed: list[int]) -> None:
    """Judge an arm; one joint is held of an arm that has one to spare."""
    robot = dh2urdf.Robot.from_dh(table)
    coupling, chain = coupling_of(table, robot.chain), robot.chain
    if coupling is not None:
        chain = CoupledChain.of(robot.chain, coupling)
    held = list(range(0 if robot.is_coupled else spare_joints(chain, Task.POSE)))
    rng = np.random.default_rng(seed)
    q = rng.uniform(-math.pi, math.pi, (poses, robot.n))
    q[:, chain.prismatic] *= 0.3 / math.pi
    kept: list[Any] = []

    def solve(Ts: np.ndarray) -> Any:
        locked = {joint: q[:, joint] for joint in held}
        kept.append(robot.ik_batch(Ts, within_limits=False, locked=locked or None))
        return kept[0]

    judge_arm(tally, (table, chain), q, solve, held)
    tally.count["arms"] += 1
    moving = np.isin(np.arange(robot.n), held, invert=True)
    for i, T in enumerate(np.ascontiguousarray(forward(chain, q))):
        batch = SimpleNamespace(found=kept[0].q[i, : kept[0].count[i]], T=T)
        batch.masks = kept[0].free_mask[i, : kept[0].count[i]]
        tally.count["solutions"] += len(batch.found)
        own = search(chain, T, starts(chain, q[i], begins, moving, seed[1] + i), moving)
        compare(tally, (table, chain), batch, own, moving)


def compare(tally: Tally, named: Any, batch: Any, own: np.ndarray, moving: np.ndarray) -> None:
    """Count what the search found and the solver did not."""
    table, chain = named
    sigma = smallest(chain, own, moving) if len(own) else np.zeros(0)
    for p, least in zip(own, sigma.tolist(), strict=True):
        if least < REGULAR:  # as exact as a search is there
            continue
        tally.count["searched"] += 1
        tolerance = float(np.clip(ROUNDING / least, 1e2 * LEAST, MOST))
        if not contains(chain, batch.found, batch.masks, p, batch.T, tolerance, moving):
            tally.note("search lost", table, p)


def record(tally: Tally, asked: argparse.Namespace, seconds: float) -> None:
    """Add a run and write the table anew; runs of the same class, seed and level are replaced."""
    level = versions()["kernels"].partition(" ")[0]
    made = f"{datetime.now(UTC):%Y-%m-%d}", commit(), describe()["processor"], level
    row = [tally.name, asked.seed, *made, round(seconds, 1)]
    row += [tally.count[key] for key in COLUMNS]
    with RUNS.open("a", newline="") as file:
        csv.writer(file).writerow(row)
    PAGE.write_text(PAGE.read_text().partition(MARK)[0] + MARK + page())


def page() -> str:
    """The table: each class at each level, all its seeds together."""
    with RUNS.open(newline="") as file:
        runs = {(r[0], r[1], r[5]): r for r in csv.reader(file)}
    whole: dict[tuple[str, str], list[list[str]]] = {}
    for (name, _, level), row in runs.items():
        whole.setdefault((level, name), []).append(row)
    lines = []
    for level in sorted({level for level, _ in whole}):
        rows = [r for name in CLASSES for r in whole.get((level, name), [])]
        about = sorted({f"{r[2]}, commit {r[3]}, {r[4]}" for r in rows})
        lines += [f"Level {level} ({'; '.join(about)}):", ""]
        lines += [
            f"| class | {' | '.join(COLUMNS.values())} | s |",
            "| - |" + " -: |" * (len(COLUMNS) + 1),
        ]
        for name in CLASSES:
            if found := whole.get((level, name)):
                sums = [f"{sum(int(r[7 + k]) for r in found):,}" for k in range(len(COLUMNS))]
                seconds = sum(float(r[6]) for r in found)
                lines.append(f"| {name} | {' | '.join(sums)} | {seconds:.0f} |")
        lines.append("")
    return "\n".join(lines)


def main() -> int:
    """Sweep, and say what was lost."""
    parser = argparse.ArgumentParser(prog="python -m tests.referee", description=__doc__)
    parser.add_argument("classes", nargs="*", choices=[*CLASSES, []], metavar="CLASS")
    parser.add_argument("--arms", type=int, default=20)
    parser.add_argument("--poses", type=int, default=2)
    parser.add_argument("--starts", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true")
    asked = parser.parse_args()
    broke = False
    for name in asked.classes or CLASSES:
        begin = time.perf_counter()
        tally = sweep(name, asked.arms, asked.poses, asked.starts, asked.seed)
        seconds = time.perf_counter() - begin
        faults = [note for note in tally.notes if note.startswith(FAULTS)]
        told = ", ".join(f"{tally.count[key]} {key}" for key in COLUMNS)
        print(f"{name}: {told}; {seconds:.0f} s", flush=True)
        print(*faults, sep="\n" * bool(faults), end="\n" * bool(faults), flush=True)
        broke = broke or bool(faults)
        if asked.record:
            record(tally, asked, seconds)
    return int(broke)


if __name__ == "__main__":
    sys.exit(main())
