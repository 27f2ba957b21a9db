"""A DH table becomes a URDF file that was loaded back and compared before it was kept."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from dh2urdf.conversions.write.urdf_elements import MARK, UrdfOptions, urdf_text_and_warnings
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import TableLike, as_table, atomic_write, refuse_foreign
from dh2urdf.dh_io.files import path_of
from dh2urdf.doors import instance


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


def urdf_text(table: TableLike, options: UrdfOptions | None = None) -> str:
    """The URDF of a table as text, not yet checked; :func:`write_urdf` checks what it writes.

    Examples
    --------
    >>> from dh2urdf import urdf_text
    >>> print(urdf_text("planar_rr").splitlines()[1])
    <robot name="planar_rr">
    """
    return urdf_text_and_warnings(as_table(table), chosen_options(options))[0]


def chosen_options(options: UrdfOptions | None) -> UrdfOptions:
    """Options that were given, or the usual ones."""
    return UrdfOptions() if options is None else instance(options, "options", UrdfOptions)


def verified_urdf(
    table: TableLike, options: UrdfOptions | None = None
) -> tuple[str, float, tuple[str, ...]]:
    """Text of the URDF, largest FK difference [m and rad], warnings.

    A `VerificationError` where Pinocchio's frames differ from the DH product by more than 1e-9, or,
    with numbers rounded on request, by more than that can explain or anyone can use.
    """
    from dh2urdf.conversions.write.verify import verify_urdf_text

    table, chosen = as_table(table), chosen_options(options)
    text, warnings = urdf_text_and_warnings(table, chosen)
    return text, verify_urdf_text(text, table, digits=chosen.digits), warnings


def write_urdf(
    table: TableLike,
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
    table : DHTable, path or name of a table that ships
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

    Examples
    --------
    >>> import os, tempfile
    >>> from dh2urdf import write_urdf
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report = write_urdf("planar_rr", os.path.join(folder, "rr.urdf"))
    >>> report.max_error < 1e-9
    True
    """
    return write_verified(verified_urdf, table, path, options, force)


def write_verified(
    verified: Callable[[DHTable, UrdfOptions | None], tuple[str, float, tuple[str, ...]]],
    table: TableLike,
    path: str | os.PathLike[str],
    options: UrdfOptions | None,
    force: bool,
) -> ConversionReport:
    """Write what a writer of this package has made and checked."""
    table, target = as_table(table), path_of(path)
    if not force:
        refuse_foreign(target, "<dh2urdf", f"<!--{MARK}-->")
    text, max_error, warnings = verified(table, options)
    atomic_write(target, text)
    return ConversionReport(target, max_error, warnings)
