"""How a DH table prints for people: text, HTML, LaTeX; in metres and degrees by default.

What programs read is written by `dh2urdf.dh_io`.
"""

import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

from dh2urdf import grids
from dh2urdf.dh.coupling import JointMap
from dh2urdf.dh.motions import DHConvention
from dh2urdf.dh.quoting import latex, one_line
from dh2urdf.dh.row import DHRow, Origin
from dh2urdf.dh.variables import MINUS, moved_by, plus
from dh2urdf.grids import number

ROUNDING = 4e-16
"""Relative difference of two conversions from degrees, each rounded once."""

COLUMNS = {
    "i": ("i", "$i$"),
    "name": ("joint", "joint"),
    "theta": ("θ", r"$\theta_i$"),
    "d": ("d", "$d_i$"),
    "a": ("a", "$a_i$"),
    "alpha": ("α", r"$\alpha_i$"),
    "limits": ("limits of q", "limits of $q_i$"),
    "step": ("fixed step", "fixed step"),
    "velocity": ("velocity", "velocity"),
    "effort": ("effort [N m or N]", "effort [N\\,m or N]"),
    "damping": ("damping [N m s/rad or N s/m]", "damping [N\\,m\\,s/rad or N\\,s/m]"),
    "friction": ("friction [N m or N]", "friction [N\\,m or N]"),
    "mass": ("mass [kg]", "$m_i$ [kg]"),
    "com": ("centre of mass in frame i", "centre of mass in frame $i$"),
    "inertia": (
        "inertia about it: ixx, ixy, ixz, iyy, iyz, izz [kg m²]",
        "about it $I_{xx}, I_{xy}, I_{xz}, I_{yy}, I_{yz}, I_{zz}$ [kg\\,m$^2$]",
    ),
}
"""Heads of the columns by key, in plain text and in LaTeX."""

PREVIOUS = {"a": ("aᵢ₋₁", "$a_{i-1}$"), "alpha": ("αᵢ₋₁", r"$\alpha_{i-1}$")}
"""Heads of the columns that a modified table takes from the link before."""

_DYNAMICS = ("velocity", "effort", "damping", "friction", "mass", "com", "inertia")


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
    @property
    def joint_map(self) -> JointMap | None: ...
    @property
    def source(self) -> str: ...
    @property
    def checked(self) -> str: ...


def degrees(value: float) -> str:
    """Degrees of an angle [rad], as few digits as read back to the same angle."""
    exact = math.degrees(value)
    for digits in range(1, 17):
        short = float(f"{exact:.{digits}g}")
        if math.isclose(math.radians(short), value, rel_tol=ROUNDING):
            return number(short)
    return number(exact)


class Look(NamedTuple):
    """Units in which a table prints, and how [m] and [rad] become a text in them."""

    length: str = "m"
    angle: str = "deg"
    of_length: Callable[[float], str] = number
    of_angle: Callable[[float], str] = degrees

    def limit(self, value: float, slides: bool) -> str:
        """A limit or speed, for reading: of seven digits or more in degrees, two decimals."""
        text = (self.of_length if slides else self.of_angle)(value)
        if slides or self.angle != "deg" or len(text.strip(MINUS).replace(".", "")) < 7:
            return text
        exact = math.degrees(value)
        return number(float(f"{exact:.3g}") if abs(exact) < 1 else round(exact, 2))

    def triple(self, values: Sequence[float]) -> str:
        """A point: ``(0, 1.5, 0) m``."""
        return f"({', '.join(map(self.of_length, values))}) {self.length}"


LOOK = Look()


def heads(table: _Table, look: Look = LOOK) -> dict[str, tuple[str, str]]:
    """Heads of the columns as the table's convention and the units have them."""
    named = COLUMNS | (PREVIOUS if table.convention is DHConvention.MODIFIED else {})
    units = dict.fromkeys(("theta", "alpha"), look.angle) | dict.fromkeys("da", look.length)
    return {
        key: (f"{plain} [{units[key]}]", f"{tex} [{units[key]}]") if key in units else (plain, tex)
        for key, (plain, tex) in named.items()
    }


def table_grid(table: _Table, look: Look = LOOK) -> tuple[list[str], list[str], list[list[str]]]:
    """Keys, header and cells of a table; columns that say nothing are left out."""
    rows, joint = [], 0
    for row in table.rows:
        joint += row.is_joint
        name = one_line(table.joint_names[joint - 1]) if row.is_joint else ""
        rows.append(_cells(table, row, joint, name, look))
    own, named = [*COLUMNS][:8], heads(table, look)
    kept = [k for k, key in enumerate(own) if key in own[:6] or any(r[k] for r in rows)]
    keys, header, *cells = ([r[k] for k in kept] for r in (own, [named[k][0] for k in own], *rows))
    return keys, header, cells


def _cells(table: _Table, row: DHRow, i: int, name: str, look: Look) -> list[str]:
    a, alpha = look.of_length(row.a), look.of_angle(row.alpha)
    if not row.is_joint:
        if row.origin is not None:
            return ["", "fixed", "", "", "", "", "", step(row.origin, look)]
        return ["", "fixed", look.of_angle(row.theta), look.of_length(row.d), a, alpha, "", ""]
    slides = row.joint_type == "prismatic"
    variable, constant = moved_by(table.joint_map, i - 1, row.sign)
    theta = look.of_angle(row.theta + (0.0 if slides else constant))
    d = look.of_length(row.d + (constant if slides else 0.0))
    if slides:
        d = plus(variable, d)
    else:
        theta = plus(variable, theta)
    return [str(i), name, theta, d, a, alpha, _limits(row, slides, look), ""]


