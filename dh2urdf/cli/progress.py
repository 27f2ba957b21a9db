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
    """A function to call with the number done and the total; on a terminal it draws a bar.

    What is left is foretold by the work since the first call: what was done before that took its
    time elsewhere. A call with another total, or with fewer done, begins again.
    """
    start = time.monotonic()
    if not sys.stderr.isatty():
        due, first, last = start + QUIET, (0, start), (0, 0)

        def tell(done: int, total: int) -> None:
            nonlocal due, first, last
            now = time.monotonic()
            if total != last[1] or done < last[0]:
                first = done, now
            last = done, total
            if done < total and now >= due:
                due = now + EVERY
                mine = done - first[0]
                left = f", {(total - done) * (now - first[1]) / mine:.0f} s left" if mine else ""
                note(f"{what}: {done} of {total}{left}")

        yield tell
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True, auto_refresh=False) as progress:
        task = progress.add_task(what, total=total, visible=False)
        told = 0, 0

        def report(done: int, total: int) -> None:
            nonlocal told
            if total != told[1] or done < told[0]:
                progress.reset(task, total=total, completed=done)
            told = done, total
            late = time.monotonic() - start > PATIENCE
            progress.update(task, completed=done, total=total, visible=late)
            if late:
                progress.refresh()

        yield report
