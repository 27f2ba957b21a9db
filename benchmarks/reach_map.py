"""Maps of the reach: what they cost, in memory, time and workers, each in a process of its own.

``python -m benchmarks.reach_map`` prints all; ``python -m benchmarks.reach_map ur5e denso`` some.

- ``ur5e``: voxels of 2.5 cm from -0.95 to 0.95 m, 200 orientations, 88 million poses; twice.
- ``denso``: 10 million poses of the Denso, and `ik_batch` alone on the same poses (``bare``).
- ``workers``: one worker process of Dask, then two, threads of this process; the bits of all.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.apart import ROOT

UR5E = ["ur5e", "--step", "0.025", "--region=-.95,.95,-.95,.95,-.95,.95", "--orientations", "200"]
DENSO = ["denso_vs6556", "--step", "0.03", "--orientations", "64"]
"""54 x 54 x 54 voxels: 10.08 million poses."""

CALL = {"step": 0.03, "orientations": 64}


def command(arguments: list[str], folder: Path, name: str) -> tuple[float, float, float]:
    """Seconds, processor seconds and peak memory [MB] of ``dh2urdf map``."""
    return timed([sys.executable, "-m", "dh2urdf", "map", *arguments, "-o", str(folder / name)])


def timed(argv: list[str]) -> tuple[float, float, float]:
    """Seconds, processor seconds and peak memory [MB] of a process."""
    begin = time.perf_counter()
    process = subprocess.Popen(argv, cwd=ROOT)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(argv)}: status {process.returncode}")
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3


def digest(folder: Path) -> str:
    """Of all files of a store."""
    seen = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        seen.update(str(path.relative_to(folder)).encode() + path.read_bytes())
    return seen.hexdigest()[:16]


def ur5e(folder: Path) -> None:
    """One command, twice."""
    for name in ("first.zarr", "second.zarr"):
        seconds, work, memory = command(UR5E, folder, name)
        size = sum(p.stat().st_size for p in (folder / name).rglob("*") if p.is_file())
        print(
            f"ur5e, 87.8 million poses: {seconds:.1f} s ({work:.1f} s of processors), peak "
            f"{memory:.0f} MB, store {size / 1e6:.1f} MB, files {digest(folder / name)}"
        )


def denso(folder: Path) -> None:
    """The map and `ik_batch` alone on the same poses, as commands and within them."""
    seconds, work, memory = command(DENSO, folder, "denso.zarr")
    whole, bare_work, bare_memory = timed([sys.executable, "-m", "benchmarks.reach_map", "bare"])
    print(
        f"denso, 10.08 million poses: {seconds:.2f} s ({work:.2f} s of processors), peak "
        f"{memory:.0f} MB; a process with ik_batch alone {whole:.2f} s ({bare_work:.2f} s), "
        f"{bare_memory:.0f} MB: {100 * whole / seconds:.0f} % of its rate"
    )
    from dh2urdf import Robot
    from dh2urdf.workspace import reach_map

    robot = Robot.from_dh("denso_vs6556")
    reach_map(robot, step=0.3, orientations=64)
    begin = time.perf_counter()
    reach_map(robot, **CALL)
    inside, alone = time.perf_counter() - begin, bare_seconds()
    print(
        f"without start and store: {inside:.2f} s, ik_batch {alone:.2f} s: "
        f"{100 * alone / inside:.0f} % of its rate"
    )


def bare(_: Path) -> None:
    """`ik_batch` alone on the Denso's poses."""
    print(f"ik_batch alone: {bare_seconds():.2f} s")


def bare_seconds() -> float:
    """Seconds in `ik_batch` on the poses of the Denso's map, in pieces into the same arrays."""
    from dh2urdf import Robot
    from dh2urdf.transforms import pose
    from dh2urdf.workspace.reach.settings import settings_of

    robot = Robot.from_dh("denso_vs6556")
    settings = settings_of(robot, **CALL, region=None, within_limits=True, each=False, refine=0)
    points = settings.grid.points((slice(None),) * 3)
    turns, piece, seconds, chunk = settings.turns[:, 0], None, 0.0, 1000
    for start in range(0, len(points), chunk):
        Ts = pose(turns, points[start : start + chunk, None]).reshape(-1, 4, 4)
        begin = time.perf_counter()
        piece = robot.ik_batch(Ts, out=piece if len(Ts) == chunk * len(turns) else None)
        seconds += time.perf_counter() - begin
    return seconds


def workers(folder: Path) -> None:
    """Worker processes of one thread each, on this machine."""
    from dask.distributed import Client, LocalCluster

    from dh2urdf import Robot
    from dh2urdf.workspace import reach_map

    robot, times = Robot.from_dh("ur5e"), {}
    given = {"step": 0.04, "orientations": 200, "region": [[-0.96, 0.96]] * 3}
    for count in (1, 2):
        with (
            LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None) as cluster,
            Client(cluster) as client,
        ):
            client.wait_for_workers(count)
            reach_map(robot, step=0.4, orientations=200, client=client)  # each has built the robot
            begin = time.perf_counter()
            reach_map(robot, **given, client=client, store=folder / f"{count}.zarr")
            times[count] = time.perf_counter() - begin
    same = digest(folder / "1.zarr") == digest(folder / "2.zarr")
    print(
        f"ur5e, 22.1 million poses: one worker {times[1]:.2f} s, two {times[2]:.2f} s, "
        f"{times[1] / times[2]:.2f} times as fast; {'the same' if same else 'OTHER'} bits"
    )
    begin = time.perf_counter()
    reach_map(robot, **given, store=folder / "threads.zarr")
    seconds = time.perf_counter() - begin
    same = digest(folder / "1.zarr") == digest(folder / "threads.zarr")
    print(f"threads of one process: {seconds:.2f} s; {'the same' if same else 'OTHER'} bits")


CASES = {"ur5e": ur5e, "denso": denso, "workers": workers}
ALL = {**CASES, "bare": bare}


def main() -> None:
    """Print each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", help=f"of {', '.join(CASES)}; default: all")
    for name in parser.parse_args().cases or CASES:
        with TemporaryDirectory() as folder:
            ALL[name](Path(folder))


if __name__ == "__main__":
    main()
