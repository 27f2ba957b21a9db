"""``python -m benchmarks``: run, or render what a run found."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from benchmarks.apart import do_apart
from benchmarks.machine import Watch, worked
from benchmarks.results import LATEST, Results

WORK = (
    "forward",
    "inverse",
    "edges",
    "building",
    "breakdown",
    "limits",
    "cores",
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
    about = results.about
    print(f"{len(results.rows)} rows in {about['seconds']} s: {out}")
    print(f"others used {about['others']} cores" + (", too much" if results.busy else ""))
    for what, why in results.failed.items():
        print(f"failed: {what}: {why}", file=sys.stderr)
    return 1 if results.failed else 0


def run(chosen: tuple[str, ...] | list[str], *, quick: bool) -> Results:
    """Do the chosen work, in the order of :data:`WORK`."""
    os.environ.setdefault("DH2URDF_ENGINE", "compiled")  # no figure of kernels that are not
    results, watch = Results(quick), Watch()
    for name in WORK:
        for keys in _parts(name, quick) if name in chosen else ():
            begin, processor = time.perf_counter(), worked()
            if wrong := do_apart(results, f"benchmarks.work.{name}", keys):
                results.failed[f"{name} {' '.join(keys)}"] = wrong
            seconds, processor = time.perf_counter() - begin, worked() - processor
            spent = f"{seconds:.0f} s, {processor:.0f} s of the processor"
            print(f"{name} {' '.join(keys)}: {spent}", file=sys.stderr)
    results.describe(watch)
    return results


def _parts(name: str, quick: bool) -> Iterator[tuple[str, ...]]:
    """What is done in one process: one arm or task, all of them in the short run."""
    work = import_module(f"benchmarks.work.{name}")
    if quick:
        yield work.QUICK
    else:
        yield from ((key,) for key in work.KEYS)


if __name__ == "__main__":
    sys.exit(main())
