"""Mesh files: where a name in a URDF points, and how large the mesh is."""

import os
import re
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType
from urllib.parse import unquote

import numpy as np

from dh2urdf.conversions.read import find_package
from dh2urdf.dh_io.files import read_bytes
from dh2urdf.exceptions import UrdfError

LARGEST = 50_000_000
"""Bytes of a mesh that is still looked into."""

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""A triangle of a binary STL file."""


def locate(
    filename: str, urdf: Path, packages: Mapping[str, str] = MappingProxyType({})
) -> Path | None:
    """The file that a mesh's name means; None where there is none.

    ``package://`` and ``model://`` are looked for in the packages given, in ``ROS_PACKAGE_PATH``,
    in the folders above the URDF and in packages beside it, a plain path from the URDF's folder.
    """
    scheme, rest = _split(filename)
    folders = list(urdf.resolve().parents)
    if scheme in ("package", "model"):
        search = [Path(p) for p in os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep) if p]
        rest = rest.lstrip("/")
        package, _, inside = rest.partition("/")
        candidates = [folder / rest for folder in (*search, *folders)]
        candidates += [folder / inside for folder in (*search, *folders) if folder.name == package]
        if package in packages or not any(map(os.path.isfile, candidates)):
            with suppress(UrdfError):
                candidates.insert(0, find_package(package, urdf, packages) / inside)
    else:
        name = unquote(rest) if scheme == "file" else filename
        candidates = [folder / name for folder in (urdf.parent, folders[0])]
    return next((path for path in candidates if os.path.isfile(path)), None)


def is_remote(filename: str) -> bool:
    """True for a name that only the network can resolve."""
    return _split(filename)[0] in ("http", "https")


def _split(filename: str) -> tuple[str, str]:
    scheme, mark, rest = filename.partition("://")
    return (scheme, rest) if mark and re.fullmatch("[a-z]+", scheme) else ("", filename)


def stl_extent(path: Path) -> float | None:
    """Longest side [file's unit] of the box around an STL mesh; None for any other file."""
    if path.suffix.lower() != ".stl" or path.stat().st_size > LARGEST:
        return None
    data = read_bytes(path, LARGEST, UrdfError)
    count = int.from_bytes(data[80:84], "little")
    if len(data) == 84 + 50 * count and count:
        points = np.frombuffer(data, RECORD, count, 84)["corners"].reshape(-1, 3)
    else:
        found = re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data)
        try:
            points = np.array(found, float).reshape(-1, 3)
        except ValueError:
            return None
    if not len(points) or not np.isfinite(points).all():
        return None
    return float(np.ptp(points.astype(float), axis=0).max())
