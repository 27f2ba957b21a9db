"""``dh2urdf extract``: the DH table of a robot description, verified."""

from __future__ import annotations

from dataclasses import asdict
from json import loads
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from cyclopts import Parameter

from dh2urdf.bounds import ROBOT_BYTES, SNAP
from dh2urdf.cli.options import Digits, Force, Json, real
from dh2urdf.cli.output import emit, emit_file, emit_json, robot_of, stdin
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import PLAIN, Description, Reading, Writing
from dh2urdf.dh_io import WRITTEN, atomic_write, parse_table, refuse_foreign, table_to_text
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.exceptions import Dh2UrdfError, NotOrthoParallelError, UrdfError, VerificationError
from dh2urdf.extract import CONFIGURATIONS, LARGEST_ERROR, SIGNATURE, Extraction, extract_dh
from dh2urdf.transforms import pose_error

if TYPE_CHECKING:
    from dh2urdf.dh import DHTable
    from dh2urdf.robot import Robot

Format = Literal[
    "yaml", "toml", "json", "csv", "markdown", "latex", "html", "rtb", "matlab", "matlab-rst",
    "opw", "screws", "kdl",
]  # fmt: skip

FORMS = ("opw", "screws", "kdl")
"""Formats that are no table, of any arm: tables and names of those that ship, too."""

SUFFIXES = WRITTEN | {".py": "rtb", ".m": "matlab"}


def extract_(
    source: str,
    /,
    *,
    base: str | None = None,
    tip: str | None = None,
    convention: Literal["standard", "modified"] = "standard",
    snap: Annotated[float | None, real(0.0, SNAP)] = None,
    explain: bool = False,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    format: Format | None = None,
    units: str | None = None,
    digits: Digits = None,
    force: Force = False,
    x_axis: Literal["auto", "away"] = "auto",
    compact: Annotated[bool, Parameter(negative="--no-compact")] = True,
    flip: tuple[str, ...] = (),
    embedded: Annotated[bool, Parameter(negative="--no-embedded")] = True,
    model: str | None = None,
    reading: Description = PLAIN,
    json: Json = False,
) -> None:
    """Find the DH table of a URDF, xacro or MJCF, or of joint axes, by frame assignment.

    The table's forward kinematics is compared with Pinocchio's of the file.

    Parameters
    ----------
    source
        The file; - for a URDF on stdin. A YAML or JSON file holds joint axes: a list ``axes`` of
        {axis: [x, y, z], point: [x, y, z]}, ``screws`` or ``frames``, and the ``tool``; or OPW
        parameters, KDL segments or UR's calibration.
    base, tip
        Links between which the table runs, anywhere in the tree. Default: the root and the end of
        the longest chain.
    convention
        Standard (distal) or modified (proximal, Craig).
    snap
        Set angles [rad] and lengths [m] right that miss a round value by no more than this, and
        print what each costs; 2e-5 takes 1.5708 for pi/2.
    explain
        Explain every frame, like a worked solution.
    output
        File to write; - for stdout. Its suffix tells the format, YAML on stdout.
    format
        Format of the output; rtb is Python for robotics-toolbox-python, matlab is for Corke's
        toolbox, matlab-rst for the Robotics System Toolbox. opw (parameters of ortho-parallel arms
        with a spherical wrist), screws (axes and home pose) and kdl (segments) are YAML or JSON
        files that every verb reads; of these, SOURCE may be a table, too.
    units
        Units of the table that is written, such as mm,deg; default: m and the shorter angles.
    digits
        Decimals of the table's lengths and angles; default: as few as keep them exact.
    x_axis
        away: every x points away from the axis before it, a >= 0, as in the notes.
    compact
        Give nearly parallel axes a fixed step in place of a far-away common normal.
    flip
        Joint whose z is to point against its positive direction; repeat for several.
    embedded
        Return the table that a file of dh2urdf carries, unless --explain asks for the frames.
    model
        The UR that a calibration.conf belongs to, such as ur5e.
    """
    if format in FORMS:
        arm = robot_of(source, base, tip, Reading(**vars(reading), model=model))
        return _extract_form(arm, source, format, output, force=force, json=json)
    given, own = _stdin() if source == "-" else source, embedded and not explain
    options: dict[str, Any] = {"x_axis": x_axis, "compact": compact, "flip": flip}
    options |= {"embedded": own, "model": model, **reading.given}
    found = extract_dh(given, base, tip, convention, snap, **options)
    to_stdout = str(output or "-") == "-"
    asked = output is not None or format is not None
    text = _text(found, output, format, units, digits) if asked else ""
    if output is not None and not to_stdout:
        _write(found, output, text, force=force)
    elif text and not json:
        emit_file(text)
    if json:
        emit_json(
            "extract",
            **{key: getattr(found, key) for key in ("base", "tip", "max_error", "configurations")},
            table=loads(table_to_text(found.table, "json")),
            steps=[asdict(step) for step in found.steps],
            changes=[asdict(change) for change in found.changes],
            warnings=found.warnings,
            **({"text": text} if text and to_stdout else {}),
        )
        return
    for warning in found.warnings:
        note(f"warning: {warning}")
    if output is None and format is None:
        emit(found.explain() if explain else str(found))
    elif explain:
        note(found.explain())


