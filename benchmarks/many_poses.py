"""``dh2urdf ik ARM --csv in.csv -o out.csv`` as a shell starts it: seconds and peak memory.

``python -m benchmarks.many_poses ur5 puma560 --poses 100000``; each whole command three times, the
best is printed, beside the processor time of all of its threads.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.apart import ROOT
from benchmarks.arms import arm_named

WAYS = {"all solutions": [], "--best": ["--best"], "--deg": ["--deg"]}


def write_poses(key: str, m: int, path: Path) -> None:
    """Random reachable poses, as entries t00 ... t23."""
    T = arm_named(key).draw(m)[1]
    lines = (",".join(map(repr, row)) for row in T[:, :3].reshape(m, 12).tolist())
    path.write_text("\n".join(lines) + "\n")


def measure(arguments: list[str]) -> tuple[float, float, float]:
    """Seconds, processor seconds and peak memory [MB] of a process."""
    begin = time.perf_counter()
    process = subprocess.Popen(arguments, cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(arguments)}: status {process.returncode}")
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3


def main() -> None:
    """Print a line for each arm and way."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("arms", nargs="*", default=["ur5", "puma560"])
    parser.add_argument("--poses", type=int, default=100_000)
    given = parser.parse_args()
    with TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.csv", Path(folder) / "out.csv"
        for key in given.arms:
            write_poses(key, given.poses, source)
            command = [sys.executable, "-m", "dh2urdf", "ik", key, "--csv", str(source)]
            for way, more in WAYS.items():
                runs = [measure([*command, "-o", str(target), *more]) for _ in range(3)]
                seconds, processor, _ = min(runs)
                peak, size = max(memory for _, _, memory in runs), target.stat().st_size / 1e6
                print(
                    f"{key}, {given.poses} poses, {way}: {seconds:.2f} s, processor "
                    f"{processor:.2f} s, peak {peak:.0f} MB, {size:.0f} MB written"
                )


if __name__ == "__main__":
    main()
