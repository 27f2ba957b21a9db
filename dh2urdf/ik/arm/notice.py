"""The wait for kernels that compile: a word to the user, and no garbage collection meanwhile."""

import gc
import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 2.0
"""Seconds of silence: loading from the cache takes less, compiling takes more."""

logger = logging.getLogger("dh2urdf")

_one_at_a_time = threading.Lock()


@contextmanager
def notice_if_slow() -> Iterator[None]:
    """Log one warning if the block takes longer than kernels from the cache would.

    A block inside another, or beside one in another thread, adds nothing. The garbage collector
    rests: the compiler makes millions of objects that live on, which it would walk over each time.
    """
    if not _one_at_a_time.acquire(blocking=False):
        yield
        return
    message = "compiling the kernels, once per installation; this takes some ten seconds"
    timer = threading.Timer(PATIENCE, logger.warning, [message])
    timer.daemon = True
    timer.start()
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()
        timer.cancel()
        _one_at_a_time.release()
