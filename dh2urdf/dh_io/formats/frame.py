"""A table held in Python to a document: data frames, structured arrays, columns, records."""

from collections.abc import Iterable, Mapping
from itertools import islice, zip_longest
from typing import Any

import numpy as np

from dh2urdf.bounds import ROWS
from dh2urdf.dh_io.cells.document import Keys, Mark, Report, Scalar
from dh2urdf.dh_io.formats.grid import grid_document
from dh2urdf.dh_io.formats.heading import is_header
from dh2urdf.dh_io.formats.layout import Grid
from dh2urdf.doors import found


def is_frame(data: object) -> bool:
    """Tell whether an object has named columns: a frame, a structured array, mappings."""
    return (
        isinstance(data, Mapping)
        or (isinstance(data, list | tuple) and any(isinstance(row, Mapping) for row in data))
        or getattr(getattr(data, "dtype", None), "names", None) is not None
        or (hasattr(data, "columns") and not callable(data.columns))
    )


def read_frame(data: Any, report: Report) -> Keys:
    """Read an object with named columns, a row a joint."""
    header, rows = _parts(data)
    report.count(Mark(), cells=len(header) * (1 + len(rows)))
    heads = [Scalar(str(name)) for name in header]
    if not is_header(heads):
        named = ", ".join(found(head.text) for head in heads[:12])
        hint = "name them theta, d, a and alpha, or theta_deg, d_mm, a_mm and alpha_deg"
        report.stop(Mark(), f"no columns theta, d, a and alpha among {named or 'none'}", hint)
    return grid_document(Grid([], heads, [list(map(_cell, row)) for row in rows]), report)


def _parts(data: Any) -> tuple[list[Any], list[tuple[Any, ...]]]:
    """Names of the columns, and the rows, of which there are no more than a table may have."""
    if isinstance(data, list | tuple):
        records = [row if isinstance(row, Mapping) else {} for row in data[: ROWS + 1]]
        keys = list(dict.fromkeys(key for record in records for key in record))
        return keys, [tuple(record.get(key) for key in keys) for record in records]
    if isinstance(data, Mapping):
        columns = [np.atleast_1d(np.asarray(c, dtype=object)).tolist() for c in data.values()]
        return list(data), list(islice(zip_longest(*columns), ROWS + 1))
    if (names := getattr(getattr(data, "dtype", None), "names", None)) is not None:
        return list(names), np.ravel(data)[: ROWS + 1].tolist()
    rows: Iterable[Any]
    if hasattr(data, "itertuples"):
        rows = data.itertuples(index=False, name=None)
    else:
        rows = data.iter_rows() if hasattr(data, "iter_rows") else data
    return list(data.columns), [tuple(row) for row in islice(rows, ROWS + 1)]


def _cell(value: Any) -> Scalar:
    """A number by its shortest decimal, a vector by its numbers, nothing for what is missing."""
    if isinstance(value, list | tuple | np.ndarray):
        return Scalar(" ".join(_cell(part).text for part in value))
    if value is None or (isinstance(value, float | np.floating) and np.isnan(value)):
        return Scalar("")
    if isinstance(value, bool | np.bool_):
        return Scalar(str(bool(value)).casefold())
    text = str(value)
    return Scalar("" if text in ("<NA>", "NaT") else text)
