"""The package's files, and how they come into their folder whole."""

import os
import re
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dh2urdf.conversions.write import UrdfOptions, default_limits, verified_urdf
from dh2urdf.dh import DHTable
from dh2urdf.dh_io import TableLike, as_table, atomic_write
from dh2urdf.dh_io.files import path_of, shown
from dh2urdf.doors import flag
from dh2urdf.exceptions import ArgumentError, OutputError, OutputExistsError
from dh2urdf.export.blanks import filled
from dh2urdf.export.ros2.parameters import (
    KDL,
    PLAIN_NAME,
    coupled_words,
    joint_limits_yaml,
    kinematics_yaml,
)
from dh2urdf.export.ros2.self_collisions import Disabled, disabled_collisions
from dh2urdf.export.ros2.semantics import srdf_text

SAME = (
    *("CMakeLists.txt", "README.md", "package.xml"),
    *("launch/display.launch.py", "rviz/display.rviz"),
)
"""Files that are the same for every arm but for a few names."""

PACKAGE_NAME = re.compile(r"[a-z](?:_?[a-z0-9]+)*")
"""Names that ROS gives packages: https://ros.org/reps/rep-0144.html, of two signs at least."""


@dataclass(frozen=True)
class Ros2Package:
    """A description package, not yet written.

    Parameters
    ----------
    name : str
    files : dict of str
        Text of each file by its path in the package.
    max_error : float
        Largest difference [m and rad] between the URDF's frames and the DH product.
    disabled : tuple of Disabled
        Pairs of links whose collisions are not checked.
    warnings : tuple of str
        What had to be assumed.
    """

    name: str
    files: dict[str, str]
    max_error: float
    disabled: tuple[Disabled, ...]
    warnings: tuple[str, ...]


def ros2_package(table: TableLike, name: str, *, plugin: bool = False) -> Ros2Package:
    """Description package of an arm for ROS 2 and MoveIt 2.

    Parameters
    ----------
    table : DHTable, path or name of a table that ships
    name : str
        Name of the package: lower-case letters, digits and single underscores.
    plugin : bool
        With the arm's own solver as MoveIt's kinematics plugin.

    Raises
    ------
    ArgumentError
        ROS could have no package of that name.
    VerificationError
        The URDF would be another arm.
    NoSolverError
        There is no plugin for the arm.
    """
    table = as_table(table)
    _check_name(name)
    arm = re.sub(r"[^A-Za-z0-9_]+", "_", table.name).strip("_") or "arm"
    urdf, max_error, warnings = verified_urdf(table, UrdfOptions(collision=True))
    home = home_of(table)
    pairs = zip(table.joint_names, table.joints, strict=True)
    passive = [joint for joint, row in pairs if row.mimic is not None]
    disabled = disabled_collisions(urdf, np.array(list(home.values())))
    blanks, solver, own = _blanks(table, name, arm, disabled), KDL, dict[str, str]()
    if flag(plugin, "plugin"):
        from dh2urdf.export.ros2.plugin import plugin_blanks, plugin_files

        solver, own = f"{name}/KinematicsPlugin", plugin_files(table, blanks)
        blanks |= plugin_blanks(name)
    texts = {
        **{place: filled(__package__, Path(place).name, blanks) for place in SAME},
        "config/joint_limits.yaml": joint_limits_yaml(table),
        "config/kinematics.yaml": kinematics_yaml(table, solver),
        f"srdf/{arm}.srdf": srdf_text(table.name, f"link_{table.n}", home, disabled, passive),
        f"urdf/{arm}.urdf": urdf,
        **own,
    }
    odd = [joint for joint in table.joint_names if not PLAIN_NAME.fullmatch(joint)]
    if odd:
        warnings += (f"{', '.join(odd)}: ROS parameters take letters, digits and underscores",)
    return Ros2Package(name, texts, max_error, tuple(disabled), warnings)


