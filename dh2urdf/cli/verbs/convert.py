"""``dh2urdf convert``: tables to verified URDF files."""

import os
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from dh2urdf.cli.options import UNTOLD, Json, Telling, whole
from dh2urdf.cli.output import emit, emit_file, emit_json, read_source
from dh2urdf.cli.progress import note, track
from dh2urdf.conversions.write import UrdfOptions
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import FORMATS, atomic_write, parse_table, refuse_foreign, table_to_text
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import Dh2UrdfError, TableError, VerificationError


def convert_(
    *tables: str,
    shipped: bool = False,
    output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None,
    out_dir: Path | None = None,
    force: bool = False,
    collision: bool = False,
    dh_frames: Annotated[bool, Parameter(negative="--no-dh-frames")] = True,
    digits: Annotated[int | None, whole(0, 17)] = None,
    balance_inertia: Annotated[bool, Parameter(negative="--no-balance-inertia")] = True,
    reading: Telling = UNTOLD,
    json: Json = False,
) -> int:
    """Turn DH tables into URDF files that Pinocchio has checked, or into tables of other formats.

    Each file is loaded back and compared with the DH product, frame by frame; one that differs
    is not written.

    Parameters
    ----------
    tables
        Table files (YAML, TOML, JSON, CSV, Markdown), names of tables that ship, or - for one on
        stdin.
    shipped
        All tables that ship with the package; `convert --shipped --out-dir urdf` made the folder
        urdf/ of the repository.
    output
        The file to write; - for stdout. Default: a URDF with the table's name beside you. Its
        suffix decides: .urdf, or .yaml, .toml, .json, .csv, .md for the table itself.
    out_dir
        Folder for the URDF files, made where there is none.
    force
        Replace files that dh2urdf did not write.
    collision
        Write the drawn bodies as collision geometry too.
    dh_frames
        Write the DH frames as fixed links dh_0 ... dh_n.
    digits
        Round all numbers to so many decimals (IKFast); default: every digit.
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
    if len(tables) == 1:
        target = _target(tables[0], output, out_dir)
        result = _convert(tables[0], reading, target, options, force)
        _show_one(result, json=json)
        return 0
    return _convert_many(tables, reading, out_dir or Path(), options, force=force, json=json)


def _target(source: str, output: Path | None, out_dir: Path | None) -> Path:
    """Path to write, named after the source where none is given."""
    if output is not None:
        return output
    if source == "-" and out_dir is None:
        return Path("-")
    stem = "robot" if source == "-" else Path(source).stem
    return (out_dir or Path()) / f"{stem}.urdf"


def _convert(
    source: str, reading: Telling, target: Path, options: UrdfOptions, force: bool
) -> dict[str, Any]:
    """What was written, as JSON has it."""
    table, warnings = read_source(source, reading.told)
    try:
        made = _made(table, target, options, force)
    except TableError as error:  # a warning of the reader may tell where
        raise TableError((*warnings, *error.problems)) from None
    made["warnings"] = [*warnings, *made["warnings"]]
    return {"source": source, "path": target, **made}


def _made(table: DHTable, target: Path, options: UrdfOptions, force: bool) -> dict[str, Any]:
    """Text of the target's kind, checked, and written unless it is for stdout."""
    from dh2urdf.conversions.write import verified_urdf, write_urdf

    result: dict[str, Any] = {"max_error": 0.0, "warnings": ()}
    suffix = target.suffix.lower()
    if str(target) == "-":
        result["text"], result["max_error"], result["warnings"] = verified_urdf(table, options)
    elif suffix in FORMATS:
        text = table_to_text(table, FORMATS[suffix])
        if parse_table(text, FORMATS[suffix]).table != table:
            raise VerificationError(f"{shown(target)}: the text reads back as another table")
        if not force:
            refuse_foreign(target, same=text.encode())
        atomic_write(target, text)
    elif suffix in (".urdf", ".xml") or (os.path.exists(target) and not os.path.isfile(target)):
        report = write_urdf(table, target, options=options, force=force)
        result |= {"max_error": report.max_error, "warnings": report.warnings}
    else:
        known = ", ".join([".urdf", *FORMATS])
        raise Dh2UrdfError(f"{shown(target)}: the suffix decides what convert writes: {known}")
    return result


def _show_one(result: dict[str, object], *, json: bool) -> None:
    if json:
        emit_json("convert", files=[result])
        return
    for warning in result["warnings"]:  # type: ignore[attr-defined]
        note(f"warning: {warning}")
    if "text" in result:
        emit_file(str(result["text"]))
        note(_checked(result))
    else:
        emit(f"{result['path']}  {_checked(result)}")


def _checked(result: dict[str, object]) -> str:
    if Path(str(result["path"])).suffix.lower() in FORMATS:
        return "reads back as the same table"
    return f"largest difference between Pinocchio and the DH product {result['max_error']:.1e}"


def _convert_many(
    tables: tuple[str, ...],
    reading: Telling,
    out_dir: Path,
    options: UrdfOptions,
    *,
    force: bool,
    json: bool,
) -> int:
    """Convert one after another; a bad file is reported and does not stop the rest."""
    done, failed = [], []
    targets: dict[Path, str] = {}
    for source in track(tables, "converting"):
        target = _target(source, None, out_dir)
        try:
            if target in targets:
                raise Dh2UrdfError(f"{source}: {target} was already written from {targets[target]}")
            done.append(_convert(source, reading, target, options, force))
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
        emit(f"{len(done)} files written to {out_dir}; {_checked(worst)} ({worst['source']})")
    if failed:
        note(f"{len(failed)} of {len(done) + len(failed)} tables were not converted")
    return 2 if failed else 0
