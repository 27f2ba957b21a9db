"""``python -m benchmarks``: run, or render what a run found."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from benchmarks import machine
from benchmarks.results import LATEST, Results

WORK = (
    "forward",
    "inverse",
    "edges",
    "building",
    "breakdown",
    "scaling",
    "sweep",
    "memory",
    "processes",
)


def main() -> int:
    """Parse the arguments and do it."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="small and short: does it all run?")
    parser.add_argument("--only", help=f"some of: {','.join(WORK)}")
    parser.add_argument(
        "--out",
        type=Path,
        default=None,
        help="results file; default: latest.json, quick.json or partial.json beside it",
    )
    parser.add_argument("--render", action="store_true", help="table and plot from the results")
    given = parser.parse_args()
    if given.render:
        from benchmarks.render import render

        render(given.out or LATEST)
        return 0
    chosen = given.only.split(",") if given.only else WORK
    if unknown := set(chosen) - set(WORK):
        parser.error(f"no work named {', '.join(sorted(unknown))}; there are {', '.join(WORK)}")
    name = "quick.json" if given.quick else "partial.json" if given.only else LATEST.name
    out = given.out or LATEST.with_name(name)
    results = run(chosen, quick=given.quick)
    results.save(out)
    print(f"{len(results.rows)} rows in {results.about['seconds']} s: {out}")
    return 0


def run(chosen: tuple[str, ...] | list[str], *, quick: bool) -> Results:
    """Do the chosen work, in the order of :data:`WORK`."""
    from importlib import import_module

    results = Results(quick)
    start, before = time.perf_counter(), machine.load_average()
    for name in WORK:
        if name in chosen:
            begin = time.perf_counter()
            import_module(f"benchmarks.work.{name}").run(results)
            print(f"{name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    results.describe(time.perf_counter() - start, [before, machine.load_average()])
    return results


if __name__ == "__main__":
    sys.exit(main())
