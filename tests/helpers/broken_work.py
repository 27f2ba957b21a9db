"""A piece of benchmark work in which one contestant breaks, for the tests of what follows."""

import os
import signal
import time

from benchmarks.marker import at_work
from benchmarks.results import Row


def run(results, keys):
    """Contestants ``good`` and ``bad``; the keys say who is bad, and how it breaks."""
    name, way = keys
    results.add(Row("w", "a", "good", 1.0))
    if name in results.excluded:
        return
    at_work(name)
    if way == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if way == "hang":
        time.sleep(60)
    raise RuntimeError("no such arm")
