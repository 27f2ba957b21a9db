"""``dh2urdf compare``: whether arms are the same, up to what, and where they differ."""

import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from dh2urdf.cli.options import Arm, Json, Link
from dh2urdf.cli.output import ROBOT_SUFFIXES, emit, emit_json, robot_of, table_of
from dh2urdf.cli.progress import note, track
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.comparison import TOLERANCE, Comparison, compare
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import Dh2UrdfError


def compare_(
    a: Arm,
    /,
    *b: Annotated[str, Parameter(help="The arm to compare with it; several are told of in turn.")],
    base: Link = None,
    tip: Link = None,
    tolerance: float = TOLERANCE,
    exact: bool = False,
    reading: Reading = DEFAULT,
    json: Json = False,
) -> int:
    """Say whether arms are the same as the first, up to what, and where they differ.

    Arms are the same if there are a base, a tool, zeros and directions of the joints with which
    both tools stand at the same pose for every q; these are printed. Else the rows that differ,
    each with what it does to the tool, and the mistake that they read as: a sign, swapped or left
    out numbers, units, the other convention, the order of rows. Limits and masses are not looked
    at. Exit status 0: all are the same, 1: one is not, 2: one cannot be read.

    Parameters
    ----------
    tolerance
        Largest difference [m and rad] of arms that are the same.
    exact
        Ask for the same base, tool, zeros and directions, too.
    """
    if not b:
        raise Dh2UrdfError("compare: B: name one or more arms to compare with the first")
    first = _given(a, reading)
    results, failed = list[Comparison](), list[dict[str, str]]()
    for other in track(b, "comparing"):
        try:
            found = compare(first, _given(other, reading), base=base, tip=tip, tolerance=tolerance)
        except Dh2UrdfError as error:
            failed.append({"path": other, "error": str(error)})
            continue
        results.append(replace(found, a=shown(a), b=shown(other)))
    if json:
        emit_json("compare", results=[_data(found) for found in results], failed=failed)
    for found in results:
        for warning in found.warnings:
            note(f"warning: {warning}")
        if not json:
            emit(found.told(exact=exact))
    for bad in failed:
        note(f"dh2urdf: {bad['error']}")
    alike = sum(found.equal if exact else found.same for found in results)
    if len(b) > 1:
        note(f"{alike} of {len(b)} are {'exactly ' if exact else ''}the same arm as {shown(a)}")
    return 2 if failed else int(alike < len(b))


def _given(source: str, reading: Reading) -> Any:
    """A table read as told, the path of a robot description, or the robot on stdin."""
    if source == "-":
        return robot_of(source, reading=reading)
    if Path(source).suffix.lower() in ROBOT_SUFFIXES:
        return source
    return table_of(source, reading.told)


def _data(found: Comparison) -> dict[str, Any]:
    """What is found, a mistake by its names too, and no number that JSON has not."""
    data = {key: getattr(found, key) for key in ("a", "b", "same", "equal", "up_to")}
    error = found.max_error if math.isfinite(found.max_error) else None
    mistakes = [mistake._asdict() for mistake in found.mistakes]
    rest = {k: v for k, v in asdict(found).items() if k not in data and k != "warnings"}
    return {**data, **rest, "max_error": error, "mistakes": mistakes}
