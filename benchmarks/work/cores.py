"""What a second core gives on this machine: two processes at once against one of them.

* **registers**: arithmetic that touches no memory but the processor's first cache, cosines of a few
  numbers again and again, by NumPy.
* **filling memory**: an array that fits into no cache is written again and again.
* **waking**: from when a thread is told to go on until it does, the one that told it going to
  sleep: half of the way there and back.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from multiprocessing import get_context
from threading import Lock, Thread

import numpy as np

from benchmarks.results import Results, Row

__all__ = ["KEYS", "QUICK", "run"]

FEW, MANY = 500, 16_000_000
"""Numbers in an array that stays in the first cache, and in one that no cache holds."""
ROUNDS = 5


def run(results: Results, keys: tuple[str, ...]) -> None:
    """Work of one process and of two at once, and a thread woken by another."""
    seconds = 0.02 if results.quick else 0.4
    for key in keys:
        if key == "waking":
            results.add(Row("cores", "", key, _waking(100 if results.quick else 5_000)))
            continue
        for processes in (1, 2):
            time_of = _at_once(WORK[key], processes, seconds)
            results.add(Row("cores", "", key, time_of, threads=processes))


def _registers() -> Callable[[], object]:
    x, y = np.linspace(0.0, 1.0, FEW), np.empty(FEW)

    def work() -> None:
        for _ in range(100):
            np.cos(x, out=y)

    return work


def _filling() -> Callable[[], object]:
    x = np.full(MANY, 1.0)
    return lambda: x.fill(2.0)


WORK = {"registers": _registers, "filling memory": _filling}
KEYS = QUICK = (*WORK, "waking")


def _at_once(make: Callable[[], Callable[[], object]], processes: int, seconds: float) -> float:
    """Seconds that each of some processes needs for a piece of work, the least of some rounds."""
    context = get_context("fork")
    best = np.inf
    for _ in range(ROUNDS):
        start, told = context.Barrier(processes), context.Queue()
        own = [
            context.Process(target=_repeat, args=(make, seconds, start, told))
            for _ in range(processes)
        ]
        for process in own:
            process.start()
        slowest = max(told.get() for _ in own)
        for process in own:
            process.join()
        best = min(best, slowest / processes)
    return best


def _repeat(make: Callable[[], Callable[[], object]], seconds: float, start, told) -> None:  # type: ignore[no-untyped-def]
    """Work for about so long, all processes at once; tell the mean time of a piece."""
    work, done = make(), 0
    work()
    start.wait()
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds:
        work()
        done += 1
    told.put((time.perf_counter() - begin) / done)


def _waking(times: int) -> float:
    """Seconds until a thread that sleeps goes on: half of the way there and back."""
    there, back = Lock(), Lock()
    there.acquire()
    back.acquire()

    def answer() -> None:
        for _ in range(times):
            there.acquire()
            back.release()

    thread = Thread(target=answer)
    thread.start()
    begin = time.perf_counter()
    for _ in range(times):
        there.release()
        back.acquire()
    thread.join()
    return (time.perf_counter() - begin) / times / 2.0
