"""Files at every door: regular ones of bounded size, and no waiting for anything else."""

import io
import os
import subprocess
import sys

import pytest

import dh2urdf
from dh2urdf.checks import check_urdf
from dh2urdf.dh_io.files import read_bytes, read_text, shown
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError

DOORS = {
    "Robot.from_urdf": dh2urdf.Robot.from_urdf,
    "extract_dh": dh2urdf.extract_dh,
    "check_urdf": check_urdf,
    "load_table": dh2urdf.load_table,
}

NAMES = ["arm.urdf", "arm.xacro", "arm.xml", "arm.yaml", "arm.json"]


def special(kind, path):
    """Put something that is no regular file at a path."""
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path.name)
    else:
        path.symlink_to(f"/dev/{kind}")


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("kind", ["zero", "urandom", "null", "pipe", "folder", "loop"])
@pytest.mark.parametrize("name", NAMES)
def test_what_is_no_regular_file_is_refused_at_once(door, kind, name, tmp_path):
    """Devices without end, pipes without a writer, folders and loops: one message, no waiting."""
    path = tmp_path / name
    special(kind, path)
    with pytest.raises(
        Dh2UrdfError, match=r"pipe or a device|folder|leads to itself|by its name|neither a file"
    ):
        DOORS[door](path)


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("name", NAMES)
def test_a_huge_file_is_refused_by_its_size(door, name, tmp_path):
    """A hole of 10 GB is refused after the bound, in the memory of the bound."""
    path = tmp_path / name
    with path.open("wb") as file:
        file.truncate(10_000_000_000)
    with pytest.raises(Dh2UrdfError, match=r"larger than|by its name"):
        DOORS[door](path)


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize(
    "path", ["a\0b.urdf", "\ud800.urdf", "\uffff.urdf", "x" * 5000, "", "a\nb"]
)
def test_a_path_that_cannot_be_is_one_message(door, path):
    """NUL, lone surrogates, no characters and over-long names are told in characters that print."""
    with pytest.raises(Dh2UrdfError) as caught:
        DOORS[door](path)
    message = str(caught.value)
    assert len(message) < 1000
    assert all(c.isprintable() or c == "\n" for c in message)


def test_bytes_up_to_the_bound_are_read(tmp_path):
    """The bound itself is allowed, one byte more is not; a stream has the same bound."""
    path = tmp_path / "file"
    path.write_bytes(b"x" * 4000)
    assert read_bytes(path, 4000) == b"x" * 4000
    assert read_bytes(io.BytesIO(b"x" * 4000), 4000) == b"x" * 4000
    for source in (path, io.BytesIO(b"x" * 4000)):
        with pytest.raises(ArgumentError, match="larger than"):
            read_bytes(source, 3999)


def test_text_is_utf_8_with_plain_line_ends(tmp_path):
    """A byte order mark and Windows line ends go; UTF-16 and Latin-1 are told."""
    path = tmp_path / "file"
    path.write_bytes("\ufeffä\r\nb\rc".encode())
    assert read_text(path, 100) == "ä\nb\nc"
    for data, word in (
        ("a".encode("utf-16"), "UTF-16"),
        (b"\xe4", "not UTF-8"),
        (b"\xff\0", "binary"),
    ):
        path.write_bytes(data)
        with pytest.raises(ArgumentError, match=word):
            read_text(path, 100)


def test_a_long_path_is_shown_by_its_ends():
    """300 characters at most, all of which print."""
    assert shown("x/arm.urdf") == "x/arm.urdf"
    assert shown("a\nb\ud800") == r"a\nb\ud800"
    assert len(shown("x" * 10_000)) <= 300


def test_verbs_do_not_wait_for_a_pipe(tmp_path):
    """``check``, ``extract`` and ``fk`` of a pipe end with 2 and one line."""
    path = tmp_path / "arm.urdf"
    os.mkfifo(path)
    for verb in (["check", str(path)], ["extract", str(path)], ["fk", str(path), "0"]):
        command = [sys.executable, "-m", "dh2urdf", *verb]
        run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        assert run.returncode == 2
        assert run.stderr.count("\n") == 1
        assert "pipe" in run.stderr
