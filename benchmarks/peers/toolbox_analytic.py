"""robotics-toolbox-python's analytic solver: all solutions by equations that SymPy derives.

The derivation takes seconds an arm and is done once a process; the solver evaluates it in Python,
and writes it as C, which is compiled here as its own header says, with optimisation.
"""

from __future__ import annotations

import ctypes
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from roboticstoolbox import DHRobot, RevoluteDH
from spatialmath import SE3

from benchmarks.arms import Arm, arm_named
from benchmarks.contestant import BatchContestant, IKContestant, NotCoveredError
from dh2urdf import DHConvention

__all__ = ["ToolboxAnalytic", "ToolboxC"]

Array = NDArray[np.float64]

ACCURACY = 1e-6
"""Error of a pose up to which the generated C takes a solution; its own default in Python."""

MOST = 64
"""Rows that the generated C may write for a pose."""

MANY = """
void many(const double *T, long m, double *q, int *count) {
    for (long i = 0; i < m; i++) {
        count[i] = 0;
        ikine(T + 16 * i, %r, (double (*)[6])(q + 6 * %d * i), count + i);
    }
}
"""
"""A loop over poses, beside what was generated."""


LONGEST = 45.0
"""Processor time [s] that a derivation may take: those that end take a third of it."""


class TooLongError(BaseException):
    """A derivation that has not come to an end; nothing in between catches it."""


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Raise TooLongError when this process has worked for so long."""

    def stop(number: int, frame: object) -> None:
        raise TooLongError

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)


def derived(key: str) -> tuple[Any, float]:
    """The solver of an arm and the seconds that its derivation took."""
    solver, seconds, reason = _derived(key)
    if reason:
        raise NotCoveredError(reason)
    return solver, seconds


@cache
def _derived(key: str) -> tuple[Any, float, str]:
    """The same, or the reason why there is none."""
    table = arm_named(key).table
    if len(table.rows) != 6 or table.convention is not DHConvention.STANDARD:
        return None, 0.0, "six joints in a standard table only"
    links = [
        RevoluteDH(d=row.d, a=row.a, alpha=row.alpha, offset=row.theta, flip=row.sign < 0)
        for row in table.rows
    ]
    base, tool = (SE3(T.matrix, check=False) for T in (table.base, table.tool))
    start = time.perf_counter()
    try:
        with at_most(LONGEST):
            solver = DHRobot(links, name=key, base=base, tool=tool).analytic_ik()
    except (ImportError, ValueError) as error:  # without SymPy; of arms for which it finds none
        return None, 0.0, str(error).splitlines()[0]
    except TooLongError:
        return None, 0.0, f"no derivation within {LONGEST:.0f} s of the processor"
    return solver, time.perf_counter() - start, ""


class ToolboxAnalytic(IKContestant):
    """``DHRobot.analytic_ik().solve`` without limits."""

    name = "roboticstoolbox analytic"
    distribution = "roboticstoolbox-python"

    def __init__(self, arm: Arm) -> None:
        self.solver, self.seconds_to_build = derived(arm.key)

    def solve(self, pose: Array) -> Any:
        return self.solver.solve(pose, joint_limits=False)

    def array(self, answer: Any) -> Array:
        return np.asarray(answer.q).reshape(-1, 6)


class ToolboxC(BatchContestant):
    """What ``generate("c")`` writes, compiled: one pose a call, or a loop over poses."""

    name = "roboticstoolbox C"
    distribution = "roboticstoolbox-python"
    flags: ClassVar[tuple[str, ...]] = ("-O3", "-march=native", "-shared", "-fPIC")

    def __init__(self, arm: Arm) -> None:
        compiler = shutil.which("gcc") or shutil.which("cc")
        if compiler is None:
            raise NotCoveredError("no C compiler")
        solver, seconds = derived(arm.key)
        start = time.perf_counter()
        with TemporaryDirectory() as folder:
            source, library = Path(folder, "arm.c"), Path(folder, "arm.so")
            source.write_text(solver.generate("c") + MANY % (ACCURACY, MOST))
            command = [compiler, *self.flags, "-w", str(source), "-o", str(library), "-lm"]
            subprocess.run(command, check=True)
            self.many = ctypes.CDLL(str(library)).many
        self.seconds_to_build = seconds + time.perf_counter() - start
        self.many.argtypes = [ctypes.c_void_p, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
        self.many.restype = None
        self.T_dh_base = np.linalg.inv(arm.table.base.matrix)
        self.T_tool_dh = np.linalg.inv(arm.table.tool.matrix)
        self.q, self.count = np.empty((1, MOST, 6)), np.empty(1, np.int32)
        self.room = self.q.ctypes.data, self.count.ctypes.data
        self.batch = self.q, self.count

    def encode(self, Ts: Array) -> Sequence[Any]:
        poses = self.encode_batch(Ts)
        return [(T.ctypes.data, poses) for T in poses]

    def solve(self, pose: Any) -> Any:
        """One pose by its address, as C takes it, into memory that is there."""
        self.many(pose[0], 1, *self.room)
        return self.q[0, : self.count[0]]

    def array(self, answer: Any) -> Array:
        return np.array(answer)

    def encode_batch(self, Ts: Array) -> Array:
        return np.ascontiguousarray(self.T_dh_base @ Ts @ self.T_tool_dh)

    def solve_batch(self, poses: Array, threads: int) -> Any:
        """In as many pieces as threads, into the memory of an earlier batch of this size."""
        if len(self.batch[1]) != len(poses):
            self.batch = np.empty((len(poses), MOST, 6)), np.empty(len(poses), np.int32)
        parts = [rows for rows in np.array_split(np.arange(len(poses)), threads) if len(rows)]

        def work(rows: Any) -> None:
            T, q, count = (x[rows[0] :].ctypes.data for x in (poses, *self.batch))
            self.many(T, len(rows), q, count)

        if threads == 1:
            work(parts[0])
        else:
            with ThreadPoolExecutor(threads) as pool:
                list(pool.map(work, parts))
        return self.batch

    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        return [q[:k].copy() for q, k in zip(*answer, strict=True)]
