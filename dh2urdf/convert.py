"""A table, or the one of a robot description, in any format that is written: the entry point."""

from pathlib import Path
from typing import Any, NamedTuple

from dh2urdf.conversions.assign import in_convention
from dh2urdf.conversions.write import (
    UrdfOptions,
    table_text_and_error,
    verified_mjcf,
    verified_urdf,
)
from dh2urdf.dh import DHConvention, DHTable
from dh2urdf.dh_io import READ_BACK, WRITTEN, TableFile, Units, atomic_write, refuse_foreign
from dh2urdf.dh_io.formats.written import MARK
from dh2urdf.extract import extract_dh

FORMATS = {".urdf": "urdf", ".xml": "mjcf", ".mjcf": "mjcf"} | WRITTEN
"""Format of a written file by its suffix."""

SUFFIXES = {format: suffix for suffix, format in reversed(FORMATS.items())}
"""First suffix of each format."""

_READERS = {"urdf": ("Pinocchio", verified_urdf), "mjcf": ("MuJoCo", verified_mjcf)}

_MARKS = {"urdf": ("<dh2urdf", MARK), "mjcf": (MARK,), "latex": (MARK,), "html": (MARK,)}
"""By what a file of this package is known; others are written over only by the same text."""


class Converted(NamedTuple):
    """A text and its proof.

    Parameters
    ----------
    max_error : float
        Largest difference of frames [m and rad] between what was read back and the table given,
        the change of convention and rounding included.
    checked : str
        What was done to be sure, in words.
    """

    format: str
    text: str
    max_error: float
    checked: str
    warnings: tuple[str, ...] = ()


def table_of_description(
    source: str, convention: DHConvention | str | None = None, **given: Any
) -> TableFile:
    """The table of a URDF, xacro or MJCF, by path or as a text: carried by it, or extracted.

    ``given`` are the arguments and packages of a xacro, as :func:`extract_dh` takes them.
    """
    found = extract_dh(source, convention=None, **given)
    if found.steps and convention is not None:
        found = extract_dh(source, convention=convention, **given)
    warnings = found.warnings
    if found.steps:
        chain = f"from {found.base} to {found.tip}"
        note = f"the table of the chain {chain} was extracted; meshes and branches stay behind"
        warnings = (*warnings, f"{note} (`dh2urdf extract` explains it)")
    return TableFile(found.table, warnings)


def converted(
    table: DHTable,
    format: str,
    units: Units,
    *,
    convention: DHConvention | str | None = None,
    options: UrdfOptions | None = None,
) -> Converted:
    """The text of a table in a format, read back and compared where a program reads it.

    Raises
    ------
    VerificationError
        It would be another arm.
    """
    digits = None if options is None else options.digits
    wanted, turned = in_convention(table, convention)
    words = [] if wanted is table else [f"{wanted.convention} convention, tool within {turned:.1e}"]
    if format in _READERS:
        reader, verified = _READERS[format]
        text, error, warnings = verified(wanted, options)
        said = f"largest difference between {reader} and the DH product {error:.1e}"
        return Converted(format, text, max(error, turned), "; ".join([said, *words]), warnings)
    text, error = table_text_and_error(wanted, format, units, digits)
    said = "reads back as the same table" if format in READ_BACK else "for reading, not read back"
    if digits is not None and format in READ_BACK:
        off = f"the arm is up to {error:.1e} m or rad off" if error else "the arm is the same"
        said = f"reads back; rounded to {digits} decimals, {off}"
    return Converted(format, text, max(error, turned), "; ".join([said, *words]))


def write_converted(made: Converted, path: Path, *, force: bool) -> None:
    """Write a text, not over what somebody else has written."""
    if not force:
        refuse_foreign(path, *_MARKS.get(made.format, ()), same=made.text.encode(errors="replace"))
    atomic_write(path, made.text)
