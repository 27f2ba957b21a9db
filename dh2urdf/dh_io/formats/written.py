"""Writers of every format: numbers by the shortest decimals that read back as the same floats."""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin
from dh2urdf.dh.print import Look, degrees, heads, html_page, table_latex, table_text
from dh2urdf.dh.quoting import markdown
from dh2urdf.dh.variables import MINUS
from dh2urdf.dh_io.cells.schema import BY_TYPE, ROW_KEYS, ROW_KINDS
from dh2urdf.dh_io.cells.units import Kind, Units, decimal_text
from dh2urdf.grids import grid_csv, grid_markdown

Field = tuple[str, str | list[str]]
"""Key of a cell, and its text (already quoted where it is a word) or a list of numbers."""

MARK = "written from a DH table"
"""In files for reading, by which their writer knows them again."""

Quote = Callable[[str], str]
Nest = Callable[[list[Field]], str]
Widths = dict[str, int]

_FIELDS = ROW_KEYS[ROW_KEYS.index("theta") : ROW_KEYS.index("inertia_frame")]

_PLAIN = re.compile(r"[A-Za-z_][\w./-]*", re.ASCII)
_PLAIN_LINE = re.compile(r"[A-Za-z][^:#|\\\"*`]*")
_MARKUP = re.compile(r"[`*<>&\[\]|~$!]|(?<![0-9A-Za-z])_|_(?![0-9A-Za-z])")
_WORDS = {"null", "true", "false", "yes", "no", "on", "off", "y", "n", "n/a"}


class Numbers(NamedTuple):
    """How numbers of a file are written."""

    units: Units
    digits: int | None = None

    def text(self, value: float, kind: Kind) -> str:
        """A number in the unit of its kind."""
        measured = kind is not Kind.NUMBER
        return decimal_text(value, self.units.of(kind), self.digits if measured else None)

    @property
    def look(self) -> Look:
        """The same for people, with true minus signs."""

        def shown(kind: Kind) -> Callable[[float], str]:
            return lambda value: self.text(value, kind).replace("-", MINUS)

        short = self.digits is None and self.units.angle == "deg"
        return Look(*self.units, shown(Kind.LENGTH), degrees if short else shown(Kind.ANGLE))


def _words(table: DHTable) -> list[tuple[str, str]]:
    """Texts of the table itself, the empty ones left out."""
    keys = ("name", "source", "checked")
    pairs = [(k, str(getattr(table, k))) for k in keys if getattr(table, k)]
    return [*pairs, ("convention", str(table.convention))]


def _origins(table: DHTable, numbers: Numbers) -> list[tuple[str, list[Field]]]:
    steps = (("base", _origin(table.base, numbers)), ("tool", _origin(table.tool, numbers)))
    return [(key, step) for key, step in steps if any(v != "0" for _, cell in step for v in cell)]


def _origin(origin: Origin, numbers: Numbers) -> list[Field]:
    return [
        ("xyz", [numbers.text(v, Kind.LENGTH) for v in origin.xyz]),
        ("rpy", [numbers.text(v, Kind.ANGLE) for v in origin.rpy]),
    ]


def _row(row: DHRow, table: DHTable, numbers: Numbers, quote: Quote, nest: Nest) -> list[Field]:
    """Cells of a row in the order of the keys, those left out that say nothing."""
    out: list[Field] = [("name", quote(row.name))] if row.name else []
    out.append(("type", quote(str(row.joint_type))))
    if row.origin is not None:
        return out + _origin(row.origin, numbers)
    moved = Kind.LENGTH if row.joint_type is JointType.PRISMATIC else Kind.ANGLE
    kinds = {**ROW_KINDS, **dict.fromkeys(BY_TYPE, moved)}
    for key in _FIELDS:
        value, kind = getattr(row, key), kinds.get(key, Kind.NUMBER)
        if value is None or (key == "sign" and value == 1):
            continue
        if key == "mimic":
            out.append((key, nest(_mimic(row, table, numbers, quote))))
            continue
        each = [numbers.text(v, kind) for v in (value if isinstance(value, tuple) else (value,))]
        out.append((key, each if isinstance(value, tuple) else each[0]))
    return out


def _mimic(row: DHRow, table: DHTable, numbers: Numbers, quote: Quote) -> list[Field]:
    """What a row follows."""
    mimic = row.mimic
    assert mimic is not None
    leader = table.joints[table.joint_names.index(mimic.joint)]
    kind = Kind.LENGTH if row.joint_type is JointType.PRISMATIC else Kind.ANGLE
    multiplier, offset = _ratio(mimic.multiplier, row, leader), numbers.text(mimic.offset, kind)
    word = multiplier if "/" not in multiplier else quote(multiplier)
    return [("joint", quote(mimic.joint)), ("multiplier", word), ("offset", offset)]


def _ratio(value: float, row: DHRow, other: DHRow) -> str:
    """A multiplier; between joints of two kinds in metres and radians, as it says itself."""
    number = decimal_text(value)
    if (row.joint_type is JointType.PRISMATIC) is (other.joint_type is JointType.PRISMATIC):
        return number
    return f"{number}{'m/rad' if row.joint_type is JointType.PRISMATIC else 'rad/m'}"


