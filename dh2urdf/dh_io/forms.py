"""Files in other people's forms, known by a key or a suffix.

The room that reads them assigns frames and stands above this one, so it is asked for by name.
"""

import re
from importlib import import_module
from pathlib import Path
from typing import Any

from dh2urdf.bounds import TABLE_BYTES
from dh2urdf.dh import DHTable
from dh2urdf.dh_io.cells.document import Keys, Node, Report
from dh2urdf.dh_io.cells.told import Told
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.dh_io.formats.yaml import plain_values
from dh2urdf.exceptions import ArgumentError, TableError, TableFileError, UrdfError

ROOM = "dh2urdf.conversions.forms"

READERS = {
    "kinematics": "read_kinematics",
    "opw_kinematics_geometric_parameters": "read_opw",
    "screws": "read_axes_form",
    "axes": "read_axes_form",
    "frames": "read_axes_form",
    "segments": "read_kdl",
}
"""By the key that such a file has: the reader in that room."""

CONF = ".conf"
"""Suffix of UR's calibration.conf."""

CONF_SIGN = re.compile(r"^\s*delta_theta\s*=\s*\[", re.MULTILINE)
"""By which its text is known."""

Read = tuple[DHTable, tuple[str, ...]]


def other_form(root: Node, report: Report, name: str, told: Told) -> Read | None:
    """The table of a document that is in another form, and what there is to say; else None."""
    keys = {key.text for key, _ in root.pairs} if isinstance(root, Keys) else set()
    form = next((key for key in READERS if key in keys), None)
    if form is None or "joints" in keys:
        return None
    content = plain_values(root, report)
    report.raise_faults()
    return _asked(READERS[form], report.filename, told, content, name)


def read_conf_file(path: Path, told: Told) -> Read:
    """The table of a calibration.conf."""
    return read_conf_text(
        read_text(path, TABLE_BYTES, TableFileError), shown(path), told, path.stem
    )


def read_conf_text(text: str, filename: str, told: Told, name: str) -> Read:
    """The table of the text of a calibration.conf."""
    return _asked("read_conf", filename, told, text, name, told.model)


def refuse_model(told: Told, filename: str) -> None:
    """Refuse a model for anything but a calibration.conf."""
    if told.model is not None:
        raise ArgumentError(f"model: only a calibration.conf needs it, not {filename}")


def _asked(reader: str, filename: str, told: Told, *given: Any) -> Read:
    """What a reader makes of a file, its errors with the file's name."""
    if told.convention or told.length or told.angle:
        raise TableFileError(f"{filename}: it is in metres and radians, and no convention applies")
    try:
        return getattr(import_module(ROOM), reader)(*given)  # type: ignore[no-any-return]
    except (TableError, UrdfError) as error:
        problems = getattr(error, "problems", (str(error),))
        raise TableFileError([f"{filename}: {problem}" for problem in problems]) from None
