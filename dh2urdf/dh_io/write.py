"""A table to a text: every number by its shortest decimal that reads back as the same float."""

import json
import os
import re
from collections.abc import Callable, Sequence
from pathlib import Path

from dh2urdf.dh import DHRow, DHTable, JointType, Origin
from dh2urdf.dh.quoting import markdown
from dh2urdf.dh_io.atomic import atomic_write
from dh2urdf.dh_io.cells.schema import ROW_KEYS, ROW_KINDS
from dh2urdf.dh_io.cells.units import SI, UNIT_SIZES, Kind, Units, decimal_text
from dh2urdf.dh_io.files import path_of
from dh2urdf.dh_io.load import TableLike, as_table
from dh2urdf.dh_io.read import format_of
from dh2urdf.doors import choice, instance
from dh2urdf.exceptions import TableError
from dh2urdf.grids import grid_csv, grid_markdown

Field = tuple[str, str | list[str]]
"""Key of a cell, and its text (already quoted where it is a word) or a list of numbers."""

Quote = Callable[[str], str]
Widths = dict[str, int]

_FIELDS = ROW_KEYS[ROW_KEYS.index("theta") : ROW_KEYS.index("inertia_frame")]

_PLAIN = re.compile(r"[A-Za-z_][\w./-]*", re.ASCII)
_PLAIN_LINE = re.compile(r"[A-Za-z][^:#|\\\"*`]*")
_MARKUP = re.compile(r"[`*<>&\[\]|~$!_]")
_WORDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n", "n/a"}


def write_table(
    table: TableLike, path: str | os.PathLike[str], *, format: str | None = None, units: Units = SI
) -> Path:
    """Write a table to a YAML, TOML, JSON, CSV or Markdown file, whole or not at all.

    Parameters
    ----------
    table : DHTable, path or name of a table that ships
    path : path
    format : str, optional
        ``yaml``, ``toml``, ``json``, ``csv`` or ``markdown``; by the suffix where not given.
    units : Units
        Units of the file. In any of them every number reads back as the same float.

    Raises
    ------
    TableError
        A format or unit that is not known.
    OutputError
        The file cannot be written; an older one stays as it was.
    """
    return atomic_write(path, table_to_text(table, format or format_of(path_of(path)), units))


def table_to_text(table: TableLike, format: str, units: Units = SI) -> str:
    """Text of a table in one of the formats.

    Parameters
    ----------
    table : DHTable, path or name of a table that ships
    format : str
        ``yaml``, ``toml``, ``json``, ``csv`` or ``markdown``.
    units : Units
    """
    table, pair = as_table(table), instance(units, "units", tuple, TableError)
    kinds = zip((Kind.LENGTH, Kind.ANGLE), pair, strict=False)
    known = [choice(unit, f"units.{k}", UNIT_SIZES[k], TableError) for k, unit in kinds]
    return _WRITERS[choice(format, "format", _WRITERS, TableError)](table, Units(*known))


def _words(table: DHTable) -> list[tuple[str, str]]:
    """Texts of the table itself, the empty ones left out."""
    keys = ("name", "source", "checked")
    pairs = [(k, str(getattr(table, k))) for k in keys if getattr(table, k)]
    return [*pairs, ("convention", str(table.convention))]


def _origins(table: DHTable, units: Units) -> list[tuple[str, list[Field]]]:
    pairs = (("base", table.base), ("tool", table.tool))
    return [(key, _origin(origin, units)) for key, origin in pairs if not origin.is_identity]


def _origin(origin: Origin, units: Units) -> list[Field]:
    return [
        ("xyz", [decimal_text(v, units.length) for v in origin.xyz]),
        ("rpy", [decimal_text(v, units.angle) for v in origin.rpy]),
    ]


def _row(row: DHRow, units: Units, quote: Quote) -> list[Field]:
    """Cells of a row in the order of the keys, those left out that say nothing."""
    out: list[Field] = [("name", quote(row.name))] if row.name else []
    out.append(("type", quote(str(row.joint_type))))
    if row.origin is not None:
        return out + _origin(row.origin, units)
    moved = Kind.LENGTH if row.joint_type is JointType.PRISMATIC else Kind.ANGLE
    kinds = {**ROW_KINDS, **dict.fromkeys(("lower", "upper", "velocity"), moved)}
    for key in _FIELDS:
        value, unit = getattr(row, key), units.of(kinds.get(key, Kind.NUMBER))
        if value is None or (key == "sign" and value == 1):
            continue
        vector = isinstance(value, tuple)
        text = [decimal_text(v, unit) for v in value] if vector else decimal_text(value, unit)
        out.append((key, text))
    return out


def _escaped(text: str) -> str:
    """Text in double quotes as YAML and TOML read it."""
    out = []
    for character in text:
        code = ord(character)
        if character in '"\\':
            out.append("\\" + character)
        elif character.isprintable():
            out.append(character)
        else:
            out.append(f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}")
    return '"' + "".join(out) + '"'