def _couplings(table: DHTable, equals: str, key: Quote, quote: Quote) -> str:
    """Couplings in braces: ``{joint_3: {joint_2: 1}}``."""
    joints = dict(zip(table.joint_names, table.joints, strict=True))
    parts: list[Field] = []
    for name, terms in table.couplings.items():
        ratios = ((o, _ratio(value, joints[name], joints[o])) for o, value in terms.items())
        fields: list[Field] = [(o, r if "/" not in r else quote(r)) for o, r in ratios]
        parts.append((name, _inline(fields, equals, key)))
    return _inline(parts, equals, key)


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
    return text if _is_plain_line(text) else _quoted(text)


def _quoted(text: str, quote: Quote = json.dumps) -> str:
    """The same in double quotes."""
    return _MARKUP.sub(lambda sign: f"\\u{ord(sign[0]):04x}", quote(text))


def _words_of(fields: list[Field]) -> str:
    """A row's mimic in a cell: ``joint_5 -1 0``; a name that is not one word in double quotes."""
    joint, multiplier, offset = (str(value) for _, value in fields)
    word = joint if joint[:1] == '"' or _PLAIN.fullmatch(joint) else _quoted(joint)
    return " ".join([word, multiplier.strip('"'), offset])


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
    table: DHTable, numbers: Numbers, equals: str, key: Quote, line: Quote, word: Quote
) -> tuple[list[str], list[str]]:
    """Lines of the table's own keys, and of its rows, as a language puts keys and words."""
    head = [f"{key(k)}{equals}{line(text)}" for k, text in _words(table)]
    units = numbers.units
    pair: list[Field] = [("length", word(units.length)), ("angle", word(units.angle))]
    steps = [("units", pair), *_origins(table, numbers)]
    head += [f"{key(k)}{equals}{_inline(fields, equals, key)}" for k, fields in steps]
    if table.couplings:
        head.append(f"{key('couplings')}{equals}{_couplings(table, equals, word, word)}")
    nest = partial(_inline, equals=equals, key=key)
    rows = [_row(row, table, numbers, word, nest) for row in table.rows]
    widths = _widths(rows)
    return head, [_inline(row, equals, key, widths) for row in rows]


def _yaml(table: DHTable, numbers: Numbers) -> str:
    head, rows = _parts(table, numbers, ": ", str, _yaml_line, _yaml_word)
    return "\n".join([*head, "joints:", *(f"  - {row}" for row in rows)]) + "\n"


def _toml(table: DHTable, numbers: Numbers) -> str:
    head, rows = _parts(table, numbers, " = ", str, _escaped, _escaped)
    return "\n".join([*head, "joints = [", *(f"  {row}," for row in rows), "]"]) + "\n"


def _json(table: DHTable, numbers: Numbers) -> str:
    head, rows = _parts(table, numbers, ": ", _json_word, _json_word, _json_word)
    body = ",\n".join(f"    {row}" for row in rows)
    lines = [*(f"  {line}" for line in head), f'  "joints": [\n{body}\n  ]']
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _lines(table: DHTable, numbers: Numbers) -> list[str]:
    """The table's own keys as ``key: value`` lines."""
    lines = [f"{key}: {_line_word(text)}" for key, text in _words(table)]
    lines.append(f"units: {', '.join(numbers.units)}")
    for key, fields in _origins(table, numbers):
        lines += [f"{key}.{part}: {' '.join(values)}" for part, values in fields]
    if table.couplings:
        name = partial(_quoted, quote=_escaped)
        lines.append(f"couplings: {_couplings(table, ': ', name, name)}")
    return lines


def _grid(
    table: DHTable, numbers: Numbers, heads: Mapping[str, str]
) -> tuple[list[str], list[list[str]]]:
    """Header and cells; a column that no row fills is left out, save the four parameters."""
    rows = [dict(_row(row, table, numbers, _line_word, _words_of)) for row in table.rows]
    keys = [k for k in ROW_KEYS if k in ("theta", "d", "a", "alpha") or any(k in r for r in rows)]
    cells = ([r.get(k, "") for k in keys] for r in rows)
    texts = [[c if isinstance(c, str) else " ".join(c) for c in row] for row in cells]
    return [heads.get(k, k) for k in keys], texts


def _csv(table: DHTable, numbers: Numbers, delimiter: str = ",") -> str:
    head = "".join(f"# {line}\n" for line in _lines(table, numbers))
    modified = table.convention is DHConvention.MODIFIED
    heads = {"a": "a_{i-1}", "alpha": "alpha_{i-1}"} if modified else {}
    return head + grid_csv(*_grid(table, numbers, heads), delimiter)


def _markdown(table: DHTable, numbers: Numbers) -> str:
    head = "\n".join(["---", *_lines(table, numbers), "---", "", ""])
    named = heads(table, numbers.look)
    shown = {key: named[key][0] for key in ("theta", "d", "a", "alpha")}
    return head + grid_markdown(*_grid(table, numbers, shown)) + "\n"


def _latex(table: DHTable, numbers: Numbers) -> str:
    return f"% {MARK}\n{table_latex(table, numbers.look)}\n"


def _html(table: DHTable, numbers: Numbers) -> str:
    return html_page(table, numbers.look).replace("<head>", f"<!-- {MARK} -->\n<head>", 1) + "\n"


WRITERS: dict[str, Callable[[DHTable, Numbers], str]] = {
    "yaml": _yaml,
    "toml": _toml,
    "json": _json,
    "csv": _csv,
    "tsv": lambda table, numbers: _csv(table, numbers, "\t"),
    "markdown": _markdown,
    "text": lambda table, numbers: table_text(table, numbers.look),
    "latex": _latex,
    "html": _html,
}
