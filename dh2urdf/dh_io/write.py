"""A table to a file or a text, in formats that read back and in formats for reading."""

import os
from pathlib import Path

from dh2urdf.dh import DHTable
from dh2urdf.dh_io.atomic import atomic_write
from dh2urdf.dh_io.cells.units import SI, UNIT_SIZES, Kind, Units
from dh2urdf.dh_io.files import path_of
from dh2urdf.dh_io.load import TableLike, as_table
from dh2urdf.dh_io.read import FORMATS, format_of
from dh2urdf.doors import choice, instance, integer
from dh2urdf.exceptions import TableError

READ_BACK = tuple(dict.fromkeys(FORMATS.values()))
"""Formats that are read as the table that was written; the others are for people."""

WRITTEN = FORMATS | {".tex": "latex", ".html": "html", ".htm": "html"}
"""Format of a file that is written, by its suffix."""


def write_table(
    table: TableLike,
    path: str | os.PathLike[str],
    *,
    format: str | None = None,
    units: Units = SI,
    digits: int | None = None,
) -> Path:
    """Write a table to a YAML, TOML, JSON, CSV, Markdown, LaTeX or HTML file, whole or not at all.

    Parameters
    ----------
    table : DHTable, path or name of a table that ships
    path : path
    format : str, optional
        ``yaml``, ``toml``, ``json``, ``csv`` or ``markdown``, which read back as the same table,
        ``latex`` or ``html``, which people read; by the suffix where not given.
    units : Units
        Units of the file. In any of them every number reads back as the same float.
    digits : int, optional
        Round lengths, angles and limits to so many decimals of the file's units.

    Raises
    ------
    TableError
        A format or unit that is not known.
    OutputError
        The file cannot be written; an older one stays as it was.

    Examples
    --------
    >>> import os, tempfile
    >>> from dh2urdf import load_table, save_table
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = save_table("puma560", os.path.join(folder, "puma.toml"))
    ...     load_table(path) == load_table("puma560")
    True
    """
    where = path_of(path)
    chosen = format or WRITTEN.get(where.suffix.casefold()) or format_of(where)
    return atomic_write(path, table_to_text(table, chosen, units, digits))


def table_to_text(
    table: TableLike, format: str, units: Units = SI, digits: int | None = None
) -> str:
    """Text of a table in one of the formats; parameters as of :func:`write_table`."""
    from dh2urdf.dh_io.formats.written import WRITERS, Numbers

    table, pair = as_table(table), instance(units, "units", tuple, TableError)
    if digits is not None:
        digits = integer(digits, "digits", 0, 17, TableError)
    kinds = zip((Kind.LENGTH, Kind.ANGLE), pair, strict=False)
    known = [choice(unit, f"units.{k}", UNIT_SIZES[k], TableError) for k, unit in kinds]
    write = WRITERS[choice(format, "format", WRITERS, TableError)]
    return write(table, Numbers(Units(*known), digits))


def usual_units(table: DHTable, format: str, given: Units | None) -> Units:
    """Units in which a table is written where nobody chose them.

    Those of the file that it was read from; without one, metres and the angles that take fewer
    digits. People get degrees.
    """
    if given is None:
        either = (Units("m", angle) for angle in UNIT_SIZES[Kind.ANGLE])
        given = min(either, key=lambda units: len(table_to_text(table, "json", units)))
    return given if format in READ_BACK else given._replace(angle="deg")
