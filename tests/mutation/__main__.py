"""Wrong changes, and whether tests see them: ``python -m tests.mutation ROOM [--count N]``.

Rooms are kernels, certificates and converters. Each of N changes, drawn by ``--seed`` from all that
there are, is made in a copy of the package: kernels are compiled and asked for the golden answers,
then come the tests of the room, until one fails or takes too long. ``--record`` adds the outcomes
to ``runs.csv`` and writes the table of ``README.md``.
"""

import argparse
import csv
import os
import random
import shutil
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tests.mutation.sites import Site, changed, sites

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
RUNS, PAGE, MARK = HERE / "runs.csv", HERE / "README.md", "<!-- runs -->\n"

SECONDS = 240
"""Time of tests that end by themselves many times sooner."""


class Room(NamedTuple):
    """What is changed, and the tests that are to see it, in the order in which they are run."""

    under: str
    tests: tuple[str, ...]
    compiled: bool = True


ROOMS = {
    "kernels": Room(
        "dh2urdf/kernels", ("tests/kernels", "tests/ik/families", "tests/ik/redundant")
    ),
    "certificates": Room("dh2urdf/kernels/certificate", ("tests/kernels", "tests/ik")),
    "converters": Room(
        "dh2urdf/conversions",
        ("tests/conversions", "tests/robot", "tests/cli", "tests/checks"),
        compiled=False,
    ),
}


def drawn(room: Room, count: int, seed: int) -> list[tuple[str, Site]]:
    """Changes of a room, each as likely as another."""
    every = [
        (str(path.relative_to(ROOT)), site)
        for path in sorted((ROOT / room.under).rglob("*.py"))
        if path.name not in ("shapes.py", "__init__.py")
        for site in sites(path.read_text())
    ]
    return random.Random(seed).sample(every, count)


def copied(place: Path) -> None:
    """The package in a folder of its own, beside the tests as they are."""
    shutil.copytree(ROOT / "dh2urdf", place / "dh2urdf")
    for name in ("tests", "urdf", "docs", "benchmarks", "examples", "pyproject.toml", "README.md"):
        (place / name).symlink_to(ROOT / name)


def outcome(room: Room, place: Path, file: str, site: Site) -> str:
    """By what a change was seen, or ``survived``, or ``none`` for one that is no program."""
    path = place / file
    text = path.read_text()
    path.write_text(changed(text, site))
    try:
        if room.compiled:
            status = run(place, "-m", "tests.mutation.compiled")
            if status:
                return {3: "none", -1: "time"}.get(status, "answers")
        named = sorted(ROOT.rglob(f"tests/**/test_*{path.stem}*.py"))
        first = [str(t.relative_to(ROOT)) for t in named]
        for tests in filter(None, (first, *([t] for t in room.tests))):
            words = ("-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-c", "pyproject.toml")
            status = run(place, *words, *tests)
            if status not in (0, 5):
                return "time" if status == -1 else "tests"
        return "survived"
    finally:
        path.write_text(text)


def run(place: Path, *words: str) -> int:
    """The status of Python with the changed package; -1 where it does not end."""
    keys = {"PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    process = subprocess.Popen(
        [sys.executable, "-W", "ignore", *words],
        cwd=place,
        env={**os.environ, **keys},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    try:
        return process.wait(SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.wait()
        return -1


def kept() -> list[list[str]]:
    """Outcomes that were recorded: room, seed, file, line, column, old, new, outcome, reason."""
    with RUNS.open(newline="") as file:
        return list(csv.reader(file))


def page() -> str:
    """The table, and the changes that survived."""
    rows = kept()
    lines = ["| room | changes | seen by answers | by tests | by time | survived | share |"]
    lines.append("| - |" + " -: |" * 6)
    for room in ROOMS:
        found = Counter(row[7] for row in rows if row[0] == room and row[7] != "none")
        if total := found.total():
            counts = [found[key] for key in ("answers", "tests", "time", "survived")]
            share = f"{found['survived'] / total:.1%}"
            cells = " | ".join(map(str, [total, *counts, share]))
            lines.append(f"| {room} | {cells} |")
    lines += ["", "| survived | was | became | why |", "| - | - | - | - |"]
    for _, _, file, line, _, old, new, how, why in rows:
        if how == "survived":
            cells = (f"`{' '.join(x.split())[:60]}`".replace("|", "\\|") for x in (old, new))
            lines.append(f"| `{file}:{line}` | {' | '.join(cells)} | {why} |")
    return "\n".join([*lines, ""])


def main() -> int:
    """Draw changes, and tell what became of them."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("room", choices=ROOMS)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true")
    asked = parser.parse_args()
    room, ends = ROOMS[asked.room], Counter[str]()
    with TemporaryDirectory() as folder:
        copied(Path(folder))
        for file, site in drawn(room, asked.count, asked.seed):
            begin = time.monotonic()
            how = outcome(room, Path(folder), file, site)
            ends[how] += 1
            took = time.monotonic() - begin
            print(
                f"{how}: {file}:{site.line}: {site.old!r} -> {site.new!r}; {took:.0f} s", flush=True
            )
            if asked.record:
                row = [
                    asked.room,
                    asked.seed,
                    file,
                    site.line,
                    site.column,
                    site.old,
                    site.new,
                    how,
                    "",
                ]
                with RUNS.open("a", newline="") as out:
                    csv.writer(out).writerow(row)
    print(dict(ends))
    if asked.record:
        PAGE.write_text(PAGE.read_text().partition(MARK)[0] + MARK + page())
    return 0


if __name__ == "__main__":
    sys.exit(main())
