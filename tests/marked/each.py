"""A plugin (``-p tests.marked.each``): which statements each test marks, and how long it takes.

Added to ``each.jsonl`` beside the file of marks, a line a test, with the lines of kernels that it
runs interpreted. Tests that passed there are not run again, so that a run can be gone on with.
Tests that run at once would mix: no ``-n``.
"""

import json
import mmap
import os
import time
from pathlib import Path

import numpy as np
import pytest

from tests.marked.written import KINDS
from tests.translate import probes

FILE = Path(os.environ["KERNEL_MARKS"])
EACH = FILE.with_name("each.jsonl")


class _Marks:
    """The file of marks, and what was there."""

    def __init__(self) -> None:
        with FILE.open("r+b") as file:
            self.bytes = mmap.mmap(file.fileno(), 0)
        self.now = np.frombuffer(self.bytes, np.uint8).reshape(-1, KINDS)
        self.all = self.now.copy()
        self.now[:] = 0

    def taken(self) -> dict[str, list]:
        """What was marked since the last time."""
        lines = probes.reached()
        row = {
            "reached": np.flatnonzero(self.now[:, 0]).tolist(),
            "errors": np.argwhere(self.now[:, 1:]).tolist(),
            "interpreted": [[key.partition(":")[0], n] for key in lines for n in lines[key]],
        }
        self.all |= self.now
        self.now[:] = 0
        probes.forget()
        return row


_marks = _Marks()
_failed = set[str]()


def pytest_collection_modifyitems(config, items):
    """Leave out what an earlier run has told."""
    rows = map(json.loads, EACH.read_text().splitlines()) if EACH.exists() else ()
    known = {row["test"] for row in rows if row["passed"]}
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid in known])
    items[:] = [item for item in items if item.nodeid not in known]
    probes.mark_all()
    _marks.taken()


def pytest_runtest_logreport(report):
    """Keep what failed."""
    if report.failed:
        _failed.add(report.nodeid)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """A test with its fixtures: those of more than one test count for the first."""
    begin = time.process_time()
    yield
    row = {"test": item.nodeid, "seconds": time.process_time() - begin, **_marks.taken()}
    row["passed"] = item.nodeid not in _failed
    with EACH.open("a") as file:
        file.write(json.dumps(row) + "\n")
    return True


def pytest_sessionfinish():
    """Put back what all have marked."""
    _marks.now[:] = _marks.all
