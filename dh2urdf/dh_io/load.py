"""A DH table by path or by name."""

import os
from collections.abc import Iterable
from typing import Any

from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.dh_io.cells.document import Report
from dh2urdf.dh_io.cells.told import NOTHING, Told, told
from dh2urdf.dh_io.checker import check_document
from dh2urdf.dh_io.files import path_of, shown
from dh2urdf.dh_io.forms import CONF, read_conf_file, refuse_model
from dh2urdf.dh_io.names import FOLDER, list_tables, near_names, shipped_name
from dh2urdf.dh_io.read import FORMATS, TableFile, read_table
from dh2urdf.exceptions import NameNotFoundError

TableLike = DHTable | str | os.PathLike[str]


def as_table(table: TableLike) -> DHTable:
    """A table, or the one of a path or name; the door of every function that takes a table."""
    return table if isinstance(table, DHTable) else load_table(table)


def load_table(
    path: str | os.PathLike[str] | Any,
    convention: DHConvention | str | None = None,
    units: Iterable[str] | str | None = None,
    *,
    model: str | None = None,
) -> DHTable:
    """A DH table from a file, one that ships, by name, or one held in a data frame.

    Parameters
    ----------
    path : path, str, or what has named columns
        A table file (``.yaml``, ``.toml``, ``.json``, ``.csv``, ``.md``), a URDF written by this
        package (``.urdf``: the table that it carries), or a name of :func:`list_tables`; files of
        OPW parameters, joint axes or KDL segments (YAML, JSON), UR's ``calibration.yaml`` and
        ``calibration.conf``, too. A data frame, a structured array, a dictionary of columns
        or a list of dictionaries is read as a CSV file is, headings with units included.
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

    Examples
    --------
    >>> from dh2urdf import load_table
    >>> table = load_table("planar_rr")
    >>> print(table)
    planar_rr: 2 joints, standard DH
    <BLANKLINE>
    i    joint  θ [deg]  d [m]  a [m]  α [deg]   limits of q
    ────────────────────────────────────────────────────────
    1  joint_1       q1      0      1        0  −180 to 180°
    2  joint_2       q2      0    0.7        0  −180 to 180°
    >>> load_table([{"theta": 0, "d": 335, "a": 75, "alpha": -90}], "standard", "mm,deg").rows[0].d
    0.335
    """
    given = told(convention, units, model=model)
    if not isinstance(path, str | os.PathLike):
        from dh2urdf.dh_io.formats.frame import is_frame, read_frame

        if is_frame(path):
            report = Report("columns", "", "frame")
            return check_document(read_frame(path, report), report, "robot", given)[0]
    return load_table_file(path, given).table


def load_table_file(path: str | os.PathLike[str], told: Told = NOTHING) -> TableFile:
    """Like :func:`load_table`, with what looked odd about the file."""
    where = path_of(path, "table", "a DHTable, a path or the name of a table that ships")
    if where.suffix.lower() == CONF:
        return TableFile(*read_conf_file(where, told))
    refuse_model(told, shown(where))
    if where.suffix.lower() in (".urdf", ".xml", ".mjcf"):
        from dh2urdf.dh_io.xml import embedded_table

        return TableFile(embedded_table(where), ())
    if isinstance(path, str) and path in list_tables():
        return read_table(FOLDER / f"{path}.yaml", told=told)
    if where.suffix.lower() in FORMATS or os.path.exists(where):
        return read_table(where, told=told)
    if (name := shipped_name(os.fsdecode(path))) is not None:
        return read_table(FOLDER / f"{name}.yaml", told=told)
    close = near_names(where.name)
    hint = f"did you mean {' or '.join(close)}?" if close else "`dh2urdf list` names them"
    raise NameNotFoundError(f"{shown(path)}: neither a file nor a table that ships; {hint}")
