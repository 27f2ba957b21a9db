"""Files that are either written whole or not at all."""

import contextlib
import errno
import os
import stat
import tempfile
from collections.abc import Iterable
from pathlib import Path

from dh2urdf.dh_io.files import path_of, shown
from dh2urdf.exceptions import Dh2UrdfError, OutputError, OutputExistsError

_REASONS = {
    errno.ENOENT: "there is no such folder",
    errno.ENOTDIR: "part of the path is a file, not a folder",
    errno.EACCES: "no permission to write there",
    errno.EPERM: "no permission to write there",
    errno.EROFS: "the file system is read-only",
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.ENAMETOOLONG: "the name is too long",
    errno.EISDIR: "it is a folder",
    errno.ENXIO: "it is a link to a named pipe that nobody reads",
}


def atomic_write(path: str | os.PathLike[str], content: str | bytes | Iterable[bytes]) -> Path:
    """Write a file so that nobody ever sees half of it.

    The content goes to a temporary file in the same folder, which then takes the place of the old
    one. Text is written as UTF-8, parts of bytes as they come. An older file keeps its permissions,
    and stays as it was where anything fails. A symbolic link is followed, not replaced. A device or
    pipe, such as ``/dev/stdout``, is written to directly; a named pipe behind a link must have a
    reader.

    Returns
    -------
    pathlib.Path
        The path as given.

    Raises
    ------
    OutputError
        The folder is missing, the path is a folder or a link to a pipe that nobody reads, no
        permission, the disk is full.
    """
    where = path_of(path)
    try:
        whole = content.encode() if isinstance(content, str) else content
    except UnicodeEncodeError as error:
        sign = error.object[error.start]
        raise OutputError(f"{shown(where)}: cannot write {sign!r} as UTF-8") from None
    data = [whole] if isinstance(whole, bytes) else whole
    try:
        mode = None
        with contextlib.suppress(FileNotFoundError):
            mode = where.stat().st_mode
        if mode is not None and stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, "")
        if mode is not None and not stat.S_ISREG(mode):
            opener = _with_reader if where.is_symlink() and stat.S_ISFIFO(mode) else None
            with open(where, "wb", opener=opener) as stream:
                stream.writelines(data)
            return where
        _replace(Path(os.path.realpath(where)), data, mode)
    except (OSError, ValueError) as error:
        if isinstance(error, Dh2UrdfError):  # of who made the content
            raise
        raise OutputError(f"{where}: cannot write: {_reason(error)}") from None
    return where


def refuse_unwritable(path: Path) -> None:
    """Refuse a folder and a missing one before the work of which the answer would go there.

    Raises
    ------
    OutputError
        What :func:`atomic_write` would say.
    """
    code = errno.EISDIR if path.is_dir() else 0 if path.parent.is_dir() else errno.ENOENT
    if code:
        raise OutputError(f"{shown(path)}: cannot write: {_REASONS[code]}")


def refuse_foreign(path: Path, *marks: str, same: bytes = b"") -> None:
    """Refuse to write over a file without a mark of this package that holds anything but ``same``.

    Marks stand in the first lines.
    """
    if not os.path.isfile(path):
        return
    try:
        with path.open("rb") as file:
            held = file.read(max(65536, len(same) + 1))
    except OSError as error:
        raise OutputError(f"{shown(path)}: cannot read: {_reason(error)}") from None
    head = held[:65536].decode(errors="replace")
    if head.strip() and held != same and not any(mark in head for mark in marks):
        why = "was not written by dh2urdf" if marks else "holds something else"
        raise OutputExistsError(
            f"{shown(path)}: exists and {why}; --force (force=True) replaces it"
        )


def _with_reader(path: str, flags: int) -> int:
    """Open a pipe, an error where there is nobody to read it yet."""
    handle = os.open(path, flags | os.O_NONBLOCK)
    os.set_blocking(handle, True)
    return handle


def _replace(target: Path, data: Iterable[bytes], mode: int | None) -> None:
    """Write data beside the target, then move it into place."""
    if mode is not None and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "")
    handle, temporary = tempfile.mkstemp(prefix=".dh2urdf-", suffix=".tmp", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.writelines(data)
        if mode is None:
            os.umask(mask := os.umask(0o077))  # the system only tells it when it is set
            mode = 0o666 & ~mask
        Path(temporary).chmod(stat.S_IMODE(mode))
        Path(temporary).replace(target)
    except BaseException:
        with contextlib.suppress(OSError):
            Path(temporary).unlink()
        raise


def _reason(error: OSError | ValueError) -> str:
    code = getattr(error, "errno", None)
    return _REASONS.get(code or 0) or getattr(error, "strerror", None) or str(error)
