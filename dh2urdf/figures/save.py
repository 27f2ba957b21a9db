"""A figure as bytes or as a file, byte for byte the same each time."""

from __future__ import annotations

import io
import os
from pathlib import Path

from dh2urdf.dh_io import atomic_write
from dh2urdf.exceptions import OutputError
from dh2urdf.figures.style import RC, Picture, mpl

__all__ = ["FORMATS", "picture_bytes", "save_picture"]

FORMATS = ("png", "svg", "pdf")
"""Formats written, by suffix."""

_NO_DATES: dict[str, dict[str, object]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "ModDate": None, "Creator": None, "Producer": None},
}


def picture_bytes(figure: Picture, format: str, *, dpi: float = 180.0) -> bytes:
    """The figure in one of :data:`FORMATS`; ``dpi`` is the resolution of a PNG."""
    out = io.BytesIO()
    with mpl.rc_context(RC):
        figure.savefig(out, format=format, dpi=dpi, metadata=_NO_DATES[format])
    return out.getvalue()


def format_of(path: Path) -> str:
    """Format by the suffix of a path.

    Raises
    ------
    OutputError
        No such format.
    """
    suffix = path.suffix.lower().removeprefix(".")
    if suffix not in FORMATS:
        raise OutputError(f"{path}: figures are written as .{', .'.join(FORMATS)}")
    return suffix


def save_picture(figure: Picture, path: str | os.PathLike[str], *, dpi: float = 180.0) -> Path:
    """Write a figure; the suffix chooses the format, the file appears whole or not at all."""
    target = Path(path)
    return atomic_write(target, picture_bytes(figure, format_of(target), dpi=dpi))
