"""``dh2urdf convert``: tables to verified files of any format."""

import os
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from cyclopts import Parameter

from dh2urdf.cli.options import Digits, Json
from dh2urdf.cli.output import emit, emit_file, emit_json, read_any
from dh2urdf.cli.progress import note, track
from dh2urdf.cli.reading import AS_READ, Writing
from dh2urdf.conversions.write import UrdfOptions
from dh2urdf.convert import FORMATS, SUFFIXES, converted, write_converted
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import Dh2UrdfError, TableError

Format = Literal["urdf", "mjcf", "yaml", "toml", "json", "csv", "markdown", "latex", "html"]

PICTURES = (".pdf", ".png", ".svg", ".jpg", ".jpeg")
"""Suffixes of what another verb writes."""


def convert_(
    *tables: str,
    shipped: bool = False,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    out_dir: Path | None = None,
    format: Format | None = None,
    force: bool = False,
    collision: bool = False,
    dh_frames: Annotated[bool, Parameter(negative="--no-dh-frames")] = True,
    digits: Digits = None,
    balance_inertia: Annotated[bool, Parameter(negative="--no-balance-inertia")] = True,
    writing: Writing = AS_READ,
    json: Json = False,
) -> int:
    """Turn DH tables into URDF or MJCF files, or into tables of another format, each checked.

    A URDF is loaded back by Pinocchio, an MJCF by MuJoCo, and compared with the DH product, frame
    by frame; a table is read back and compared number by number. What differs is not written.

    Parameters
    ----------
    tables
        Table files (YAML, TOML, JSON, CSV, Markdown), names of tables that ship, robot
        descriptions (URDF, xacro, MJCF) for the table that `extract` finds, or - for stdin.
    shipped
        All tables that ship with the package; `convert --shipped --out-dir urdf` made the folder
        urdf/ of the repository.
    output
        The file to write; - for stdout. Default: a URDF with the table's name beside you. Its
        suffix decides: .urdf; .xml for MJCF; .yaml, .toml, .json, .csv, .md for the table itself,
        which reads back the same; .tex, .html for people, limits to a hundredth of a degree.
    out_dir
        Folder for the files, made where there is none.
    format
        Format of the output where the suffix does not tell, on stdout or in a folder.
    force
        Replace files that dh2urdf did not write.
    collision
        Write the drawn bodies as collision geometry too.
    dh_frames
        Write the DH frames as fixed links dh_0 ... dh_n.
    digits
        Round lengths, angles and limits to so many decimals of the file's units; default: as few
        as keep every number exact. The report says how far rounding moves the arm.
    balance_inertia
        Make inertia tensors that no body could have acceptable to every consumer.
    """
    options = UrdfOptions(
        dh_frames=dh_frames, collision=collision, digits=digits, balance_inertia=balance_inertia
    )
    if shipped:
        from dh2urdf.robots import list_tables

        tables = (*tables, *list_tables())
    if not tables:
        raise Dh2UrdfError("convert: TABLES: name one or more, or --shipped; see `dh2urdf list`")
    if output is not None and len(tables) > 1:
        raise Dh2UrdfError("convert: -o names one file; for several tables use --out-dir")
    if out_dir is not None:
        try:
            out_dir.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as error:
            raise Dh2UrdfError(f"{shown(out_dir)}: {getattr(error, 'strerror', error)}") from None
    job = _Job(format, writing, options, force)
    if len(tables) == 1:
        _show_one(job.run(tables[0], _target(tables[0], output, out_dir, format)), json=json)
        return 0
    return _convert_many(tables, job, out_dir or Path(), json=json)


def _target(source: str, output: Path | None, out_dir: Path | None, format: str | None) -> Path:
    """Path to write, named after the source where none is given."""
    if output is not None:
        return output
    if source == "-" and out_dir is None:
        return Path("-")
    stem = "robot" if source == "-" else Path(source).stem
    return (out_dir or Path()) / f"{stem}{SUFFIXES[format or 'urdf']}"


def _format(target: Path) -> str:
    """Format of a path by its suffix; a URDF on stdout, and where a device or pipe stands."""
    if str(target) == "-" or (os.path.exists(target) and not os.path.isfile(target)):
        return FORMATS.get(target.suffix.lower(), "urdf")
    if (format := FORMATS.get(target.suffix.lower())) is None:
        if target.suffix.lower() in PICTURES:
            raise Dh2UrdfError(
                f"{shown(target)}: convert draws no pictures; dh2urdf figure ARM -o FILE does"
            )
        known = ", ".join(FORMATS)
        message = f"the suffix decides what convert writes: {known}; or --format"
        raise Dh2UrdfError(f"{shown(target)}: {message}")
    return format


class _Job(NamedTuple):
    """What is made of each source."""

    format: str | None
    writing: Writing
    options: UrdfOptions
    force: bool

    def run(self, source: str, target: Path) -> dict[str, Any]:
        """What was written, as JSON has it, and how it was checked."""
        format = self.format or _format(target)
        read = read_any(source, self.writing)
        units = self.writing.units_of(read.table, format, read.units)
        try:
            made = converted(
                read.table, format, units, convention=self.writing.convention, options=self.options
            )
        except TableError as error:  # a warning of the reader may tell where
            raise TableError((*read.warnings, *error.problems)) from None
        if str(target) != "-":
            write_converted(made, target, force=self.force)
        return {
            "source": source,
            "path": target,
            "format": format,
            "max_error": made.max_error,
            "checked": made.checked,
            "warnings": [*read.warnings, *made.warnings],
            **({"text": made.text} if str(target) == "-" else {}),
        }


def _show_one(result: dict[str, object], *, json: bool) -> None:
    if json:
        emit_json("convert", files=[result])
        return
    for warning in result["warnings"]:  # type: ignore[attr-defined]
        note(f"warning: {warning}")
    if "text" in result:
        emit_file(str(result["text"]))
        note(str(result["checked"]))
    else:
        emit(f"{result['path']}  {result['checked']}")


def _convert_many(tables: tuple[str, ...], job: _Job, out_dir: Path, *, json: bool) -> int:
    """Convert one after another; a bad file is reported and does not stop the rest."""
    done, failed = [], []
    targets: dict[Path, str] = {}
    for source in track(tables, "converting"):
        target = _target(source, None, out_dir, job.format)
        try:
            if target in targets:
                raise Dh2UrdfError(f"{source}: {target} was already written from {targets[target]}")
            done.append(job.run(source, target))
            targets[target] = source
        except Dh2UrdfError as error:
            failed.append({"source": source, "error": str(error)})
    if json:
        emit_json("convert", files=done, failed=failed)
    for item in () if json else done:
        for warning in item["warnings"]:
            note(f"warning: {item['source']}: {warning}")
    for bad in failed:
        note(f"dh2urdf: {bad['error']}")
    if done and not json:
        worst = max(done, key=lambda item: float(item["max_error"]))
        files = "1 file" if len(done) == 1 else f"{len(done)} files"
        emit(f"{files} written to {out_dir}; {worst['checked']} ({worst['source']})")
    if failed:
        note(f"{len(failed)} of {len(done) + len(failed)} tables were not converted")
    return 2 if failed else 0
