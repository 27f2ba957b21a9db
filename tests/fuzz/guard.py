"""What no input may bring about, watched by Python's audit events while a door is open."""

import os
import resource
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any

SECONDS = 10
"""Longest that a door may work."""

PATIENCE = 6
"""Times as long it may be there, beside when others have the processor."""

GROWTH = 1_000_000
"""Memory by which the process may grow over one input [kB]."""

COMPUTED_BY = (
    "/typing",
    "/dataclasses",
    "/collections/",
    "/enum",
    "/inspect",
    "cyclopts",
    "/attr/",
    "/dh2urdf/export/source/c_kernels.py",  # sizes as the kernels state them, in their own text
)
"""Modules that compile texts of programs, such as annotations, when these are first used."""

MEMORY = "/dev/shm/"
"""Files in memory, as those on disk."""

STARTS = ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.spawn", "os.startfile")
MOVES = (
    "os.remove",
    "os.rename",
    "os.mkdir",
    "os.rmdir",
    "os.link",
    "os.symlink",
    "os.chmod",
    "os.truncate",
)


class FaultError(AssertionError):
    """What a door did and should not have done."""


_watch: dict[str, Any] = {"folder": None, "seen": []}


def _hook(event: str, values: tuple[Any, ...]) -> None:
    folder = _watch["folder"]
    if folder is None:
        return
    _watch["folder"] = None  # what is asked here raises events of its own
    try:
        fault = _fault(event, values, folder)
        if fault:
            _watch["seen"].append(fault)
            raise FaultError(fault)
    finally:
        _watch["folder"] = folder


def _fault(event: str, values: tuple[Any, ...], folder: str) -> str:
    """What is wrong with an event; nothing where it is none of those that are forbidden."""
    if event in ("socket.connect", "socket.bind", "socket.sendto") and isinstance(values[1], tuple):
        return f"network: {event} {values[1]}"
    if event in ("socket.getaddrinfo", "socket.gethostbyname"):
        return f"network: {event} {values[0]}"
    if event.startswith(STARTS):
        return f"a process: {event} {str(values)[:200]}"
    if event == "pickle.find_class" and not _of_our_own():
        return f"code from data: pickle {values}"
    if event == "exec" and not _by_a_program(values[0]):
        by = sys._getframe(2).f_code.co_filename
        return f"code from data: {values[0]!r} by {by}"
    if event == "open" and isinstance(values[0], (str, bytes)) and _writes(values[1], values[2]):
        return _outside(values[0], folder)
    beside = -1 in values[1:]  # a path, not a name in an open folder
    if event in MOVES and isinstance(values[0], (str, bytes)) and beside:
        return _outside(values[0], folder)
    return ""


def _of_our_own() -> bool:
    """Whether it is what the process made itself: Dask to name a task, a robot for its workers.

    No codec of a store does that.
    """
    frame, files = sys._getframe(3), ""
    while frame is not None:
        files, frame = files + frame.f_code.co_filename, frame.f_back
    ours = "/dask/" in files or "/robot/carried.py" in files
    return ours and "/numcodecs/" not in files


def _writes(mode: str | None, flags: int) -> bool:
    return bool(flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)) or bool(
        set(mode or "") & set("wax+")
    )


def _outside(path: str | bytes, folder: str) -> str:
    real = os.path.realpath(os.fsdecode(path))
    device = real.startswith("/dev/") and not real.startswith(MEMORY)
    if device or real.startswith((folder, "/proc/self/")) or "__pycache__" in real:
        return ""
    return f"outside the folder: {real}"


def _by_a_program(code: Any) -> bool:
    """Whether code comes from a file, an import, or a library's own text."""
    if os.path.isfile(code.co_filename) or code.co_filename.startswith("<frozen"):
        return True
    frame: Any = sys._getframe(3)
    if any(part in frame.f_code.co_filename for part in COMPUTED_BY):
        return True
    while frame is not None and not frame.f_code.co_filename.startswith("<frozen importlib"):
        frame = frame.f_back
    return frame is not None


sys.addaudithook(_hook)


@contextmanager
def watched(folder: Path) -> Iterator[None]:
    """Run what stands inside; a :class:`FaultError` for anything that no input may bring about."""
    begun, worked, asked = time.monotonic() - starved(), time.process_time(), count(1)

    def late(*_: object) -> None:
        waited = time.monotonic() - starved() - begun >= PATIENCE * SECONDS
        waited &= next(asked) >= PATIENCE  # a process that is stopped meanwhile is asked once
        if waited or time.process_time() - worked >= SECONDS:
            raise FaultError(f"no end after {SECONDS} s")

    was, before = signal.signal(signal.SIGALRM, late), _memory()
    place, there = tempfile.tempdir, set(os.listdir(folder))
    tempfile.tempdir = str(folder)
    _watch.update(folder=os.path.realpath(folder), seen=[])
    signal.setitimer(signal.ITIMER_REAL, SECONDS, SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield
    finally:
        _watch["folder"] = None
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, was)
        tempfile.tempdir = place
    if _watch["seen"]:
        raise FaultError("; ".join(_watch["seen"]))
    if _memory() - before > GROWTH:
        raise FaultError(f"{(_memory() - before) // 1000} MB of memory")
    if left := set(os.listdir(folder)) - there:
        raise FaultError(f"left behind: {sorted(left)}")


@contextmanager
def unwatched() -> Iterator[None]:
    """Do what the tests themselves need: write what is read, begin a server."""
    folder, _watch["folder"] = _watch["folder"], None
    place, tempfile.tempdir = tempfile.tempdir, None
    try:
        yield
    finally:
        _watch["folder"], tempfile.tempdir = folder, place


def starved() -> float:
    """For how long others had the processor that this process could have used [s], on Linux."""
    try:
        return int(Path("/proc/self/schedstat").read_text(encoding="ascii").split()[1]) * 1e-9
    except OSError:
        return 0.0


def _memory() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
