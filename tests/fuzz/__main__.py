"""Try the doors: ``python -m tests.fuzz [DOOR...] [--inputs N] [--seed S] [--random]``.

By properties, by plain random edits, which is quicker, or guided by coverage for so many seconds
with ``--guided``; what breaks a door goes to its corpus. With
``--record`` the run is added to ``runs.csv``, from which the table in ``README.md`` is written.
"""

import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile
import time
import traceback
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "helpers"))

from tests.fuzz.door import Door  # noqa: E402
from tests.fuzz.doors import DOORS  # noqa: E402
from tests.fuzz.drive import at_random, attempt, keep, properties  # noqa: E402

RUNS, PAGE = HERE / "runs.csv", HERE / "README.md"
MARK = "<!-- runs -->\n"

WAYS = "properties", "random", "coverage"

Drive = Callable[[Door, int, int], int]


def by_inputs(name: str, drive: Drive, inputs: int, seed: int) -> tuple[int, str]:
    """Inputs tried and how the first broke."""
    door = DOORS[name]
    try:
        for data in door.starts:
            attempt(door, data)
        return drive(door, inputs, seed), ""
    except Exception as error:
        traceback.print_exc()
        found = getattr(error, "smallest", None)
        which = "one it begins with" if found is None else keep(name, found).name
        return 0, f"{which}: {type(error).__name__}: {error!s:.200}"


def by_coverage(name: str, seconds: int, seed: int) -> tuple[int, str]:
    """Inputs that libFuzzer tried, and what it says of those that broke."""
    with tempfile.TemporaryDirectory() as place:
        for k, data in enumerate(DOORS[name].starts):
            (Path(place) / f"start-{k}").write_bytes(data)
        options = ["-timeout=0", "-rss_limit_mb=3000", "-max_len=20000"]
        options += [f"-max_total_time={seconds}", f"-seed={seed + 1}"]
        command = [sys.executable, "-m", "tests.fuzz.guided", name, place, *options]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    done = re.search(r"Done (\d+) runs", run.stderr)
    broken = "; ".join(line for line in run.stdout.splitlines() if line.startswith("BROKEN"))
    return (int(done[1]), broken) if done else (0, f"{broken} {run.stderr[-2000:]}")


def record(row: tuple[object, ...]) -> None:
    """Add a run, and write the table anew."""
    with RUNS.open("a", newline="") as file:
        csv.writer(file).writerow(row)
    page = PAGE.read_text().partition(MARK)[0]
    PAGE.write_text(page + MARK + table())


def kept() -> list[list[str]]:
    """The runs that were recorded."""
    with RUNS.open(newline="") as file:
        return list(csv.reader(file))


def table() -> str:
    """Inputs, seeds and times of each door."""
    inputs, seconds = defaultdict[tuple[str, str], int](int), defaultdict[str, float](float)
    seeds = defaultdict[str, set[int]](set)
    runs = {(name, way, seed): (count, took) for name, way, count, seed, took in kept()}
    for (name, way, seed), (count, took) in runs.items():  # the last of those that are the same
        inputs[name, way] += int(count)
        seconds[name] += float(took)
        if way != "coverage":
            seeds[name].add(int(seed))
    lines = [
        "| door | by properties | at random | seeds | by coverage | minutes | corpus |",
        "| - | -: | -: | - | -: | -: | -: |",
    ]
    for name, door in DOORS.items():
        properly, at_random, guided = (inputs[name, way] for way in WAYS)
        lines.append(
            f"| {name} | {properly:,} | {at_random:,} | {stretches(seeds[name])} | {guided:,} | "
            f"{seconds[name] / 60:.1f} | {len(door.starts)} |"
        )
    total = sum(inputs.values())
    return (
        "\n".join([*lines, "", f"{total:,} inputs in {sum(seconds.values()) / 60:.0f} minutes."])
        + "\n"
    )


def stretches(numbers: set[int]) -> str:
    """Numbers, of which those that follow each other are written by their ends."""
    ends: list[list[int]] = []
    for number in sorted(numbers):
        if ends and ends[-1][1] == number - 1:
            ends[-1][1] = number
        else:
            ends.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in ends)


def processor() -> float:
    """Time of the processor that this process and those that it began have had [s]."""
    spent = os.times()
    return sum(spent[:4])


def main() -> int:
    """Run the doors; 1 where one broke."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
    parser.add_argument("doors", nargs="*", choices=[*DOORS, []], metavar="DOOR")
    parser.add_argument("--inputs", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--random", action="store_true")
    parser.add_argument("--guided", type=int, metavar="SECONDS")
    parser.add_argument("--record", action="store_true")
    asked = parser.parse_args()
    broke = False
    for name in asked.doors or DOORS:
        start, worked = time.monotonic(), processor()
        if asked.guided:
            count, fault = by_coverage(name, asked.guided, asked.seed)
        else:
            drive = at_random if asked.random else properties
            count, fault = by_inputs(name, drive, asked.inputs, asked.seed)
        took, each = time.monotonic() - start, 1e3 * (processor() - worked) / max(count, 1)
        said = f"{count:,} inputs in {took:.0f} s, {each:.1f} ms of the processor each"
        print(f"{name}: {said}{fault and ': ' + fault}", flush=True)
        broke = broke or bool(fault)
        if asked.record and count:
            way = "coverage" if asked.guided else "random" if asked.random else "properties"
            record((name, way, count, asked.seed, round(took, 1)))
    return int(broke)


if __name__ == "__main__":
    sys.exit(main())
