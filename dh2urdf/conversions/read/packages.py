"""ROS packages without ROS: where the one of a name lies, and what it holds."""

import os
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import islice
from pathlib import Path

from dh2urdf.bounds import PACKAGE_FOLDERS
from dh2urdf.exceptions import UrdfError

MANIFEST = "package.xml"

_VARIABLES = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH")
_NAME = re.compile(r"<name>\s*([\w.-]+)\s*</name>")
_SKIPPED = {"build", "install", "log", "devel", "node_modules", "meshes"}
_DEPTH = 4
"""Folders below the one of a workspace in which a package may lie."""

_ABOVE = 3
"""Folders above the outermost package, or above the file, that may be its workspace."""


def find_package(name: str, near: Path, given: Mapping[str, str] | None = None) -> Path:
    """Folder of a package.

    The one that was given; the one that holds the file ``near``; those of ``ROS_PACKAGE_PATH``
    and ``AMENT_PREFIX_PATH``; those beside it in its workspace.

    Raises
    ------
    UrdfError
        There is none, or the folder given is none.
    """
    if folder := (given or {}).get(name):
        if not os.path.isdir(folder):
            raise UrdfError(f"package {name}: {folder} is not a folder")
        return Path(folder)
    variables = [os.environ.get(variable, "") for variable in _VARIABLES]
    if (path := _found(name, near.resolve(), *variables)) is not None:
        return path
    around = f" (beside the file: {', '.join(beside)})" if (beside := _names_beside(near)) else ""
    raise UrdfError(
        f"the package {name!r} is not found{around}; give --package {name}=DIR, or put its "
        "workspace on ROS_PACKAGE_PATH"
    )


@lru_cache(maxsize=256)
def _found(name: str, near: Path, ros: str, ament: str) -> Path | None:
    """The first candidate that is a package of this name."""
    each = _candidates(name, near, _listed(ros), _listed(ament))
    return next((path for path in each if path.name == name or package_name(path) == name), None)


def package_name(folder: Path) -> str:
    """Name in a folder's ``package.xml``; empty where it has none."""
    try:
        with open(folder / MANIFEST, encoding="utf-8", errors="replace") as file:
            match = _NAME.search(file.read(100_000))
    except OSError:
        return ""
    return match[1] if match else ""


def package_of(file: Path) -> Path | None:
    """Folder of the innermost package that holds a file."""
    above = file.resolve().parents
    return next((folder for folder in above if (folder / MANIFEST).is_file()), None)


def _candidates(name: str, near: Path, ros: list[Path], ament: list[Path]) -> Iterator[Path]:
    """Folders that may be the package, the likeliest first."""
    above = list(near.resolve().parents)
    yield from (folder for folder in above if (folder / MANIFEST).is_file() or folder.name == name)
    for folder in ros:
        yield from (path for path in (folder, folder / name) if path.is_dir())
        yield from _packages_below(folder)
    for folder in ament:
        if (folder / "share" / name).is_dir():
            yield folder / "share" / name
    for folder in _workspaces(near):
        if (folder / name).is_dir():
            yield folder / name
        yield from _packages_below(folder)


def _listed(variable: str) -> list[Path]:
    return [Path(p) for p in variable.split(os.pathsep) if p]


def _workspaces(near: Path) -> list[Path]:
    """Folders that may hold packages beside the file's, nearest first."""
    above = list(near.resolve().parents)
    outer = max((k for k, f in enumerate(above) if (f / MANIFEST).is_file()), default=0)
    return [folder for folder in above[outer + 1 : outer + 1 + _ABOVE] if len(folder.parts) > 2]


def _packages_below(folder: Path) -> Iterator[Path]:
    """Folders with a ``package.xml``, of no more than so many folders gone through."""
    depth = len(folder.parts)
    for place, inside, files in islice(os.walk(folder), PACKAGE_FOLDERS):
        if MANIFEST in files:
            yield Path(place)
            inside.clear()
        deep = len(Path(place).parts) - depth >= _DEPTH
        inside[:] = [] if deep else [d for d in inside if d[0] != "." and d not in _SKIPPED]


def _names_beside(near: Path) -> list[str]:
    folders = [f for folder in _workspaces(near)[:1] for f in islice(_packages_below(folder), 12)]
    own = package_of(near)
    names = [package_name(folder) for folder in (*([own] if own else []), *folders)]
    return list(dict.fromkeys(filter(None, names)))
