"""What is said beside the result, on stderr: notes, and how far long work has come."""

import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

T = TypeVar("T")

PATIENCE = 0.5
"""Seconds before the bar appears."""

QUIET, EVERY = 2.0, 5.0
"""Seconds before the first line in a log, and from one to the next."""


def note(text: str) -> None:
    """Anything that is not the result, on stderr; where that takes nothing, nowhere."""
    try:
        sys.stderr.write(text.rstrip("\n") + "\n")
        sys.stderr.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)


def track(items: Sequence[T], what: str) -> Iterator[T]:
    """Yield the items, telling on stderr how many are done where the work is long."""
    with bar(what, len(items)) as report:
        for done, item in enumerate(items, 1):
            yield item
            report(done, len(items))


@contextmanager
def bar(what: str, total: int) -> Iterator[Callable[[int, int], None]]:
    """A function to call with the number done and the total; on a terminal it draws a bar."""
    start = time.monotonic()
    if not sys.stderr.isatty():
        due, before = start + QUIET, -1

        def tell(done: int, total: int) -> None:
            nonlocal due, before
            now = time.monotonic()
            before = min(done - 1, before) if before >= 0 else done - 1
            if done < total and now >= due:
                due = now + EVERY
                left = (total - done) * (now - start) / (done - before)
                note(f"{what}: {done} of {total}, {left:.0f} s left")

        yield tell
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True, auto_refresh=False) as progress:
        task = progress.add_task(what, total=total, visible=False)

        def report(done: int, total: int) -> None:
            late = time.monotonic() - start > PATIENCE
            progress.update(task, completed=done, total=total, visible=late)
            if late:
                progress.refresh()

        yield report
