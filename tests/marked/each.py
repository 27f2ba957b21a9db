"""A plugin (``-p tests.marked.each``): which statements each test marks, and how long it takes.

Added to ``each.jsonl`` beside the file of marks, a line a test. Tests that run at once would mix:
no ``-n``.
"""

import json
import mmap
import os
import time
from pathlib import Path

import numpy as np
import pytest

from tests.marked.written import KINDS

FILE = Path(os.environ["KERNEL_MARKS"])


class _Marks:
    """The file of marks, and what was there."""

    def __init__(self) -> None:
        with FILE.open("r+b") as file:
            self.bytes = mmap.mmap(file.fileno(), 0)
        self.now = np.frombuffer(self.bytes, np.uint8).reshape(-1, KINDS)
        self.all = self.now.copy()
        self.now[:] = 0


_marks = _Marks()
_failed = set[str]()


def pytest_runtest_logreport(report):
    """Keep what failed."""
    if report.failed:
        _failed.add(report.nodeid)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """A test with its fixtures: those of more than one test count for the first."""
    begin = time.process_time()
    yield
    reached = np.flatnonzero(_marks.now[:, 0]).tolist()
    _marks.all |= _marks.now
    _marks.now[:] = 0
    row = {"test": item.nodeid, "seconds": time.process_time() - begin, "reached": reached}
    row["passed"] = item.nodeid not in _failed
    with FILE.with_name("each.jsonl").open("a") as file:
        file.write(json.dumps(row) + "\n")
    return True


def pytest_sessionfinish():
    """Put back what all have marked."""
    _marks.now[:] = _marks.all
