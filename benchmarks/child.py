"""What has to be measured in a process of its own; prints one JSON object.

``python -m benchmarks.child imports dh2urdf`` and so on; called by ``benchmarks.apart``,
``benchmarks.work.processes`` and ``benchmarks.work.memory``.
"""

from __future__ import annotations

import importlib
import json
import sys
import time
from pathlib import Path

__all__: list[str] = []


def imports(module: str) -> dict[str, object]:
    """Seconds to import a module after NumPy; heavy packages that came with it."""
    importlib.import_module("numpy")
    start, worked = time.perf_counter(), time.process_time()
    importlib.import_module(module)
    seconds, processor = time.perf_counter() - start, time.process_time() - worked
    heavy = [m for m in ("pinocchio", "matplotlib", "scipy", "sympy") if m in sys.modules]
    return {"total": seconds, "processor": processor, "loaded": heavy}


def first(key: str) -> dict[str, object]:
    """Seconds from nothing to a robot, and to its first solutions; processor time of it all."""
    start = time.perf_counter()
    from benchmarks.arms import arm_named

    arm = arm_named(key)
    T = arm.draw(1)[1][0]
    drawn = time.perf_counter()
    from dh2urdf import Robot

    robot = Robot.from_dh(arm.table)
    built = time.perf_counter()
    robot.ik(T, within_limits=False, locked=arm.locked)
    solved = time.perf_counter()
    return {
        "robot": built - drawn,
        "ik": solved - built,
        "total": solved - start,
        "processor": time.process_time(),
    }


def memory(key: str, contestant: str, poses: str) -> dict[str, object]:
    """Growth of the process's peak while a batch is solved, per pose, and its output arrays."""
    import numpy as np

    from benchmarks.arms import arm_named
    from benchmarks.contestant import BatchContestant
    from benchmarks.peers import contestants
    from benchmarks.results import Results

    arm = arm_named(key)
    (own,) = contestants(arm, Results(), only=contestant)
    assert isinstance(own, BatchContestant)
    _, T = arm.draw(int(poses))
    own.solve_batch(own.encode_batch(T[:1000]), own.threads[-1])
    native = own.encode_batch(T)
    Path("/proc/self/clear_refs").write_text("5")
    before = _peak()
    answer = own.solve_batch(native, own.threads[-1])
    after = _peak()
    parts = [getattr(answer, name, None) for name in OUTPUTS]
    arrays = sum(a.nbytes for a in parts if isinstance(a, np.ndarray))
    return {"bytes": (after - before) / int(poses), "arrays": arrays / int(poses)}


def batch(key: str, poses: str) -> dict[str, object]:
    """Seconds a pose of a batch on one thread, into arrays that are there; of which level."""
    import dh2urdf._kernels as kernels
    import numpy as np

    from benchmarks.arms import arm_named
    from dh2urdf import Robot

    arm = arm_named(key)
    robot, (_, T) = Robot.from_dh(arm.table), arm.draw(int(poses), seed=1)
    asked = {"within_limits": False, "locked": arm.locked, "threads": 1}
    room, seconds = robot.ik_batch(T, **asked), []
    for _ in range(40):
        start = time.perf_counter()
        robot.ik_batch(T, out=room, **asked)
        seconds.append((time.perf_counter() - start) / len(T))
    return {"total": float(np.median(seconds)), "level": kernels.LEVEL}


OUTPUTS = ("q", "residual", "count", "branch_code", "free_mask", "joints", "n_solutions")
"""Arrays of answers, ours and py-ikgeo's."""


def work(module: str, folder: str) -> dict[str, object]:
    """A piece of work; its rows go to a file in the folder."""
    from benchmarks.apart import do_here

    do_here(module, Path(folder))
    return {}


def _peak() -> int:
    """Largest resident size since it was last reset, in bytes."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM"))


if __name__ == "__main__":
    task, *arguments = sys.argv[1:]
    tasks = {"imports": imports, "first": first, "memory": memory, "batch": batch, "work": work}
    print(json.dumps(tasks[task](*arguments)))
