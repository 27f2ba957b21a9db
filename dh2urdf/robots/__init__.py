"""Tables that ship: one YAML file an arm, with its source and the check that it passed."""

from __future__ import annotations

import difflib
import os
from functools import lru_cache
from pathlib import Path

from dh2urdf.dh import DHTable
from dh2urdf.dh_io import FORMATS, TableFile, read_table
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import NameNotFoundError

__all__ = ["list_tables", "load_table", "load_table_file"]

FOLDER = Path(__file__).parent


@lru_cache(maxsize=1)
def list_tables() -> tuple[str, ...]:
    """Names of the tables that ship, sorted."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.yaml")))


def load_table(path: str | os.PathLike[str]) -> DHTable:
    """A DH table from a file, or one that ships, by name.

    Parameters
    ----------
    path : path or str
        A table file (``.yaml``, ``.toml``, ``.json``, ``.csv``, ``.md``), a URDF written by this
        package (``.urdf``: the table that it carries), or a name of :func:`list_tables`.

    Raises
    ------
    TableFileError
        Every fault of the file at once.
    NameNotFoundError
        Neither a file nor a name; the message lists the names that are near.
    """
    return load_table_file(path).table


def load_table_file(path: str | os.PathLike[str]) -> TableFile:
    """Like :func:`load_table`, with what looked odd about the file."""
    if not isinstance(path, str | os.PathLike):
        raise NameNotFoundError(f"{path!r:.60}: expected a path or the name of a table that ships")
    where = Path(path)
    if where.suffix.lower() == ".urdf":
        from dh2urdf.conversions.write_urdf import embedded_table

        return TableFile(embedded_table(where), ())
    if isinstance(path, str) and path in list_tables():
        return read_table(FOLDER / f"{path}.yaml")
    if where.suffix.lower() in FORMATS or os.path.exists(where):
        return read_table(where)
    names = list_tables()
    close = difflib.get_close_matches(where.name, names, 3, 0.5)
    hint = f"did you mean {' or '.join(close)}?" if close else "`dh2urdf list` names them"
    raise NameNotFoundError(f"{shown(path)}: neither a file nor a table that ships; {hint}")
