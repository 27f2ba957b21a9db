"""Command lines of every verb, those that draw apart from others, and numbers that are typed."""

import contextlib
import io
import shutil
from functools import cache
from pathlib import Path
from unittest.mock import patch

import mujoco  # noqa: F401, starts a process where it is imported first

import dh2urdf
import dh2urdf.cli
import dh2urdf.dh_io.read
import dh2urdf.figures
from dh2urdf.cli.verbs import check
from dh2urdf.dh_io import TableFile, Told, parse_table, table_to_text
from tests.fuzz.door import Door
from tests.fuzz.guard import FaultError, unwatched

VERBS = """
convert arm.yaml -o a.urdf
convert arm.yaml -o a.toml --units mm,deg --convention modified --force
convert arm.yaml arm.urdf --out-dir out --collision --digits 6
convert arm.yaml -o a.xml --json
convert arm.csv -o - --convention standard --units m,rad
extract arm.urdf --base base_link --tip tool0 --format csv
extract arm.urdf --no-embedded --explain --snap 1e-6 --json
extract arm.urdf -o x.md --x-axis common --compact --digits 5
check arm.urdf --json
check arm.urdf arm.yaml --format junit
compare arm.yaml arm.urdf --exact --json
compare planar_rr arm.yaml --tolerance 1e-6
show arm.yaml --values 0.1 0.2 --deg
show arm.yaml --q 0.1,0.2 --json
show arm.csv --format latex --convention modified --units mm,deg
fk arm.yaml 0.1 -pi/2
fk arm.urdf --q=-90deg,45 --deg --base base_link --tip dh_1 --json
ik arm.yaml --xyz 0.4 0.2 0 --rpy 0 0 1.2
ik arm.yaml --matrix 1 0 0 0.4 0 1 0 0.2 0 0 1 0 --nearest --task position
ik arm.yaml --csv poses.csv -o out.csv --best --seed 0.1 0.2 --force
ik arm.yaml --csv poses.csv --task position --json
ik arm.yaml --xyz 400mm 200mm 0 --task position --explain --solution 1 --format md
path arm.yaml poses.csv -o out.csv --start 0 0 --max-jump 0.3 --task position
view arm.yaml -o a.html --q 0.1,0.2 --deg --force
"""

NUMBERS = """
fk arm.yaml 0.1 0.2
fk puma560 10 20 30 40 50 60 --deg
fk franka_fer 0 0 0 -pi/2 0 pi/2 0 --json
ik puma560 --xyz 0.4 0.1 0.3 --rpy 0 180 0 --deg --turns all
ik puma560 --xyz 0.4 0.1 0.3 --rpy 0 3.1 0 --seed 0 0 0 0 0 0 --seed-tolerance 0.5 --words kuka
ik franka_fer --xyz 0.4 0.1 0.3 --rpy 0 3.1 0 --locked panda_joint7=0.3 --json
ik franka_fer --xyz 0.4 0.1 0.3 --rpy 0 3.1 0 --locked 6=0.3 0=0.1 --no-within-limits
ik puma560 --matrix 1 0 0 0.4 0 -1 0 0.1 0 0 -1 0.3 0 0 0 1 --nearest
"""

DRAWINGS = """
figure arm.yaml -o a.svg --q 0.1,0.2 --force
figure arm.urdf -o a.png --style schematic --view 30 20 --dpi 40 --no-table
figure arm.yaml -o a.svg --branches --task position --no-frames --deg
workspace arm.yaml -o a.svg --plane xy --points 200 --force
workspace arm.yaml --exact --json
workspace arm.yaml --envelope --orientations 3 --rpy 0 0 1 --at 0.1
map arm.yaml -o a.zarr --step 0.9 --orientations 2 --json
map arm.yaml -o a.zarr --step 400mm --region 0 1 0 1 0 0.5 --refine 1 --no-limits
map arm.yaml -o a.zarr --towards 0 0 -1 --within 30deg --spins 2 --each --step 1
place arm.yaml poses.csv --task position --region -1 1 -1 1 --yaw 0 --json
place arm.yaml poses.csv -o a.svg --against arm.urdf --height 0 0.1 --mount pi 0 0 --deg
export arm.yaml -o a.h --language c --prefix my --tests t.c --force
export arm.urdf -o a.py --held joint_1=0.3 --force
export arm.yaml --ros2 out --plugin --force
"""

