"""A cell with the variables of other joints, ``q3 - q2``: how a table says what is meant by it."""

import re

from dh2urdf.dh_io.cells.document import Report
from dh2urdf.dh_io.cells.expressions import plain_text

_TERM = re.compile(
    r"(?P<sign>[+-]?)\s*(?:(?P<factor>\d+(?:\.\d*)?|\.\d+)\s*\*?\s*)?"
    r"(?:theta|Theta|th|θ|ϑ|t|q|d)_?(?P<index>\d+)\*?(?![\w.])\s*"
)
"""A number times the variable of a joint."""

_NAME = re.compile(r"[^\W\d]")


def hint_of(text: str, key: str, joint: int, names: list[str], report: Report) -> str:
    """What to write in place of a cell ``theta`` or ``d`` of a joint; empty where it is not clear.

    ``names`` are those of joints 1, 2 ... as far as they are known.
    """
    text = plain_text(text)
    terms: dict[int, float] = {}
    for match in _TERM.finditer(text):
        size = float(match["factor"] or 1.0) * (-1.0 if match["sign"] == "-" else 1.0)
        terms[int(match["index"])] = terms.get(int(match["index"]), 0.0) + size
    rest = _TERM.sub("", text).strip().removeprefix("+").strip()
    own = terms.pop(joint, 0.0)
    if not terms or _NAME.search(rest.replace("pi", "").replace("deg", "").replace("mm", "")):
        return ""
    named = {_name(index, names): size for index, size in terms.items()}
    if own == 0.0 and len(named) == 1:
        (leader, size), constant = next(iter(named.items())), rest or "0"
        cells = (
            report.cell(key, constant),
            report.cell("mimic", _quoted(f"{leader} {size:g}", report)),
        )
        return f"where the joint follows {leader}, write {cells[0]} and {cells[1]}"
    if abs(own) == 1.0:
        others = {name: size * own for name, size in named.items()}
        variable = f"{'-' if own < 0.0 else ''}q{joint}"
        moved = f"{variable} + {rest}" if rest and rest[0] != "-" else f"{variable} {rest}".rstrip()
        couplings = _couplings(_name(joint, names), others, report)
        moved = report.cell(key, _quoted(moved, report))
        return f"write {moved}, and for the whole table {couplings}"
    return "a joint follows one other (mimic), or adds others to a value of its own (couplings)"


def _name(index: int, names: list[str]) -> str:
    known = names[index - 1] if index <= len(names) else ""
    return known or f"joint_{index}"


def _quoted(words: str, report: Report) -> str:
    return f'"{words}"' if report.format in ("toml", "json", "frame") else words


def _couplings(name: str, others: dict[str, float], report: Report) -> str:
    """``couplings: {joint_3: {joint_2: -1}}``, as the file's format writes it."""
    if report.format == "toml":
        inside = ", ".join(f"{other} = {size:g}" for other, size in others.items())
        return f"couplings = {{{name} = {{{inside}}}}}"
    quote = '"' if report.format == "json" else ""
    inside = ", ".join(f"{quote}{other}{quote}: {size:g}" for other, size in others.items())
    start = "# " if report.format in ("csv", "tsv") else ""
    return f"{start}{quote}couplings{quote}: {{{quote}{name}{quote}: {{{inside}}}}}"
