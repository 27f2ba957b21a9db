"""A word to the user while kernels compile for the first time."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager

__all__ = ["notice_if_slow"]

PATIENCE = 2.0
"""Seconds of silence: loading from the cache takes less, compiling takes more."""

logger = logging.getLogger("dh2urdf")


@contextmanager
def notice_if_slow() -> Iterator[None]:
    """Log one warning if the block takes longer than kernels from the cache would."""
    message = "compiling the kernels, once per installation; this takes some ten seconds"
    timer = threading.Timer(PATIENCE, logger.warning, [message])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
