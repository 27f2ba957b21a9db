"""A batch in chunks, on the threads of a pool that stays.

The calling thread works too. It asks others for help only where there is work for longer than it
takes to wake them: how long a pose takes is measured on the first ones, and where that decides,
on the next ones too, since the first ones wait for memory.
"""

import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from time import perf_counter

from dh2urdf.bounds import THREADS

FIRST = 64
"""Poses that are solved first, and fewest of a chunk."""

WORTH = 1.6e-3
"""Seconds of work for which a thread is woken. That takes a twentieth of it, or more where the
processor is busy or the thread's code has left the caches: with half of it, small batches take
longer than on one thread (``benchmarks.threads --cold``)."""

NEAR = 4.0
"""So many times that are not sure to be it, by poses that waited for memory: half of it is that."""

LONGEST, LARGEST = 2e-3, 2048
"""Most seconds and poses of a chunk: progress and Ctrl-C are prompt, and what it writes is still in
the processor's cache when it is padded."""

_pool: list[ThreadPoolExecutor] = []

if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_pool.clear)  # where its threads do not live on


def _begun(
    work: Callable[[slice], object], m: int, tell: Callable[[int], None]
) -> tuple[int, float]:
    """Work on the first poses of m; how many they were, and the seconds that one took."""
    done, each = 0, 0.0
    while not done or (done == FIRST and 1.0 <= each * (m - done) / WORTH < NEAR):
        rows = slice(done, min(done + FIRST, m))
        begin = perf_counter()
        work(rows)
        done, each = rows.stop, (perf_counter() - begin) / FIRST
        tell(done)
    return done, each


def in_chunks(
    work: Callable[[slice], object], m: int, threads: int | None, tell: Callable[[int], None]
) -> None:
    """Work on all slices of m poses, and tell how many are done; what a thread raises is raised."""
    if not m:
        return
    first, each = _begun(work, m, tell)
    if not (rest := m - first):
        return
    most = os.cpu_count() or 1 if threads is None else threads
    helpers = min(most - 1, int(each * rest / WORTH))
    even = rest // (4 * helpers + 4)
    step = max(FIRST, min(int(LONGEST / each), LARGEST, even if helpers else rest))
    starts, done = iter(range(first, m, step)), [first]  # which threads can share

    def help_out(told: Callable[[int], None]) -> None:
        try:
            for start in starts:
                rows = slice(start, min(start + step, m))
                work(rows)
                done.append(rows.stop - start)
                told(sum(done))
        except BaseException:
            deque(starts, maxlen=0)  # nobody begins another chunk
            raise

    if helpers and not _pool:
        _pool.append(ThreadPoolExecutor(THREADS, "dh2urdf"))
    others = [_pool[0].submit(help_out, lambda _: None) for _ in range(helpers)]
    try:
        help_out(tell)
    finally:
        begun = [other for other in others if not other.cancel()]
        wait(begun)
    for other in begun:
        other.result()
    if begun:
        tell(m)
