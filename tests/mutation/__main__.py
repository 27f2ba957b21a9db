"""Wrong changes, and whether tests see them: ``python -m tests.mutation ROOM DIRECTORY``.

Rooms are kernels, certificates and converters. Each of some changes, drawn by ``--seed`` from all
that there are, is made in a copy of the package, and the tests that reach its line run until one
fails: the directory is that of a run of ``tests.marked`` with ``-p tests.marked.each``.
``again`` makes those anew that survived and are seen since by a test that was added, and runs it.
``--record`` adds the outcomes to ``runs.csv`` and writes the table of ``README.md``; what is there
is not tried again, so that a run can be gone on with.
"""

import argparse
import csv
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from dh2urdf.translate.build import PLACE
from tests.marked.__main__ import copied
from tests.mutation.reach import FIRST, Reach
from tests.mutation.sites import Site, changed, sites

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
RUNS, PAGE, MARK = HERE / "runs.csv", HERE / "README.md", "<!-- runs -->\n"

ROOMS = {
    "kernels": "dh2urdf/kernels",
    "certificates": "dh2urdf/kernels/certificate",
    "converters": "dh2urdf/conversions",
}

PYTEST = ["-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "tests.mutation.limits"]

USAGE, NOTHING = 4, 5
"""How pytest ends where a test is not there, and where none is."""

BROKEN = "ERROR collecting", "ImportError while loading"
"""What it says where a module of tests, which a change may break, cannot be imported."""

SINCE, SAME = "seen since by ", "the same: "
"""How reasons begin of what survived: a test was added, or the program does the same."""


@cache
def every(room: str) -> list[tuple[str, Site]]:
    """All changes of a room, by files."""
    return [
        (str(path.relative_to(ROOT)), site)
        for path in sorted((ROOT / ROOMS[room]).rglob("*.py"))
        if path.name not in ("shapes.py", "__init__.py")
        for site in sites(path.read_text())
    ]


def drawn(room: str, count: int, seed: int) -> list[tuple[str, Site]]:
    """Changes of a room, each as likely as another."""
    return random.Random(seed).sample(every(room), count)


def outcome(place: Path, tests: list[str], file: str, site: Site) -> str:
    """By what a change was seen, ``survived``, or ``none`` for one that is no program."""
    path = place / file
    text = path.read_text()
    path.write_text(changed(text, site))
    try:
        if "/kernels/" in file and run(place, "-m", "tests.mutation.compiled"):
            return "none"
        golden = [test for test in tests if test.startswith(FIRST)]
        for how, some in {"answers": golden, "tests": tests[len(golden) :]}.items():
            (place / "some.txt").write_text("\n".join(some))
            if not some:
                continue
            status, said = run(place, *PYTEST, "@some.txt"), (place / "said.txt").read_text()
            if status == NOTHING or (status == USAGE and not any(x in said for x in BROKEN)):
                raise ValueError(f"tests that are not there: {said[-1000:]}")
            if status:
                return "time" if status == -signal.SIGPROF else how
        return "survived"
    finally:
        path.write_text(text)


def passes(place: Path, reach: Reach) -> bool:
    """Whether some quick tests pass unchanged."""
    some = sorted(reach.seconds, key=lambda test: reach.seconds[test])[::20]
    (place / "some.txt").write_text("\n".join(some[:100]))
    return run(place, *PYTEST, "@some.txt") == 0


def run(place: Path, *words: str) -> int:
    """The status of Python with the changed package; what it says is kept there."""
    keys = {"PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
    with (place / "said.txt").open("w") as said:
        return subprocess.run(
            [sys.executable, "-W", "ignore", *words],
            cwd=place,
            env=os.environ | keys,
            stdout=said,
            stderr=subprocess.STDOUT,
            check=False,
        ).returncode


def kept() -> list[list[str]]:
    """Outcomes that were recorded: room, seed, file, line, column, old, new, outcome, reason."""
    with RUNS.open(newline="") as file:
        return list(csv.reader(file))


def page() -> str:
    """The table, and the changes that survived."""
    rows = kept()
    names = "seen by answers", "by tests", "by time", "survived", "seen since", "the same", "left"
    shares = "share of all", "of those that differ", "of these when drawn"
    lines = [f"| room | changes | {' | '.join([*names, *shares])} |"]
    lines.append("| - |" + " -: |" * (1 + len(names) + len(shares)))
    for room in ROOMS:
        found = [row for row in rows if row[0] == room and row[7] != "none"]
        if found:
            how = Counter(row[7] for row in found)
            why = [row[8] for row in found if row[7] == "survived"]
            since, same = (sum(x.startswith(word) for x in why) for word in (SINCE, SAME))
            counts = [how[key] for key in ("answers", "tests", "time", "survived")]
            left = how["survived"] - since - same
            differ = max(len(found) - same, 1)
            rates = [(same + left) / len(found), left / differ, (since + left) / differ]
            cells = [room, len(found), *counts, since, same, left, *(f"{x:.1%}" for x in rates)]
            lines.append(f"| {' | '.join(map(str, cells))} |")
    lines += ["", "| survived | was | became | why |", "| - | - | - | - |"]
    for _, _, file, line, _, old, new, how, why in rows:
        if how == "survived":
            cells = (f"`{' '.join(x.split())[:60]}`".replace("|", "\\|") for x in (old, new))
            lines.append(f"| `{file}:{line}` | {' | '.join(cells)} | {why} |")
    return "\n".join([*lines, ""])


def again(place: Path) -> Iterator[str]:
    """Make changes again that tests were added for: those that they still do not see."""
    for _, _, file, line, _, old, new, how, why in kept():
        if how != "survived" or not why.startswith(SINCE):
            continue
        alike = [s for s in sites((ROOT / file).read_text()) if (s.old, s.new) == (old, new)]
        if not alike:
            print(f"is no more: {file}:{line}: {old!r}", flush=True)
            continue
        site = min(alike, key=lambda s: abs(s.line - int(line)))
        seen = outcome(place, re.findall("`(.+?)`", why), file, site)
        print(f"{seen}: {file}:{site.line}: {old!r} -> {new!r}", flush=True)
        if seen in ("survived", "none"):
            yield file


def main() -> int:
    """Draw changes, and tell what became of them."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("room", choices=[*ROOMS, "again"])
    parser.add_argument("marks", type=Path, metavar="DIRECTORY", nargs="?")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--record", action="store_true")
    asked = parser.parse_args()
    with TemporaryDirectory() as folder:
        place = Path(folder)
        copied(place)
        shutil.copy2(PLACE, place / "dh2urdf")
        if asked.room == "again":
            return int(any([*again(place)]))
        if asked.marks is None:
            parser.error("the directory of a run of tests.marked")
        room, ends, reach = asked.room, Counter[str](), Reach(asked.marks)
        known = {tuple(row[:7]) for row in kept()} if asked.record else set()
        begun = any(row[:2] == (room, str(asked.seed)) for row in known)
        if not begun and not passes(place, reach):
            print("unchanged, some tests fail", (place / "said.txt").read_text(), file=sys.stderr)
            return 2
        for file, site in drawn(room, asked.count, asked.seed):
            if (room, str(asked.seed), file, *map(str, site)) in known:
                continue
            begin, tests = time.monotonic(), reach.of(file, site.line)
            how = outcome(place, tests, file, site)
            ends[how] += 1
            took = time.monotonic() - begin
            said = (place / "said.txt").read_text().splitlines()[-2:] if tests else []
            print(f"{how}: {file}:{site.line}: {site.old!r} -> {site.new!r}; {took:.0f} s,", end="")
            print(f" {len(tests)} tests", *said, sep="\n    ", flush=True)
            if asked.record:
                row = [room, asked.seed, file, site.line, site.column, site.old, site.new, how, ""]
                with RUNS.open("a", newline="") as out:
                    csv.writer(out).writerow(row)
    print(dict(ends))
    if asked.record:
        PAGE.write_text(PAGE.read_text().partition(MARK)[0] + MARK + page())
    return 0


if __name__ == "__main__":
    sys.exit(main())
