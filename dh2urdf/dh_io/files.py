"""Files read whole, within a stated size, whatever stands at the path."""

import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError

_REASONS = {
    errno.ENOENT: "there is no such file",
    errno.EACCES: "no permission to read it",
    errno.ENAMETOOLONG: "cannot read: the name is too long",
    errno.ELOOP: "cannot read: a link that leads to itself",
}

_CHUNK = 1 << 20

Error = type[Dh2UrdfError]


def read_bytes(
    source: str | os.PathLike[str] | BinaryIO, limit: int, error: Error = ArgumentError
) -> bytes:
    """All bytes of a regular file, or of an open stream such as ``sys.stdin.buffer``.

    The error says that nothing is there, or a folder, pipe or device, that it may not be read,
    or that it has more bytes than the limit.
    """
    if not isinstance(source, str | os.PathLike):
        if not hasattr(source, "read"):
            raise error(f"path: expected a path, got {found(source)}")
        return _bounded(source, limit, "<stdin>", error)
    name = shown(source)
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    try:
        with os.fdopen(os.open(source, flags), "rb") as stream:
            mode = os.fstat(stream.fileno()).st_mode
            if not stat.S_ISREG(mode):
                raise error(f"{name}: this is a pipe or a device, not a file")
            return _bounded(stream, limit, name, error)
    except (OSError, ValueError) as fault:
        if isinstance(fault, Dh2UrdfError):
            raise
        if os.path.isdir(source):
            raise error(f"{name}: this is a folder, not a file") from None
        text = getattr(fault, "strerror", None) or fault
        reason = _REASONS.get(getattr(fault, "errno", None) or 0, f"cannot read: {text}")
        raise error(f"{name}: {reason}") from None


def _bounded(stream: BinaryIO, limit: int, name: str, error: Error) -> bytes:
    """What a stream has to give, as long as it is no more than is allowed."""
    data = bytearray()
    while chunk := stream.read(_CHUNK):
        data += chunk
        if len(data) > limit:
            raise error(f"{name}: larger than {limit // 1000} kB, the most that is read")
    return bytes(data)


def decode(data: bytes, name: str, error: Error = ArgumentError) -> str:
    """UTF-8 text with plain line ends, with or without a byte order mark; or the error."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise error(f"{name}: the file is UTF-16 text; save it as UTF-8")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        reason = "it holds binary data" if b"\0" in data else "it is not UTF-8"
        raise error(f"{name}: not a text file: {reason}") from None


def read_text(
    source: str | os.PathLike[str] | BinaryIO, limit: int, error: Error = ArgumentError
) -> str:
    """Like :func:`read_bytes`, decoded by :func:`decode`."""
    name = shown(source) if isinstance(source, str | os.PathLike) else "<stdin>"
    return decode(read_bytes(source, limit, error), name, error)


def path_of(path: object, what: str = "path", expected: str = "a path") -> Path:
    """A path of text, bytes or any object that stands for one; an error for anything else."""
    try:
        return Path(os.fsdecode(path))  # type: ignore[arg-type]
    except TypeError:
        raise ArgumentError(f"{what}: expected {expected}, got {found(path)}") from None


def shown(path: str | os.PathLike[str]) -> str:
    """A path as messages show it: in one line of characters that print, not over 300 of them."""
    text = os.fsdecode(path)
    text = text if len(text) <= 300 else f"{text[:100]}...{text[-150:]}"
    return "".join(c if c.isprintable() else ascii(c)[1:-1] for c in text)
