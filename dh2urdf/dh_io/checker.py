"""A document to a `DHTable`: every key known, every cell a value, all faults at once."""

from dh2urdf.bounds import ROWS
from dh2urdf.dh import DHConvention, DHRow, DHTable, Origin
from dh2urdf.dh_io.cells.cells import Cells, Context, found
from dh2urdf.dh_io.cells.document import NOWHERE, Items, Keys, Node, Report, Scalar
from dh2urdf.dh_io.cells.schema import CONVENTIONS, TABLE_KEYS, did_you_mean
from dh2urdf.dh_io.cells.told import NOTHING, Told
from dh2urdf.dh_io.cells.units import SI, UNIT_SIZES, Kind, Units, unit_name
from dh2urdf.dh_io.couplings import check_between, read_couplings
from dh2urdf.dh_io.near_misses import near_misses
from dh2urdf.dh_io.rows import read_row
from dh2urdf.exceptions import TableError

_NOT_OVERRULED = "; what a file says itself is not overruled"


def check_document(
    root: Node, report: Report, name: str, told: Told = NOTHING
) -> tuple[DHTable, Units]:
    """Turn a document into a table and its units, or into all its faults.

    The table is named so where the document gives no name.

    Convention and units that it does not say are those that were told.
    """
    if isinstance(root, Scalar) and not root.text:
        report.stop(NOWHERE, "the file is empty")
    if not isinstance(root, Keys):
        hint = "a table file opens with keys: convention, units, joints"
        report.stop(root.mark, f"no table: found {found(root)}", hint)
    cells = Cells(root, "", TABLE_KEYS, report)
    convention = _convention(cells, report, told)
    context = Context(report, _units(cells, report, told))
    if (constants := cells.get("constants")) is not None:
        context.define(constants)
    rows = _rows(cells, context)
    couplings = read_couplings(cells.get("couplings"), context)
    numbers = [number for number, row in enumerate(rows, 1) if row.is_joint]
    check_between([row for row in rows if row.is_joint], numbers, couplings, context)
    texts = {
        key: context.text(cell, key)
        for key in ("name", "source", "checked")
        if (cell := cells.get(key)) is not None
    }
    base, tool = _origin(cells, "base", context), _origin(cells, "tool", context)
    report.raise_faults()
    words = {"name": name, **texts}
    try:
        table = DHTable(tuple(rows), convention, base=base, tool=tool, couplings=couplings, **words)
    except TableError as error:
        for problem in error.problems:
            key = problem.partition(":")[0]
            report.fault(cells.mark_of(key if key in cells.keys else "joints"), "", problem)
        report.raise_faults()
        raise
    _warn(table, context)
    return table, context.units


def _warn(table: DHTable, context: Context) -> None:
    """Note the near misses at their cells."""
    texts = {
        path: cell.text.strip()
        for path, cell in context.places.items()
        if not cell.unit or cell.unit in context.units
    }
    for path, message in near_misses(table, context.units, texts):
        place = context.places.get(path)
        inside = (cell.mark for key, cell in context.places.items() if key.startswith(path))
        mark = context.marks.get(path) or next(inside, NOWHERE)
        context.report.warn(place.mark if place else mark, path, message)


def _convention(cells: Cells, report: Report, told: Told) -> DHConvention:
    cell = cells.get("convention")
    meaning = "standard (distal: Paul, Spong) or modified (proximal: Craig, Khalil)"
    if cell is None:
        if told.convention is None and cells.is_missing("convention"):
            hint = report.remedy("--convention", "convention", "standard")
            hint += "; there is no default: the two look alike and describe different arms"
            report.fault(cells.mark_of("convention"), "convention", f"missing; {meaning}", hint)
        return told.convention or DHConvention.STANDARD
    word = cell.text.strip().casefold() if isinstance(cell, Scalar) else ""
    if word not in CONVENTIONS:
        hint = did_you_mean(word, CONVENTIONS) if word != "dh" else "dh alone does not say which"
        report.fault(cell.mark, "convention", f"found {found(cell)}; allowed: {meaning}", hint)
    convention = CONVENTIONS.get(word, DHConvention.STANDARD)
    if told.convention not in (None, convention) and not told.may_differ:
        message = f"found {found(cell)}, but told {told.convention}{_NOT_OVERRULED}"
        report.fault(cell.mark, "convention", message)
    return convention


