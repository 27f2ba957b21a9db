"""All blocks of a level, on the threads of this process or the workers of a Dask cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

from dh2urdf.exceptions import ArgumentError, MissingExtraError, SchedulerError
from dh2urdf.workspace.reach.block import Values
from dh2urdf.workspace.reach.job import Job, run_block
from dh2urdf.workspace.reach.settings import Block

Coarse = Callable[[Block], Values | None]
"""The coarser voxels around a block, where they are not in a store."""

Answered = Generator[tuple[Block, Values | None]]

PATIENCE = 5
"""Seconds to wait for a scheduler."""

TRIES = 5
"""How often a client registers, where another one is just letting go of its work."""


def on_threads(job: Job, blocks: list[Block], coarse: Coarse) -> Answered:
    """Blocks as they are done, a thread for each processor: kernels let others run."""
    count = os.cpu_count() or 1
    waiting, running = iter(blocks), dict[Future[Values | None], Block]()
    with ThreadPoolExecutor(count, "dh2urdf-map") as pool:
        try:
            while True:
                for block in _some(waiting, 2 * count - len(running)):
                    running[pool.submit(run_block, job, block, coarse(block))] = block
                if not running:
                    return
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(future), future.result()
        finally:
            for future in running:
                future.cancel()


def _some(items: Iterator[Block], count: int) -> list[Block]:
    """The next few."""
    return [item for _, item in zip(range(count), items, strict=False)]


def on_cluster(client: Any, job: Job, blocks: list[Block], coarse: Coarse) -> Answered:
    """Blocks as the workers of a Dask client get done with them.

    The job is a task of its own: workers hand it to one another, and where all that have it are
    lost, it is there again.
    """
    from dask.distributed import as_completed

    with _connected(client):
        given = client.submit(_itself, job, pure=False)
        before = [coarse(block) for block in blocks]
        futures = client.map(
            run_block, [given] * len(blocks), blocks, before, pure=False, key="dh2urdf-map"
        )
        block_of = dict(zip(futures, blocks, strict=True))
        try:
            for future in as_completed(futures):
                values = future.result()
                future.release()
                yield block_of[future], values
        finally:
            if client.status == "running":
                client.cancel(futures)


def _itself(job: Job) -> Job:
    return job


def _registered(make: Callable[[], Any]) -> Any:
    """A new client; the library asserts that none lets go of its work in that very moment."""
    for _ in range(TRIES - 1):
        with suppress(AssertionError):
            return make()
    return make()


@contextmanager
def connected(client: Any) -> Iterator[Any]:
    """The client that is given, or one to the scheduler at an address, closed at the end.

    Raises
    ------
    MissingExtraError, SchedulerError, ArgumentError
    """
    try:
        from dask.distributed import Client
    except ImportError:
        raise MissingExtraError("scale", "work on a cluster") from None
    if isinstance(client, Client):
        yield client
        return
    if not isinstance(client, str):
        raise ArgumentError("client: expected a dask.distributed.Client or a scheduler's address")

    class Closed(Client):  # type: ignore[misc]
        """One that never came to run has nothing to wait for when it is let go."""

        def __del__(self) -> None:
            if self.status == "running":
                super().__del__()

    try:
        made = _registered(partial(Closed, client, timeout=PATIENCE, set_as_default=False))
    except (OSError, ValueError, MemoryError) as error:  # the last: of what is no scheduler
        raise SchedulerError(
            f"{client}: no Dask scheduler answers there: {_short(error)}"
        ) from None
    with made:
        yield made


@contextmanager
def _connected(client: Any) -> Iterator[None]:
    """Say in one line that the scheduler was lost on the way."""
    from concurrent.futures import CancelledError

    try:
        yield
    except (CancelledError, TimeoutError, ConnectionError) as error:
        where = client.scheduler.address if client.scheduler else "the scheduler"
        raise SchedulerError(
            f"{where}: lost: {_short(error)}; with a store, the same call goes on with what is left"
        ) from None


def _short(error: BaseException) -> str:
    """An error in one line."""
    lines: Iterable[str] = str(error).split("\n")
    return " ".join(" ".join(lines).split())[:200] or type(error).__name__
