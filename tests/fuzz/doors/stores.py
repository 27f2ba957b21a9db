"""Zarr stores of a map: one of its files holds anything."""

import asyncio
import atexit
import shutil
import tempfile
import threading
from concurrent.futures import Future
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from unittest.mock import patch

import dask
from hostile import outcome

from dh2urdf import Robot
from dh2urdf.workspace import map_summary, map_surface, reach_map
from dh2urdf.workspace.stored_map import VARIABLES, map_cut, open_map
from tests.fuzz.door import Door
from tests.fuzz.guard import unwatched


@cache
def _store() -> tuple[Robot, Path]:
    """An arm of one joint with a finished map."""
    with unwatched():
        robot = Robot.from_dh("planar_rr")
        path = Path(tempfile.mkdtemp(prefix="fuzz-")) / "map.zarr"
        reach_map(robot, step=1.0, store=path).close()
    return robot, path


@cache
def _files() -> list[str]:
    _, path = _store()
    return sorted(str(p.relative_to(path)) for p in path.rglob("*") if p.is_file())


_turn = threading.Lock()


@cache
def _loop() -> asyncio.AbstractEventLoop:
    with unwatched():
        loop = asyncio.new_event_loop()
    atexit.register(loop.close)
    return loop


def _run(coroutine, _) -> Future:
    """Run a coroutine of Zarr in the thread that waits for it."""
    done: Future = Future()
    with _turn:
        done.set_result(_loop().run_until_complete(coroutine))
    return done


async def _call(function, /, *given, **more):
    return function(*given, **more)


@contextmanager
def _without_threads():
    """Zarr and Dask without threads of theirs, whose waiting takes most of the time."""
    with (
        dask.config.set(scheduler="synchronous"),
        patch.object(asyncio, "run_coroutine_threadsafe", _run),
        patch.object(asyncio, "to_thread", _call),
    ):
        yield


def read(data: bytes, folder: Path) -> None:
    """A map is opened or refused, and gone on with or refused, whatever one of its files holds."""
    robot, path = _store()
    which, _, content = data.partition(b"\n")
    name = (
        _files()[sum(which) % len(_files())]
        if which.decode("latin1") not in _files()
        else which.decode()
    )
    with unwatched():
        shutil.copytree(path, folder / "map.zarr")
        (folder / "map.zarr" / name).write_bytes(content)
    with _without_threads():
        _use(robot, folder / "map.zarr")
    with unwatched():
        shutil.rmtree(folder / "map.zarr")


def _use(robot: Robot, store: Path) -> None:
    found = outcome(open_map, store)
    if not isinstance(found, Exception):
        for variable in VARIABLES[:2]:
            outcome(map_cut, found, variable)
        outcome(map_surface, found, 0.5)
        outcome(map_summary, found)
        found.close()
    outcome(lambda: reach_map(robot, step=1.0, store=store).close())


DOORS = [Door("stores", read, ("stores",), usual=1000)]
