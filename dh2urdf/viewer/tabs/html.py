"""Small pieces of HTML for the panel; everything that is not ours is escaped."""

import math
from html import escape

from dh2urdf.dh import DHTable
from dh2urdf.dh.print import table_grid
from dh2urdf.drawing.colours import QUANTITY
from dh2urdf.grids import number
from dh2urdf.transforms import Array, matrix_to_rpy
from dh2urdf.viewer.arm_scene import quaternions

STYLE = "font-size:12px;line-height:1.5;padding:2px 12px 6px;overflow-x:auto;"
CELL = "text-align:right;padding:1px 7px;white-space:nowrap;"
NUMBERS = "font-variant-numeric:tabular-nums;"
FAINT = "#b0b0b0"
MARKED = "background:#e6eef7;font-weight:600;"
KINDS = {"info": ("#46505f", ""), "good": ("#1c7c45", "✓ "), "bad": ("#b3261e", "✗ ")}


def message(text: str, kind: str = "info") -> str:
    """A note in the panel: plain, good or bad; lines are kept."""
    colour, mark = KINDS[kind]
    role = "alert" if kind == "bad" else "status"
    return (
        f'<div role="{role}" style="{STYLE}color:{colour};white-space:pre-wrap">'
        f"{mark}{escape(text)}</div>"
    )


def pose(T: Array, what: str) -> str:
    """A pose: xyz in millimetres, rpy in degrees, quaternion with w last."""
    w, x, y, z = quaternions(T[:3, :3])
    rows = (
        ("xyz [mm]", [round(v * 1000, 3) for v in T[:3, 3]]),
        ("rpy [°]", [round(math.degrees(v), 3) for v in matrix_to_rpy(T)]),
        ("quaternion xyzw", [round(float(v), 6) for v in (x, y, z, w)]),
    )
    body = ""
    for name, values in rows:
        cells = "".join(f'<td style="{CELL}{NUMBERS}">{number(v + 0.0)}</td>' for v in values)
        body += f'<tr><td style="{CELL}text-align:left;color:#6b7280">{name}</td>{cells}</tr>'
    return f'<div style="{STYLE}"><b>{escape(what)}</b><table>{body}</table></div>'


def matrix(T: Array, name: str) -> str:
    """A (4, 4) matrix, four digits after the point."""
    body = ""
    for row in T.tolist():
        faint = [f"color:{FAINT}" if abs(v) < 5e-5 else "" for v in row]
        texts = zip(faint, (number(round(v, 4) + 0.0) for v in row), strict=True)
        body += "<tr>" + "".join(f'<td style="{CELL}{NUMBERS}{f}">{t}</td>' for f, t in texts)
        body += "</tr>"
    border = "border-left:1.5px solid #888;border-right:1.5px solid #888;border-radius:4px"
    return f'<div style="{STYLE}"><b>{name}</b> =<table style="{border}">{body}</table></div>'


def table(dh: DHTable, row: int = 0) -> str:
    """The DH table, quantities in their colours, one row marked."""
    keys, header, rows = _without_names(*table_grid(dh))
    head = "".join(
        f'<th style="{CELL}color:{QUANTITY.get(k, "inherit")}">{escape(h)}</th>'
        for k, h in zip(keys, header, strict=True)
    )
    body = ""
    for cells in rows:
        body += f'<tr style="{MARKED if cells[0] == str(row) else ""}">'
        for key, text in zip(keys, cells, strict=True):
            colour = FAINT if text in {"0", "0°"} else QUANTITY.get(key, "inherit")
            body += f'<td style="{CELL}{NUMBERS}color:{colour}">{escape(text)}</td>'
        body += "</tr>"
    return (
        f'<div style="{STYLE}"><table style="border-collapse:collapse" data-dh="table">'
        f'<thead><tr style="border-bottom:1px solid #999">{head}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def _without_names(
    keys: list[str], header: list[str], rows: list[list[str]]
) -> tuple[list[str], list[str], list[list[str]]]:
    """The grid without names and limits, which the joints' sliders show; fixed rows keep theirs."""
    kept = [k for k, key in enumerate(keys) if key not in {"name", "limits"}]
    name = keys.index("name")
    cells = [[row[k] or (row[name] if k == 0 else "") for k in kept] for row in rows]
    return [keys[k] for k in kept], [header[k] for k in kept], cells
