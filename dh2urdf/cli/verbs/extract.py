"""``dh2urdf extract``: the DH table of a robot description, verified."""

from dataclasses import asdict
from json import loads
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from dh2urdf.bounds import ROBOT_BYTES, SNAP
from dh2urdf.cli.options import Digits, Force, Json, real
from dh2urdf.cli.output import emit, emit_file, emit_json, stdin
from dh2urdf.cli.progress import note
from dh2urdf.dh_io import WRITTEN, atomic_write, refuse_foreign, table_to_text, usual_units
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.exceptions import Dh2UrdfError, UrdfError
from dh2urdf.extract import SIGNATURE, Extraction, extract_dh

Format = Literal[
    "yaml", "toml", "json", "csv", "markdown", "latex", "html", "rtb", "matlab", "matlab-rst"
]

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
    digits: Digits = None,
    force: Force = False,
    x_axis: Literal["auto", "away"] = "auto",
    compact: Annotated[bool, Parameter(negative="--no-compact")] = True,
    flip: tuple[str, ...] = (),
    embedded: Annotated[bool, Parameter(negative="--no-embedded")] = True,
    json: Json = False,
) -> None:
    """Find the DH table of a URDF, xacro or MJCF, or of joint axes, by frame assignment.

    The table's forward kinematics is compared with Pinocchio's of the file.

    Parameters
    ----------
    source
        The file; - for a URDF on stdin. A YAML or JSON file holds joint axes: a list ``axes`` of
        {axis: [x, y, z], point: [x, y, z]}, ``screws`` or ``frames``, and the ``tool``.
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
        toolbox, matlab-rst for the Robotics System Toolbox.
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
    """
    given, own = _stdin() if source == "-" else source, embedded and not explain
    found = extract_dh(
        given, base, tip, convention, snap, x_axis=x_axis, compact=compact, flip=flip, embedded=own
    )
    to_stdout = str(output or "-") == "-"
    asked = output is not None or format is not None
    text = _text(found, output, format, digits) if asked else ""
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


def _text(found: Extraction, output: Path | None, format: str | None, digits: int | None) -> str:
    """The table in the format of an output, or the one that is named."""
    from dh2urdf.conversions.write import CONSTRUCTORS, table_text_and_error

    suffix = output.suffix.lower() if output and str(output) != "-" else ".yaml"
    chosen = format or SUFFIXES.get(suffix, "")
    if not chosen:
        known = ", ".join(SUFFIXES)
        raise Dh2UrdfError(f"{output}: the suffix tells no format; use {known} or --format")
    if chosen in CONSTRUCTORS:
        return CONSTRUCTORS[chosen](found.table)
    units = usual_units(found.table, chosen, None)
    text, error = table_text_and_error(found.table, chosen, units, digits)
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
