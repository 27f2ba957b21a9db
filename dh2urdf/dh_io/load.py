"""A DH table by path or by name."""

import difflib
import os
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.dh_io.cells.told import NOTHING, Told, told
from dh2urdf.dh_io.files import path_of, shown
from dh2urdf.dh_io.forms import CONF, read_conf_file
from dh2urdf.dh_io.read import FORMATS, TableFile, read_table
from dh2urdf.exceptions import ArgumentError, NameNotFoundError

FOLDER = Path(__file__).parents[1] / "robots"
"""Tables that ship, one YAML file an arm."""

TableLike = DHTable | str | os.PathLike[str]


@lru_cache(maxsize=1)
def list_tables() -> tuple[str, ...]:
    """Names of the tables that ship, sorted."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.yaml")))


def as_table(table: TableLike) -> DHTable:
    """A table, or the one of a path or name; the door of every function that takes a table."""
    return table if isinstance(table, DHTable) else load_table(table)


def load_table(
    path: str | os.PathLike[str],
    convention: DHConvention | str | None = None,
    units: Iterable[str] | str | None = None,
    *,
    model: str | None = None,
) -> DHTable:
    """A DH table from a file, or one that ships, by name.

    Parameters
    ----------
    path : path or str
        A table file (``.yaml``, ``.toml``, ``.json``, ``.csv``, ``.md``), a URDF written by this
        package (``.urdf``: the table that it carries), or a name of :func:`list_tables`; files of
        OPW parameters, joint axes or KDL segments (YAML, JSON), UR's ``calibration.yaml`` and
        ``calibration.conf``, too.
    convention, units : optional
        For a file that does not say them: ``"modified"``, ``"mm,deg"``. One that says otherwise
        is refused.
    model : str, optional
        The UR that a ``calibration.conf`` belongs to, as ``"ur5e"``: its deltas add to the nominal
        table. Without it, the only UR that they fit, or an error.

    Raises
    ------
    TableFileError
        Every fault of the file at once.
    NameNotFoundError
        Neither a file nor a name; the message lists the names that are near.
    """
    return load_table_file(path, told(convention, units, model=model)).table


def load_table_file(path: str | os.PathLike[str], told: Told = NOTHING) -> TableFile:
    """Like :func:`load_table`, with what looked odd about the file."""
    where = path_of(path, "table", "a DHTable, a path or the name of a table that ships")
    if where.suffix.lower() == CONF:
        return TableFile(*read_conf_file(where, told))
    if told.model is not None:
        raise ArgumentError(f"model: only a calibration.conf needs it, not {shown(where)}")
    if where.suffix.lower() == ".urdf":
        from dh2urdf.dh_io.xml import embedded_table

        return TableFile(embedded_table(where), ())
    if isinstance(path, str) and path in list_tables():
        return read_table(FOLDER / f"{path}.yaml", told=told)
    if where.suffix.lower() in FORMATS or os.path.exists(where):
        return read_table(where, told=told)
    names = list_tables()
    close = difflib.get_close_matches(where.name, names, 3, 0.5)
    hint = f"did you mean {' or '.join(close)}?" if close else "`dh2urdf list` names them"
    raise NameNotFoundError(f"{shown(path)}: neither a file nor a table that ships; {hint}")
