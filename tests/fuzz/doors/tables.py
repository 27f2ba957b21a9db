"""Table files in all formats, and what a table is told by other programs' files."""

from pathlib import Path

from hostile import outcome

from dh2urdf import DHTable, load_table
from dh2urdf.dh_io import parse_table, table_to_text
from dh2urdf.exceptions import Dh2UrdfError
from tests.fuzz.door import Door

SUFFIXES = {"yaml": "yaml", "toml": "toml", "json": "json", "csv": "csv", "markdown": "md"}


def read(format: str):
    """A file is loaded or refused; what was loaded is written, and read back as the same."""

    def enter(data: bytes, folder: Path) -> None:
        path = folder / f"arm.{SUFFIXES[format]}"
        path.write_bytes(data)
        found = outcome(load_table, path)
        path.unlink()
        if isinstance(found, DHTable):
            assert parse_table(table_to_text(found, format), format).table == found
        else:
            assert isinstance(found, Dh2UrdfError)

    return enter


def read_conf(data: bytes, folder: Path) -> None:
    """UR's calibration.conf, a form of its own."""
    path = folder / "calibration.conf"
    path.write_bytes(data)
    found = outcome(load_table, path, model="ur5e")
    path.unlink()
    assert isinstance(found, DHTable | Dh2UrdfError)


DOORS = [
    *(Door(format, read(format), ("tables",)) for format in SUFFIXES),
    Door("conf", read_conf, ("conf",)),
]