def _yaml_word(text: str) -> str:
    plain = _PLAIN.fullmatch(text) and text.casefold() not in _WORDS
    return text if plain else _escaped(text)


def _is_plain_line(text: str) -> bool:
    """Tell whether a text can stand after ``key:`` as it is, on a line of its own."""
    plain = _PLAIN_LINE.fullmatch(text) and text.casefold() not in _WORDS
    return bool(plain) and markdown(text) == text


def _yaml_line(text: str) -> str:
    return text if _is_plain_line(text) else _escaped(text)


def _json_word(text: str) -> str:
    return json.dumps(text, ensure_ascii=not text.isprintable())


def _line_word(text: str) -> str:
    """Text for one line of a CSV or Markdown file."""
    if _is_plain_line(text):
        return text
    return _MARKUP.sub(lambda sign: f"\\u{ord(sign[0]):04x}", json.dumps(text))


def _inline(fields: Sequence[Field], equals: str, key: Quote, widths: Widths | None = None) -> str:
    """``{key: value, ...}`` on one line, numbers to the right and words to the left."""
    text = ""
    for k, v in fields:
        value = v if isinstance(v, str) else f"[{', '.join(v)}]"
        pad = " " * ((widths or {}).get(k, 0) - len(value))
        word = k in ("name", "type")
        text += f"{key(k)}{equals}" + (f"{value}, {pad}" if word else f"{pad}{value}, ")
    return "{" + text.rstrip(" ,") + "}"


def _widths(rows: list[list[Field]]) -> Widths:
    """Widest cell of each key, so that columns show."""
    cells = sorted((len(text), key) for row in rows for key, text in row if isinstance(text, str))
    return {key: width for width, key in cells}


def _parts(
    table: DHTable, units: Units, equals: str, key: Quote, line: Quote, word: Quote
) -> tuple[list[str], list[str]]:
    """Lines of the table's own keys, and of its rows, as a language puts keys and words."""
    head = [f"{key(k)}{equals}{line(text)}" for k, text in _words(table)]
    pair: list[Field] = [("length", word(units.length)), ("angle", word(units.angle))]
    steps = [("units", pair), *_origins(table, units)]
    head += [f"{key(k)}{equals}{_inline(fields, equals, key)}" for k, fields in steps]
    rows = [_row(row, units, word) for row in table.rows]
    widths = _widths(rows)
    return head, [_inline(row, equals, key, widths) for row in rows]


def _yaml(table: DHTable, units: Units) -> str:
    head, rows = _parts(table, units, ": ", str, _yaml_line, _yaml_word)
    return "\n".join([*head, "joints:", *(f"  - {row}" for row in rows)]) + "\n"


def _toml(table: DHTable, units: Units) -> str:
    head, rows = _parts(table, units, " = ", str, _escaped, _escaped)
    return "\n".join([*head, "joints = [", *(f"  {row}," for row in rows), "]"]) + "\n"


def _json(table: DHTable, units: Units) -> str:
    head, rows = _parts(table, units, ": ", _json_word, _json_word, _json_word)
    body = ",\n".join(f"    {row}" for row in rows)
    lines = [*(f"  {line}" for line in head), f'  "joints": [\n{body}\n  ]']
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _lines(table: DHTable, units: Units) -> list[str]:
    """The table's own keys as ``key: value`` lines."""
    lines = [f"{key}: {_line_word(text)}" for key, text in _words(table)]
    lines.append(f"units: {units.length}, {units.angle}")
    for key, fields in _origins(table, units):
        lines += [f"{key}.{part}: {' '.join(values)}" for part, values in fields]
    return lines


def _grid(table: DHTable, units: Units) -> tuple[list[str], list[list[str]]]:
    """Header and cells; a column that no row fills is left out, save the four parameters."""
    rows = [dict(_row(row, units, _line_word)) for row in table.rows]
    header = [k for k in ROW_KEYS if k in ("theta", "d", "a", "alpha") or any(k in r for r in rows)]
    cells = [[r.get(k, "") for k in header] for r in rows]
    return header, [[c if isinstance(c, str) else " ".join(c) for c in row] for row in cells]


def _csv(table: DHTable, units: Units) -> str:
    head = "".join(f"# {line}\n" for line in _lines(table, units))
    return head + grid_csv(*_grid(table, units))


def _markdown(table: DHTable, units: Units) -> str:
    head = "\n".join(["---", *_lines(table, units), "---", "", ""])
    return head + grid_markdown(*_grid(table, units)) + "\n"


_WRITERS: dict[str, Callable[[DHTable, Units], str]] = {
    "yaml": _yaml,
    "toml": _toml,
    "json": _json,
    "csv": _csv,
    "markdown": _markdown,
}