def _limits(row: DHRow, slides: bool, look: Look) -> str:
    """The bounds of a row: of its value in q, and of the joint itself where they are others."""
    unit = f" {look.length}" if slides else "°" if look.angle == "deg" else f" {look.angle}"
    out = []
    own, serial = (row.lower, row.upper), (row.serial_lower, row.serial_upper)
    for word, ends in (("itself " if row.mimic else "", own), ("itself ", serial)):
        low, high = ("" if end is None else look.limit(end, slides) for end in ends)
        out += [f"{word}{low or '…'} to {high or '…'}{unit}"] if low or high else []
    return ", ".join(out)


def dynamics_grid(table: _Table, look: Look = LOOK) -> tuple[list[str], list[str], list[list[str]]]:
    """The same of speeds, efforts, losses and masses; no rows where the table has none."""
    rows = []
    for i, (name, row) in enumerate(
        zip(table.joint_names, (r for r in table.rows if r.is_joint), strict=True), 1
    ):
        rows.append([str(i), one_line(name), *(_dynamic(row, key, look) for key in _DYNAMICS)])
    keys, named = ["i", "name", *_DYNAMICS], heads(table, look)
    kept = [k for k in range(len(keys)) if k < 2 or any(row[k] for row in rows)]
    header = [named[keys[k]][0] for k in kept]
    cells = [[row[k] for k in kept] for row in rows] if len(kept) > 2 else []
    return [keys[k] for k in kept], header, cells


def _dynamic(row: DHRow, key: str, look: Look) -> str:
    value = getattr(row, key)
    if value is None:
        return ""
    if key == "com":
        return look.triple(value)
    if key == "velocity":
        slides = row.joint_type == "prismatic"
        return f"{look.limit(value, slides)} {look.length if slides else look.angle}/s"
    return ", ".join(map(number, value)) if key == "inertia" else number(value)


def step(origin: Origin, look: Look = LOOK) -> str:
    """A rigid step in words: ``xyz (0, 1.5, 0) m, rpy (0, 0, 90) deg``."""
    rpy = ", ".join(map(look.of_angle, origin.rpy))
    turn = f", rpy ({rpy}) {look.angle}" if any(origin.rpy) else ""
    return f"xyz {look.triple(origin.xyz)}{turn}"


def title(table: _Table, look: Look = LOOK) -> str:
    """Name and convention, and the base and tool where there are any."""
    lines = [
        f"{one_line(table.name)}: {table.n} joint{'s' * (table.n != 1)}, {table.convention} DH"
    ]
    if table.joint_map is not None:
        names = ", ".join(one_line(table.joint_names[i]) for i in table.joint_map.own)
        lines.append(f"q = ({names})")
    steps = {"base": table.base, "tool": table.tool}
    lines += [
        f"{key}: {step(origin, look)}" for key, origin in steps.items() if not origin.is_identity
    ]
    return "\n".join(lines)


def origins(table: _Table) -> list[str]:
    """Where the figures come from and what they were checked against, a line each."""
    texts = (("source", table.source), ("checked", table.checked))
    return [f"{key}: {' '.join(one_line(text).split())}" for key, text in texts if text]


def table_text(table: _Table, look: Look = LOOK) -> str:
    """The table for a terminal."""
    _, header, rows = table_grid(table, look)
    return f"{title(table, look)}\n\n{grids.grid_text(header, rows)}"


def table_html(table: _Table, look: Look = LOOK) -> str:
    """The table for a notebook."""
    keys, header, rows = table_grid(table, look)
    return grids.grid_html(header, rows, keys=keys, caption=title(table, look))


def html_page(table: _Table, look: Look = LOOK) -> str:
    """All of the table as a page of its own."""
    keys, header, rows = dynamics_grid(table, look)
    parts = [table_html(table, look)]
    parts += [grids.grid_html(header, rows, keys=keys, caption="dynamics")] if rows else []
    return grids.html_page(one_line(table.name), [*parts, *map(grids.paragraph, origins(table))])


def table_latex(table: _Table, look: Look = LOOK) -> str:
    """All of the table as a LaTeX ``table`` (package booktabs), angles in degrees."""
    named = heads(table, look)
    lines = [r"\begin{table}", r"\centering", rf"\caption{{{_latex_text(title(table, look))}}}"]
    for keys, _, rows in (table_grid(table, look), dynamics_grid(table, look)):
        if rows:
            cells = [[*map(_latex_cell, keys, row)] for row in rows]
            lines += [grids.grid_latex([named[key][1] for key in keys], cells), ""]
    lines += [rf"{{\footnotesize {_latex_text(line)}\par}}" for line in origins(table)]
    return "\n".join([*lines, r"\end{table}"])


def _latex_text(text: str) -> str:
    """Lines of words and numbers as one paragraph."""
    plain = "; ".join(map(latex, text.split("\n")))
    return plain.replace(MINUS, "$-$").replace("…", r"\ldots{}").replace("°", r"$^\circ$")


def _latex_cell(key: str, text: str) -> str:
    if key in {"theta", "d", "a", "alpha"} and text:
        plain = text.replace(MINUS, "-")
        return "$" + re.sub("q([0-9]+)", r"q_{\1}", plain) + "$"
    return latex(text) if key == "name" else _latex_text(text)