AWAY = ("--scheduler", "--host", "--port", "--debug")
"""Options that ask for what is forbidden here: connections, and tracebacks."""

WRITING = ("-o", "--output", "--out-dir", "--ros2", "--tests", "--figure", "--fix")


@cache
def _files() -> dict[str, bytes]:
    """What the folder holds, by name."""
    table = dh2urdf.load_table("planar_rr")
    texts = {"arm.yaml": table_to_text(table, "yaml"), "arm.csv": table_to_text(table, "csv")}
    texts["arm.urdf"] = dh2urdf.urdf_text(table)
    texts["poses.csv"] = "x,y,z,roll,pitch,yaw\n0.4,0.2,0,0,0,1\n0.4,0.25,0,0,0,1.1\n"
    return {name: text.encode() for name, text in texts.items()}


def run(data: bytes, folder: Path) -> None:
    """A line of words ends with 0, 1 or 2, says why, and writes only what it was told to."""
    words = data.decode("utf-8", "surrogateescape").replace("\0", "").split()
    if _asks_for_more(words):
        return
    with unwatched():
        for name, content in _files().items():
            (folder / name).write_bytes(content)
    out, err = io.StringIO(), io.StringIO()
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        patch.object(dh2urdf.cli.os, "dup2"),
        patch.object(check, "ask_all", lambda *_: ()),
        patch("sys.stdin", io.TextIOWrapper(io.BytesIO(b"x"))),
    ):
        try:
            dh2urdf.cli.main(words)
        except SystemExit as end:
            status = end.code
    if status not in (0, 1, 2):
        raise FaultError(f"status {status}")
    said = err.getvalue()
    if "Traceback" in said or "Warning" in said or (status == 2 and "dh2urdf: " not in said):
        raise FaultError(f"status {status}, said {said[-500:]!r}")
    with unwatched():
        _tidy(folder, words)


def _asks_for_more(words: list[str]) -> bool:
    """Whether a line asks for a server, a connection, another program or a file elsewhere."""
    first = words[:1]
    writes = any(word.startswith(WRITING) for word in words)
    away = any("/" in word or ".." in word for word in words)
    serves = first == ["view"] and not {"-o", "--output", "--help", "-h"} & set(words)
    return serves or (writes and away) or any(word.startswith(AWAY) for word in words)


def _tidy(folder: Path, words: list[str]) -> None:
    """Remove what the line was told to write; what it was not told to touch is as it was."""
    told = " ".join(words)
    for path in folder.iterdir():
        content = _files().get(path.name)
        if path.stem in told:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        elif content is not None:
            assert path.read_bytes() == content, f"{path.name} was changed by {told!r}"
            path.unlink()


def _lines(text: str) -> tuple[bytes, ...]:
    """Command lines, a word a line."""
    return tuple("\n".join(line.split()).encode() for line in text.strip().split("\n"))


@cache
def _kept(text: str, format: str, filename: str, told: Told) -> TableFile:
    return parse_table(text, format, filename, told)


def with_numbers(data: bytes, folder: Path) -> None:
    """The same, where tables are read once: reading them is a door of its own."""
    with patch.object(dh2urdf.dh_io.read, "parse_table", _kept):
        run(data, folder)


DOORS = [
    Door("command_lines", run, ("command_lines",), _lines(VERBS)),
    Door("drawings", run, ("command_lines", "drawings"), _lines(DRAWINGS), usual=500),
    Door("numbers", with_numbers, ("numbers",), _lines(NUMBERS)),
]
