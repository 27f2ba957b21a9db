"""A file is written whole or not at all."""

import errno
import os
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from dh2urdf.dh_io import atomic_write
from dh2urdf.exceptions import OutputError


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


@pytest.fixture
def older(tmp_path: Path) -> Iterator[Path]:
    """A file that has to be as before after the test, and alone in its folder."""
    path = tmp_path / "arm.yaml"
    path.write_text("old")
    yield path
    assert path.read_text() == "old"
    assert names(tmp_path) == ["arm.yaml"]


def test_text_and_bytes_are_written(tmp_path: Path) -> None:
    """The file holds exactly the content, and nothing else is left in the folder."""
    path = tmp_path / "arm.yaml"
    assert atomic_write(path, "θ\n") == path
    assert path.read_bytes() == "θ\n".encode()
    atomic_write(path, b"\r\n")
    assert path.read_bytes() == b"\r\n"
    assert names(tmp_path) == ["arm.yaml"]


def test_a_new_file_has_the_permissions_of_any_new_file(tmp_path: Path) -> None:
    """It is as readable as one made by ``touch``, unlike a bare temporary file."""
    atomic_write(tmp_path / "a", "")
    (tmp_path / "b").touch()
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "b").stat().st_mode


def test_permissions_of_an_older_file_are_kept(tmp_path: Path) -> None:
    """Mode 0640 stays mode 0640."""
    path = tmp_path / "arm.yaml"
    path.touch()
    path.chmod(0o640)
    atomic_write(path, "new")
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_symbolic_link_is_followed(tmp_path: Path) -> None:
    """The file behind the link changes, the link stays a link."""
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_text("old")
    link.symlink_to(target)
    atomic_write(link, "new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_a_pipe_is_written_to_not_replaced(tmp_path: Path) -> None:
    """A named pipe stays a pipe and carries the content."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    atomic_write(pipe, "content")
    assert os.read(reader, 100) == b"content"
    os.close(reader)
    assert stat.S_ISFIFO(pipe.stat().st_mode)


def test_a_link_to_a_named_pipe_is_refused(tmp_path: Path) -> None:
    """A link that hides a pipe without a reader is refused at once; with one it is written to."""
    os.mkfifo(tmp_path / "pipe")
    for name, goal in (("link", "pipe"), ("further", "link")):
        (tmp_path / name).symlink_to(goal)
        with pytest.raises(OutputError, match=f"{name}: cannot write: it is a link to a named"):
            atomic_write(tmp_path / name, "content")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    atomic_write(tmp_path / "further", "content")
    assert os.read(reader, 100) == b"content"
    os.close(reader)
    write = "from dh2urdf.dh_io import atomic_write; atomic_write('/dev/stdout', 'content')"
    run = subprocess.run([sys.executable, "-c", write], capture_output=True, check=True)
    assert run.stdout == b"content"


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EIO, None])
def test_a_failed_write_leaves_the_older_file(
    older: Path, monkeypatch: pytest.MonkeyPatch, code: int | None
) -> None:
    """Where the last step fails or is interrupted, the older file and the folder are as before."""

    def fail(*_: object) -> None:
        raise OSError(code, os.strerror(code)) if code else KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", fail)
    error, words = (OutputError, r"arm\.yaml: cannot write") if code else (KeyboardInterrupt, None)
    with pytest.raises(error, match=words):
        atomic_write(older, "new")


def test_a_full_disk_leaves_the_older_file(older: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A disk that is full is named, and no temporary file stays."""
    real = os.fdopen

    def full(handle: int, mode: str) -> object:
        os.close(handle)
        return real(os.open("/dev/full", os.O_WRONLY), mode)

    monkeypatch.setattr(os, "fdopen", full)
    with pytest.raises(OutputError, match="the disk is full"):
        atomic_write(older, "new")
    monkeypatch.undo()


def test_paths_that_cannot_be_written(tmp_path: Path) -> None:
    """A folder, a missing folder, a file for a folder and a bad name are told in one line."""
    (tmp_path / "file").touch()
    cases = {
        tmp_path: "it is a folder",
        tmp_path / "none" / "arm.yaml": "there is no such folder",
        tmp_path / "file" / "arm.yaml": "part of the path is a file, not a folder",
        tmp_path / ("x" * 300): "the name is too long",
        tmp_path / "a\0b": "embedded null",
    }
    for path, reason in cases.items():
        with pytest.raises(OutputError, match=reason) as caught:
            atomic_write(path, "new")
        assert str(caught.value).startswith(f"{path}: cannot write: ")
        assert "\n" not in str(caught.value)


def test_text_that_is_no_unicode_is_refused(tmp_path: Path) -> None:
    """A lone surrogate cannot be written, and no file is made."""
    with pytest.raises(OutputError, match="as UTF-8"):
        atomic_write(tmp_path / "a", "\ud800")
    assert names(tmp_path) == []


def test_a_file_that_may_not_be_written_is_left(
    older: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A read-only file is not replaced, although its folder would allow it."""
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write everything
    with pytest.raises(OutputError, match="no permission to write there"):
        atomic_write(older, "new")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write into every folder")
def test_a_folder_without_permission_is_told(tmp_path: Path) -> None:
    """No permission in the folder is one line, and nothing is made."""
    tmp_path.chmod(0o500)
    with pytest.raises(OutputError, match="no permission to write there"):
        atomic_write(tmp_path / "arm.yaml", "new")
    tmp_path.chmod(0o700)
    assert names(tmp_path) == []
