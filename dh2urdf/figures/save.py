"""A figure as bytes or as a file, byte for byte the same each time."""

import os
from pathlib import Path

from dh2urdf.bounds import DPI
from dh2urdf.dh_io import atomic_write
from dh2urdf.doors import number
from dh2urdf.exceptions import OutputError, OutputExistsError
from dh2urdf.figures.style import MARK, Picture, picture_bytes

FORMATS = ("png", "svg", "pdf")
"""Formats written, by suffix."""


def check_target(path: str | os.PathLike[str], *, force: bool) -> str:
    """Format of a path at which a figure may be written; raises as :func:`save_picture`."""
    target = Path(path)
    format = target.suffix.lower().removeprefix(".")
    if format not in FORMATS:
        raise OutputError(f"{path}: figures are written as .{', .'.join(FORMATS)}")
    if not force and target.is_file() and MARK.encode() not in target.read_bytes():
        raise OutputExistsError(
            f"{target}: exists and was not drawn by dh2urdf; --force (force=True) replaces it"
        )
    return format


def save_picture(
    figure: Picture, path: str | os.PathLike[str], *, dpi: float = 180.0, force: bool = True
) -> Path:
    """Write a figure; the suffix chooses the format, the file appears whole or not at all.

    Parameters
    ----------
    figure : Picture
    path : path
    dpi : float
        Resolution of a PNG.
    force : bool
        Replace a file that this package did not write.

    Raises
    ------
    OutputError
        A format that is not written here, or a place that cannot be written.
    OutputExistsError
        Without ``force``: somebody else's file is in the way.
    """
    number(dpi, "dpi", *DPI)
    format = check_target(path, force=force)
    return atomic_write(path, picture_bytes(figure, format, dpi=dpi))
