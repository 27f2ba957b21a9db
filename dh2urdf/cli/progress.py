"""A progress bar on a terminal, after half a second; nothing elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

__all__ = ["bar", "track"]

T = TypeVar("T")

PATIENCE = 0.5
"""Seconds before the bar appears."""


def track(items: Sequence[T], what: str) -> Iterator[T]:
    """Yield the items, with a bar on stderr where that is a terminal and the work is long."""
    with bar(what, len(items)) as report:
        for done, item in enumerate(items, 1):
            yield item
            report(done, len(items))


@contextmanager
def bar(what: str, total: int) -> Iterator[Callable[[int, int], None]]:
    """A function to call with the number done and the total; it draws like :func:`track`."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import Progress

    start = time.monotonic()
    with Progress(console=Console(stderr=True), transient=True, auto_refresh=False) as progress:
        task = progress.add_task(what, total=total, visible=False)

        def report(done: int, total: int) -> None:
            late = time.monotonic() - start > PATIENCE
            progress.update(task, completed=done, total=total, visible=late)
            if late:
                progress.refresh()

        yield report
