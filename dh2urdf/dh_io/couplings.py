"""What a table file says between joints: ``mimic`` of a row, ``couplings`` of the table."""

import json
import re
from collections.abc import Sequence

from dh2urdf.dh import Couplings, DHRow, JointType, Mimic
from dh2urdf.dh.coupling import problems_between
from dh2urdf.dh.mimic import ReadOnly
from dh2urdf.dh_io.cells.cells import Cells, Context, found
from dh2urdf.dh_io.cells.document import Keys, Node, Scalar
from dh2urdf.dh_io.cells.schema import MIMIC_KEYS
from dh2urdf.dh_io.cells.units import Kind
from dh2urdf.dh_io.formats.yaml import read_yaml
from dh2urdf.exceptions import TableError

_WORDS = re.compile(r'"(?:[^"\\]|\\.)*"|[^\s,;]+')

Kinds = tuple[Kind, Kind] | None


def read_mimic(node: Node, path: str, kind: Kind, context: Context) -> Mimic | None:
    """``{joint: joint_5, multiplier: -1, offset: 0}``, or the words ``joint_5 -1 0``.

    None (and a fault) where it is neither. The kind is that of the joint which follows.
    """
    context.marks[path] = node.mark
    cells = Cells(_with_keys(node, path, context), path, MIMIC_KEYS, context.report)
    joint = cells.get("joint")
    if joint is None and isinstance(node, Keys | Scalar) and cells.is_missing("joint"):
        example = context.report.cell("joint", "joint_5")
        context.report.fault(node.mark, f"{path}.joint", "missing", f"write {example}")
    values: dict[str, float | None] = {"multiplier": 1.0, "offset": 0.0}
    if (cell := cells.get("multiplier")) is not None:
        values["multiplier"] = context.ratio(cell, f"{path}.multiplier")
    if (cell := cells.get("offset")) is not None:
        values["offset"] = context.number(cell, f"{path}.offset", kind)
    if joint is None or None in values.values():
        return None
    context.marks[f"{path}.joint"] = joint.mark
    context.ratios.setdefault(f"{path}.multiplier", None)
    try:
        return Mimic(context.text(joint, f"{path}.joint"), **values)  # type: ignore[arg-type]
    except TableError as error:
        keys = [problem.replace("mimic.", "", 1) for problem in error.problems]
        cells.refuse(TableError(keys))
    return None


def _with_keys(node: Node, path: str, context: Context) -> Node:
    """The words of a cell under their keys; what is no text as it is."""
    if not isinstance(node, Scalar):
        return node
    words = _WORDS.findall(node.text)
    if len(words) > len(MIMIC_KEYS):
        hint = "the joint, a multiplier and an offset, such as joint_5 -1 0"
        context.report.fault(node.mark, path, f"found {found(node)}; expected {hint}")
    cells = [Scalar(_unquoted(word), node.mark, quoted=word[0] == '"') for word in words]
    return Keys(tuple((Scalar(k, node.mark), c) for k, c in zip(MIMIC_KEYS, cells, strict=False)))


def _unquoted(word: str) -> str:
    try:
        return str(json.loads(word)) if word[0] == '"' else word
    except ValueError:
        return word


def read_couplings(node: Node | None, context: Context) -> Couplings:
    """``{joint_3: {joint_2: 1.0}}``, of a CSV or Markdown file as one text."""
    if isinstance(node, Scalar):
        node = _as_yaml(node, context)
    out: dict[str, ReadOnly[float]] = {}
    if node is not None and not isinstance(node, Keys):
        what = "expected joint: {other joint: number}"
        context.report.fault(node.mark, "couplings", f"found {found(node)}; {what}")
        return ReadOnly(out)
    for name, terms in node.pairs if node is not None else ():
        path = f"couplings.{name.text:.40}"
        context.marks[path] = name.mark
        if not isinstance(terms, Keys):
            message = f"found {found(terms)}; expected other joint: number"
            context.report.fault(name.mark, path, message)
        elif name.text in out:
            context.report.fault(name.mark, path, "given twice")
        elif numbers := _terms(terms, path, context):
            out[name.text] = ReadOnly(numbers)
    return ReadOnly(out)


def _terms(terms: Keys, path: str, context: Context) -> dict[str, float]:
    """Numbers by the names of joints; a stand-in where there is none, a fault already."""
    out: dict[str, float] = {}
    for other, cell in terms.pairs:
        place = f"{path}.{other.text:.40}"
        context.marks[place] = other.mark
        if other.text in out:
            context.report.fault(other.mark, place, "given twice")
        value = context.ratio(cell, place)
        out[other.text] = 1.0 if value is None else value
    return out


def _as_yaml(node: Scalar, context: Context) -> Node:
    """A text in braces as the keys that it says, all at its place."""
    return _at(read_yaml(node.text, context.report), node) if node.text[:1] == "{" else node


def _at(node: Node, place: Scalar) -> Node:
    if isinstance(node, Keys):
        pairs = ((Scalar(k.text, place.mark), _at(v, place)) for k, v in node.pairs)
        return Keys(tuple(pairs), place.mark)
    return Scalar(node.text, place.mark) if isinstance(node, Scalar) else node


def check_between(
    rows: Sequence[DHRow], numbers: Sequence[int], couplings: Couplings, context: Context
) -> None:
    """Note what cannot be meant between the joints, which are the rows of these numbers."""
    names = [row.name or f"joint_{i}" for i, row in enumerate(rows, 1)]
    if len(set(names)) < len(names):
        return  # a fault already
    for at, keys, message in problems_between(rows, names, couplings):
        start = f"joints[{numbers[at]}]" if at >= 0 else "couplings"
        path = ".".join([start, *(key[:40] for key in keys)])
        context.report.fault(context.mark_of(path), path, message)
    for number, row, name in zip(numbers, rows, names, strict=True):
        if row.mimic is not None and row.mimic.joint in names:
            path = f"joints[{number}].mimic.multiplier"
            _check_ratio(row, rows[names.index(row.mimic.joint)], path, context)
        for other in couplings.get(name, ()):
            if other in names:
                path = f"couplings.{name:.40}.{other:.40}"
                _check_ratio(row, rows[names.index(other)], path, context)


def _check_ratio(row: DHRow, other: DHRow, path: str, context: Context) -> None:
    """A number between joints of two kinds says its units; others say none, or those of one."""
    kinds = tuple(
        Kind.LENGTH if r.joint_type is JointType.PRISMATIC else Kind.ANGLE for r in (row, other)
    )
    said = context.ratios.get(path)
    if said == kinds or (said is None and kinds[0] is kinds[1]):
        return
    units = "/".join({Kind.LENGTH: "m", Kind.ANGLE: "rad"}[kind] for kind in kinds)
    what = f"one of the joints slides, the other turns: write the units, as in 0.5 {units}"
    if kinds[0] is kinds[1]:
        what = "both joints move alike: write a plain number"
    cell = context.places.get(path)
    text = f"found {found(cell)}; {what}" if cell is not None else what
    context.report.fault(context.mark_of(path), path, text)
