"""What the columns of a table hold: keys of a row, labels of the rows, or nothing that is read."""

import re

from dh2urdf.dh_io.cells.cells import found
from dh2urdf.dh_io.cells.document import Mark, Report, Scalar
from dh2urdf.dh_io.cells.schema import FLAGS, MISUSED_KEYS, ROW_KEYS, TRUTHS, nearest
from dh2urdf.dh_io.formats.heading import (
    EMPTY,
    INDEX,
    LABELS,
    LIMITS,
    PARAMETERS,
    checked_unit,
    column,
    limits,
    without_name,
)
from dh2urdf.dh_io.formats.layout import Line

_COUNT = re.compile(r"\d*|\d+\s*(?:[-–→>]|->|to)+\s*\d+")
_NUMBER = re.compile(r"[-+−–]?[\d.,]+.*")


def columns_of(header: Line, rows: list[Line], report: Report) -> list[tuple[str, str]]:
    """Key and unit of each column; an empty key for a column that is not read."""
    out: list[tuple[str, str]] = []
    for number, cell in enumerate(header):
        key, unit = column(cell)
        taken = [k for k, _ in out]
        texts = [row[number].text for row in rows if number < len(row)]
        if key in INDEX:
            out.append(("", ""))
        elif key in LABELS or (number == 0 and _is_label(key, texts)):
            counting = all(map(_COUNT.fullmatch, texts))
            out.append(("" if counting or "name" in taken else "name", ""))
        elif key in FLAGS and all(text.casefold() in TRUTHS for text in texts):
            out.append((key, ""))
        elif key == "offset" and {"theta", "d"} <= {column(c)[0] for c in header}:
            out.append((key, unit))
        elif key in LIMITS and all(limits(text) or text in EMPTY for text in texts):
            out.append(("limits", checked_unit(cell, "lower", unit, report)))
        elif key not in ROW_KEYS:
            out.append((_unknown(cell, key, texts, taken, report), ""))
        elif key in taken:
            report.fault(cell.mark, "header", f"a second column for {key}: {found(cell)}")
            out.append(("", ""))
        else:
            out.append((key, checked_unit(cell, key, unit, report)))
    _refuse_nameless(header, rows, report)
    present = {k for k, _ in out}
    unclear = any(column(cell)[0] in MISUSED_KEYS.keys() - LIMITS for cell in header)
    missing = [k for k in PARAMETERS if k not in present]
    if missing and not unclear:
        mark = header[0].mark if header else Mark()
        report.fault(mark, "header", f"no column for {', '.join(missing)}")
    return out


def _is_label(key: str, texts: list[str]) -> bool:
    """Tell whether a first column of unknown name counts the rows or names them."""
    if key in ROW_KEYS or key in MISUSED_KEYS or nearest(key, ROW_KEYS):
        return False
    counted = [text for text in texts if text]
    counts = [str(k) for k in range(1, len(counted) + 1)]
    return counted == counts or not any(map(_NUMBER.fullmatch, counted))


def _unknown(cell: Scalar, key: str, texts: list[str], taken: list[str], report: Report) -> str:
    """What a column of unknown name stands for; a fault, unless it holds nothing but words."""
    near = nearest(key, ROW_KEYS)
    hint = MISUSED_KEYS.get(key) or (f"did you mean {near}?" if near else "")
    words = [text for text in texts if text not in EMPTY]
    if not hint and words and not any(map(_NUMBER.fullmatch, words)):
        report.warn(cell.mark, "header", f"the column {found(cell)} is not read")
        return ""
    message = f"unknown column {found(cell)}; allowed: {', '.join(ROW_KEYS)}"
    report.fault(cell.mark, "header", message, hint)
    return near if near not in taken and key not in MISUSED_KEYS else ""


def _refuse_nameless(header: Line, rows: list[Line], report: Report) -> None:
    """Only the first column, which then counts the rows, may hold values and have no name."""
    nameless = [k for k, cell in enumerate(header) if not column(cell)[0]]
    filled = [k for k in nameless if any(k < len(r) and r[k].text not in EMPTY for r in rows)]
    if filled not in ([], [0]):
        mark = header[filled[-1]].mark
        report.fault(mark, "header", without_name(filled), f"allowed: {', '.join(ROW_KEYS)}")
