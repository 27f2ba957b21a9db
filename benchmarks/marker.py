"""Who is at work: a name in a shared file, still there when its process is not.

A peer is native code; when it takes the process with it, the one that started the process reads
here whom to blame.
"""

from __future__ import annotations

import mmap
from pathlib import Path

__all__ = ["at_work", "read", "write_to"]

SIZE = 64
_memory: list[mmap.mmap] = []


def write_to(path: Path) -> None:
    """Keep the name in this file from now on."""
    path.write_bytes(bytes(SIZE))
    with path.open("r+b") as file:
        _memory[:] = [mmap.mmap(file.fileno(), SIZE)]


def at_work(name: str) -> None:
    """Note who is called next; nothing happens in a process that nobody watches."""
    for memory in _memory:
        memory[:] = name.encode()[:SIZE].ljust(SIZE, b"\0")


def read(path: Path) -> str:
    """The last name that was noted; empty if none was."""
    return path.read_bytes().rstrip(b"\0").decode() if path.exists() else ""
