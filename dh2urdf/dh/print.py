"""How a DH table prints: text, HTML, Markdown, LaTeX; angles in degrees, lengths in metres."""

import math
from collections.abc import Sequence
from typing import Protocol

from dh2urdf import grids
from dh2urdf.dh.motions import DHConvention
from dh2urdf.dh.quoting import latex, markdown, one_line
from dh2urdf.dh.row import DHRow, Origin
from dh2urdf.grids import number

ROUNDING = 4e-16
"""Relative difference of two conversions from degrees, each rounded once."""

COLUMNS = {
    "i": ("i", "$i$"),
    "name": ("joint", "joint"),
    "theta": ("θ [deg]", r"$\theta_i$ [deg]"),
    "d": ("d [m]", r"$d_i$ [m]"),
    "a": ("a [m]", r"$a_i$ [m]"),
    "alpha": ("α [deg]", r"$\alpha_i$ [deg]"),
    "limits": ("limits of q", "limits of $q_i$"),
    "step": ("fixed step", "fixed step"),
}
"""Heads of the columns by key, in plain text and in LaTeX."""


class _Table(Protocol):
    """What is printed of a DH table."""

    @property
    def name(self) -> str: ...
    @property
    def rows(self) -> Sequence[DHRow]: ...
    @property
    def convention(self) -> DHConvention: ...
    @property
    def base(self) -> Origin: ...
    @property
    def tool(self) -> Origin: ...
    @property
    def n(self) -> int: ...
    @property
    def joint_names(self) -> Sequence[str]: ...


def degrees(value: float) -> str:
    """Degrees of an angle [rad], as few digits as read back to the same angle."""
    exact = math.degrees(value)
    for digits in range(1, 17):
        short = float(f"{exact:.{digits}g}")
        if math.isclose(math.radians(short), value, rel_tol=ROUNDING):
            return number(short)
    return number(exact)


def plus(variable: str, offset: str) -> str:
    """``variable + offset`` with zero left out and a minus sign folded in."""
    if offset == "0":
        return variable
    minus = "\N{MINUS SIGN}"
    if offset.startswith(minus):
        return f"{variable} {minus} {offset.removeprefix(minus)}"
    return f"{variable} + {offset}"


def table_grid(table: _Table) -> tuple[list[str], list[str], list[list[str]]]:
    """Keys, header and cells of a table; columns that say nothing are left out."""
    rows, joint = [], 0
    for row in table.rows:
        joint += row.is_joint
        name = one_line(table.joint_names[joint - 1]) if row.is_joint else ""
        rows.append(_cells(row, joint, name))
    own, head = [*COLUMNS], [plain for plain, _ in COLUMNS.values()]
    kept = [k for k, key in enumerate(own) if key in own[:6] or any(r[k] for r in rows)]
    keys, header, *cells = ([r[k] for k in kept] for r in (own, head, *rows))
    return keys, header, cells


def _cells(row: DHRow, i: int, name: str) -> list[str]:
    theta, d = degrees(row.theta), number(row.d)
    if not row.is_joint:
        if row.origin is not None:
            return ["", "fixed", "", "", "", "", "", step(row.origin)]
        return ["", "fixed", theta, d, number(row.a), degrees(row.alpha), "", ""]
    sign = "" if row.sign > 0 else "\N{MINUS SIGN}"
    slides = row.joint_type == "prismatic"
    if slides:
        d = plus(f"{sign}q{i}", d)
    else:
        theta = plus(f"{sign}q{i}", theta)
    show = number if slides else degrees
    low = "" if row.lower is None else show(row.lower)
    high = "" if row.upper is None else show(row.upper)
    unit = " m" if slides else "°"
    limits = f"{low or '…'} to {high or '…'}{unit}" if low or high else ""
    return [str(i), name, theta, d, number(row.a), degrees(row.alpha), limits, ""]


def step(origin: Origin) -> str:
    """A rigid step in words: ``xyz (0, 1.5, 0) m, rpy (0, 0, 90) deg``."""
    xyz = ", ".join(number(v) for v in origin.xyz)
    rpy = ", ".join(degrees(v) for v in origin.rpy)
    return f"xyz ({xyz}) m" + (f", rpy ({rpy}) deg" if any(origin.rpy) else "")


def title(table: _Table) -> str:
    """Name and convention, and the base and tool where there are any."""
    lines = [
        f"{one_line(table.name)}: {table.n} joint{'s' * (table.n != 1)}, {table.convention} DH"
    ]
    steps = {"base": table.base, "tool": table.tool}
    lines += [f"{key}: {step(origin)}" for key, origin in steps.items() if not origin.is_identity]
    return "\n".join(lines)


def table_text(table: _Table) -> str:
    """The table for a terminal."""
    _, header, rows = table_grid(table)
    return f"{title(table)}\n\n{grids.grid_text(header, rows)}"


def table_markdown(table: _Table) -> str:
    """The table as a Markdown pipe table, angles in degrees."""
    keys, header, rows = table_grid(table)
    at = keys.index("name")
    cells = [[markdown(c) if k == at else c for k, c in enumerate(row)] for row in rows]
    return grids.grid_markdown(header, cells)


def table_html(table: _Table) -> str:
    """The table for a notebook."""
    keys, header, rows = table_grid(table)
    return grids.grid_html(header, rows, keys=keys, caption=title(table))


def table_csv(table: _Table) -> str:
    """The table as comma-separated values as shown, angles in degrees."""
    _, header, rows = table_grid(table)
    return grids.grid_csv(header, rows)


def table_latex(table: _Table) -> str:
    """The table as a LaTeX ``tabular`` (package booktabs), angles in degrees."""
    keys, _, rows = table_grid(table)
    cells = [[_latex_cell(key, text) for key, text in zip(keys, row, strict=True)] for row in rows]
    return grids.grid_latex([COLUMNS[key][1] for key in keys], cells)


def _latex_cell(key: str, text: str) -> str:
    if key == "name":
        return latex(text)
    plain = text.replace("\N{MINUS SIGN}", "-").replace("…", r"\ldots{}")
    if key in {"theta", "d", "a", "alpha"} and plain:
        head, mark, index = plain.partition("q")
        if mark:
            digits = index[: len(index) - len(index.lstrip("0123456789"))]
            return f"${head}q_{{{digits}}}{index[len(digits) :]}$"
        return f"${plain}$"
    return plain.replace("°", r"$^\circ$")