def _stdin() -> str:
    """The text of a URDF on stdin."""
    text = read_text(stdin(), ROBOT_BYTES, UrdfError)
    if not text.lstrip().startswith("<"):
        raise UrdfError("<stdin>:1: not XML")
    return text


def _extract_form(
    arm: Robot, source: str, form: str, output: Path | None, *, force: bool, json: bool
) -> None:
    """An arm in another form, read back and compared, to a file or stdout."""
    to_stdout = str(output or "-") == "-"
    suffix = ".yaml" if output is None or to_stdout else output.suffix.lower()
    kind = {".json": "json", ".yaml": "yaml", ".yml": "yaml"}.get(suffix)
    if kind is None:
        raise Dh2UrdfError(f"{output}: {form} is written as .yaml or .json")
    text, table, off = _checked_form(arm, source, form, kind)
    if output is not None and not to_stdout:
        if not force:
            refuse_foreign(output, SIGNATURE, same=text.encode())
        atomic_write(output, text)
    elif not json:
        emit_file(text)
    if json:
        told: dict[str, Any] = {"base": arm.base, "tip": arm.tip, "max_error": off}
        told |= {"configurations": CONFIGURATIONS, "table": loads(table_to_text(table, "json"))}
        told |= {"steps": [], "changes": [], "warnings": []}
        emit_json("extract", **told, **({"text": text} if to_stdout else {}))
    ends = f"{shown(arm.base)} to {shown(arm.tip)}"
    note(f"{form}: {ends}, read back with a largest FK difference of {off:.2g} m or rad")


def _checked_form(arm: Robot, source: str, form: str, kind: str) -> tuple[str, DHTable, float]:
    """The text of a form, the table that it reads back as, and how far that is off [m or rad]."""
    from dh2urdf.robot import Robot

    try:
        text = arm.to_form(form, kind)
    except (UrdfError, NotOrthoParallelError) as error:
        raise type(error)(f"{source}: {form}: {error}") from None
    table = parse_table(text, kind).table
    q = np.stack([arm.random_configuration(seed) for seed in range(CONFIGURATIONS)])
    off = pose_error(Robot.from_dh(table).fk(q), arm.fk(q))
    if not off <= LARGEST_ERROR * max(1.0, arm.chain.size):
        raise VerificationError(f"{source}: {form} reads back as another arm, {off:.3g} off")
    return text, table, off


def _text(
    found: Extraction,
    output: Path | None,
    format: str | None,
    units: str | None,
    digits: int | None,
) -> str:
    """The table in the format of an output, or the one that is named."""
    from dh2urdf.conversions.write import CONSTRUCTORS, table_text_and_error

    suffix = output.suffix.lower() if output and str(output) != "-" else ".yaml"
    chosen = format or SUFFIXES.get(suffix, "")
    if not chosen:
        known = ", ".join(SUFFIXES)
        raise Dh2UrdfError(f"{output}: the suffix tells no format; use {known} or --format")
    if chosen in CONSTRUCTORS:
        return CONSTRUCTORS[chosen](found.table)
    wanted = Writing(units=units).units_of(found.table, chosen, None)
    text, error = table_text_and_error(found.table, chosen, wanted, digits)
    if error:
        note(f"rounded to {digits} decimals, the arm is up to {error:.2g} m or rad off")
    return text


def _write(found: Extraction, output: Path, text: str, *, force: bool) -> None:
    """The text of the table to a file."""
    if not force:
        refuse_foreign(output, SIGNATURE)
    atomic_write(output, text)
    note(
        f"{output}: {shown(found.base)} to {shown(found.tip)}, largest FK difference "
        f"{found.max_error:.2g} m or rad (Pinocchio)"
    )