def _blanks(table: DHTable, name: str, arm: str, disabled: Sequence[Disabled]) -> dict[str, str]:
    """What fills the files that are the same for every arm."""
    from dh2urdf import __version__

    return {
        "PACKAGE": name,
        "ARM": arm,
        "COUNT": _count(table),
        "VERSION": __version__,
        "DESCRIPTION": f"Description of an arm of {_count(table)} for ROS 2 and MoveIt 2",
        "COUPLED": "".join(f"\n{line}\n" for line in coupled_words(table)),
        "DISABLED": _counts(disabled),
        **dict.fromkeys(("PLUGIN_CMAKE", "PLUGIN_DEPENDS", "PLUGIN_ABOUT"), ""),
    }


def _count(table: DHTable) -> str:
    """How many joints an arm has, and how many of them follow others."""
    followers = sum(row.mimic is not None for row in table.joints)
    more = f" ({followers} follow{'s' * (followers == 1)} others)" if followers else ""
    return f"{table.n} joints{more}"


def write_ros2_package(
    table: TableLike, folder: str | os.PathLike[str], *, plugin: bool = False, force: bool = False
) -> Ros2Package:
    """Write a description package into a folder of its name.

    ``plugin`` as in :func:`ros2_package`. A new folder appears whole or not at all. ``force``
    writes the package's files into a folder that is there, each whole, and leaves what else it
    holds.

    Raises
    ------
    OutputExistsError
        The folder is there and holds something.
    """
    target = Path(os.path.realpath(path_of(folder)))
    held = target.exists() and (not target.is_dir() or any(target.iterdir()))
    if held and not target.is_dir():
        raise OutputError(f"{shown(target)}: it is a file; a package is a folder")
    if held and not force:
        raise OutputExistsError(
            f"{shown(target)}: exists and holds files; --force (force=True) writes over ours"
        )
    if not target.parent.is_dir():
        raise OutputError(f"{shown(target)}: cannot write: there is no such folder")
    package = ros2_package(table, target.name, plugin=plugin)
    if held:
        _write_over(package, target)
    else:
        _appear(package, target)
    return package


def home_of(table: DHTable) -> dict[str, float]:
    """Each joint's value [rad, m] at home: zero where its limits allow, else their middle.

    Those that follow others are where these put them.
    """
    values = {}
    for i, name in enumerate(table.joint_names):
        lower, upper = default_limits(table, i)
        values[name] = 0.0 if lower <= 0.0 <= upper else 0.5 * (lower + upper)
    for _ in table.joints:  # leaders may follow others
        for name, row in zip(table.joint_names, table.joints, strict=True):
            if row.mimic is not None:
                values[name] = row.mimic.multiplier * values[row.mimic.joint] + row.mimic.offset
    return values


def _check_name(name: str) -> None:
    if len(name) < 2 or not PACKAGE_NAME.fullmatch(name):
        raise ArgumentError(
            f"{shown(Path(name))}: the folder names the package, and ROS names packages by "
            "lower-case letters, digits and single underscores, such as my_arm_description"
        )


def _counts(disabled: Sequence[Disabled]) -> str:
    """How many pairs there are of each reason."""
    found = Counter(str(pair.reason) for pair in disabled)
    return ", ".join(f"{count} `{reason}`" for reason, count in found.items()) or "none"


def _appear(package: Ros2Package, target: Path) -> None:
    """Write beside the target, then move into its place."""
    with _told(target), tempfile.TemporaryDirectory(prefix=".dh2urdf-", dir=target.parent) as place:
        made = Path(place) / target.name
        for name, text in package.files.items():
            path = made / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        made.rename(target)


def _write_over(package: Ros2Package, target: Path) -> None:
    """Write each file whole into a folder that is there."""
    for name, text in package.files.items():
        path = target / name
        with _told(path.parent):
            path.parent.mkdir(parents=True, exist_ok=True)
        atomic_write(path, text)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Say of what the system refuses where it was to be."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{shown(path)}: cannot write: {error.strerror}") from None
