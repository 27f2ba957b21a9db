"""A DH table becomes a URDF file that was loaded back and compared before it was kept."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from dh2urdf.bounds import ROBOT_BYTES
from dh2urdf.conversions.dh_to_urdf import UrdfOptions, urdf_text_and_warnings
from dh2urdf.conversions.read_urdf import parse_xml
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import atomic_write, parse_table
from dh2urdf.dh_io.files import read_bytes, shown
from dh2urdf.exceptions import OutputExistsError, TableFileError, UrdfError

__all__ = ["ConversionReport", "embedded_table", "urdf_text", "verified_urdf", "write_urdf"]


@dataclass(frozen=True)
class ConversionReport:
    """What was written, and the proof.

    Parameters
    ----------
    path : Path
        The file.
    max_error : float
        Largest difference [m and rad] between the file's frames, placed by Pinocchio, and the
        DH product over random configurations.
    warnings : tuple of str
        What had to be assumed.
    """

    path: Path
    max_error: float
    warnings: tuple[str, ...]


def urdf_text(table: DHTable, options: UrdfOptions | None = None) -> str:
    """The URDF of a table as text, not yet checked; :func:`write_urdf` checks what it writes."""
    return urdf_text_and_warnings(table, options or UrdfOptions())[0]


def verified_urdf(
    table: DHTable, options: UrdfOptions | None = None
) -> tuple[str, float, tuple[str, ...]]:
    """Text of the URDF, largest FK difference [m and rad], warnings.

    Raises
    ------
    VerificationError
        Pinocchio's frames differ from the DH product by more than 1e-9, or, with numbers
        rounded on request, by more than that can explain.
    """
    from dh2urdf.conversions.verify import allowed_error, verify_urdf_text

    chosen = options or UrdfOptions()
    text, warnings = urdf_text_and_warnings(table, chosen)
    allowed = allowed_error(table, chosen.digits)
    return text, verify_urdf_text(text, table, allowed=allowed), warnings


def write_urdf(
    table: DHTable,
    path: str | os.PathLike[str],
    *,
    options: UrdfOptions | None = None,
    force: bool = False,
) -> ConversionReport:
    """Write the URDF of a table, proved by Pinocchio.

    The text is loaded by Pinocchio and its frames are compared with the DH product on random
    configurations before anything is written; the file appears whole or not at all.

    Parameters
    ----------
    table : DHTable
    path : path
        The file to write.
    options : UrdfOptions
    force : bool
        Replace a file that this package did not write.

    Returns
    -------
    ConversionReport

    Raises
    ------
    VerificationError
        The file would differ from the table by more than 1e-9.
    OutputExistsError
        The path holds a file that this package did not write.
    """
    target = Path(path)
    if not force:
        refuse_foreign(target)
    text, max_error, warnings = verified_urdf(table, options)
    atomic_write(target, text)
    return ConversionReport(target, max_error, warnings)


def refuse_foreign(target: Path) -> None:
    """Raise OutputExistsError where the path holds a file without the mark of this package."""
    if not target.is_file():
        return
    with target.open("rb") as file:
        head = file.read(65536)
    if head.strip() and b"<dh2urdf" not in head:
        raise OutputExistsError(
            f"{target}: exists and was not written by dh2urdf; --force (force=True) replaces it"
        )


def embedded_table(path: str | os.PathLike[str]) -> DHTable:
    """The DH table that a URDF written by this package carries, identical to the original.

    Raises
    ------
    UrdfError
        Not XML, or no embedded table.
    """
    root = parse_xml(read_bytes(path, ROBOT_BYTES, UrdfError), shown(path))
    text = root.findtext("dh2urdf")
    if not text:
        raise UrdfError(
            f"{path}: no DH table is embedded in this URDF; `dh2urdf extract` finds one by "
            "frame assignment"
        )
    try:
        return parse_table(text, "json", f"{path}:<dh2urdf>").table
    except TableFileError as error:
        raise UrdfError(f"{path}: the embedded DH table is damaged: {error}") from None