def _units(cells: Cells, report: Report, told: Told) -> Units:
    node = cells.get("units")
    allowed = {kind.value: ", ".join(UNIT_SIZES[kind]) for kind in (Kind.LENGTH, Kind.ANGLE)}
    meaning = f"length ({allowed['length']}) and angle ({allowed['angle']})"
    hint = f"for instance {report.example('units', length='mm', angle='deg')}"
    if not isinstance(node, Keys):
        if node is not None:
            report.fault(node.mark, "units", f"found {found(node)}; expected {meaning}", hint)
        elif cells.is_missing("units") and not (told.length and told.angle):
            hint = report.remedy("--units mm,deg", "units", length="mm", angle="deg")
            hint += "; there is no default"
            report.fault(cells.mark_of("units"), "units", f"missing; {meaning}", hint)
        return Units(told.length or SI.length, told.angle or SI.angle)
    parts = Cells(node, "units", ("length", "angle"), report)
    return Units(*(_unit(parts, kind, report, told) for kind in (Kind.LENGTH, Kind.ANGLE)))


def _unit(parts: Cells, kind: Kind, report: Report, told: Told) -> str:
    """Unit of lengths or of angles."""
    key, otherwise = kind.value, getattr(told, kind.value)
    cell = parts.get(key)
    if cell is None and otherwise:
        return str(otherwise)
    unit = unit_name(cell.text) if isinstance(cell, Scalar) else ""
    if unit in UNIT_SIZES[kind]:
        if otherwise not in ("", unit) and not told.may_differ and cell is not None:
            message = f"found {found(cell)}, but told {otherwise}{_NOT_OVERRULED}"
            report.fault(cell.mark, f"units.{key}", message)
        return unit
    if cell is not None or parts.is_missing(key):
        message = f"found {found(cell)}; " if cell is not None else "missing; "
        message += f"allowed: {', '.join(UNIT_SIZES[kind])}"
        hint = did_you_mean(unit, UNIT_SIZES[kind]) if unit else ""
        report.fault(parts.mark_of(key), f"units.{key}", message, hint)
    return SI.of(kind)


def _rows(cells: Cells, context: Context) -> list[DHRow]:
    node, report = cells.get("joints"), context.report
    if node is None and not cells.is_missing("joints"):
        return []
    if not isinstance(node, Items) or not node.values:
        message = f"found {found(node)}; " if node is not None else "missing; "
        message += "expected a list of rows with theta, d, a and alpha"
        report.fault(cells.mark_of("joints"), "joints", message)
        return []
    if len(node.values) > ROWS:
        message = f"{len(node.values)} rows; a table has at most {ROWS}"
        report.stop(node.values[ROWS].mark, f"joints: {message}")
    rows: list[DHRow] = []
    seen: dict[str, str] = {}
    joint = 1
    for number, item in enumerate(node.values, 1):
        path = f"joints[{number}]"
        row = read_row(item, path, joint, context)
        rows.append(row)
        if not row.is_joint:
            continue
        name = row.name or f"joint_{joint}"
        if name in seen:
            message = f"{name!r} is the name of {seen[name]} too; joints need different names"
            report.fault(item.mark, f"{path}.name", message)
        seen[name] = path
        context.names.append(name)
        joint += 1
    if joint == 1:
        message = "no revolute or prismatic row; a table needs at least one"
        report.fault(node.mark, "joints", message)
    return rows


def _origin(cells: Cells, key: str, context: Context) -> Origin:
    node = cells.get(key)
    if node is None:
        return Origin()
    parts = Cells(node, key, ("xyz", "rpy", "name"), context.report)
    if (name := parts.get("name")) is not None:
        context.report.warn(name.mark, f"{key}.name", f"found {found(name)}; it is not read")
    xyz, rpy = parts.get("xyz"), parts.get("rpy")
    return parts.origin(
        context.numbers(xyz, f"{key}.xyz", Kind.LENGTH, 3, "x, y, z") if xyz else None,
        context.numbers(rpy, f"{key}.rpy", Kind.ANGLE, 3, "roll, pitch, yaw") if rpy else None,
    )
