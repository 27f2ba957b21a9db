"""Chains from joint axes typed by hand: screw axes, points and directions, or 4 x 4 frames.

Or a YAML or JSON file of them, homework without a URDF: one of three lists, in the base frame at
q = 0, in metres and radians::

    axes:                                   # a direction and a point on each axis
      - {axis: [0, 0, 1], point: [0, 0, 0], type: revolute, name: waist}
      - {axis: [0, 1, 0], point: [0, 0, 0.3]}
    # screws: [[0, 0, 1, 0, 0, 0], ...]     # or omega, v
    # frames: [[[1, 0, 0, 0], ...], ...]    # or 4 x 4 frames, z along the axis
    name: elbow_arm                         # else that of the file
    types: RR                               # for points and frames, if not all revolute
    tool: {xyz: [0.5, 0, 0.3], rpy: [0, 0, 0]}   # or a 4 x 4 matrix
    lower: [-3.14, null]                    # bounds of the joints, if there are any; upper, too
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, JOINTS, LENGTH, TABLE_BYTES, TEXT_CHARACTERS
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.tree_chain import frame_with_z
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh import JointType
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.dh_io.formats.yaml import yaml_values
from dh2urdf.dh_io.forms import CONF, READERS
from dh2urdf.dh_io.load import load_table
from dh2urdf.doors import found, real_array, text
from dh2urdf.exceptions import ArgumentError, PoseError, TableError, TableFileError, UrdfError
from dh2urdf.transforms import Array

SUFFIXES = (".yaml", ".yml", ".json", CONF)

LISTS = ("axes", "screws", "frames")
OTHERS = ("types", "tool", "names", "name", "lower", "upper")
AXIS_KEYS = ("axis", "point", "type", "name")

PITCH = 1e-9
"""Largest ``omega . v`` [m/rad] of a screw that still counts as a pure rotation."""


def typed_to_chain(
    source: ArrayLike,
    joint_types: str | Sequence[JointType | str] | None = None,
    tool: ArrayLike | None = None,
    names: Sequence[str] | None = None,
) -> SerialChain:
    """The chain of typed axes, all given in the base frame at q = 0.

    Shape (n, 6): screw axes ``(omega, v)`` with ``v = -omega x p`` for a point p on the axis [m],
    or ``omega = 0`` and the direction v of a sliding joint (Lynch and Park, *Modern Robotics*,
    section 4.1). Shape (n, 2, 3): a direction and a point [m] each. Shape (n, 4, 4): frames with
    z along the axis. All joints turn where ``joint_types`` is left out, but screws tell it
    themselves; without ``tool``, ``T_base_tool`` at q = 0, it is the last joint's frame.

    Raises
    ------
    UrdfError
        Wrong shape, NaN, a zero axis, a screw with pitch, or types that do not fit.
    PoseError
        A frame or tool that is not a rigid pose.
    """
    given = _checked(source)
    if given.shape[1:] == (4, 4):
        frames, types = list(tf.check_pose(given, what="joint frames")), _types(joint_types, given)
    elif given.shape[1:] == (6,):
        frames, types = _screws(given)
    else:
        types = _types(joint_types, given)
        frames = [_frame(i, axis, point) for i, (axis, point) in enumerate(given, 1)]
    poses = [np.eye(4), *frames, frames[-1] if tool is None else _tool_pose(tool)]
    n = len(frames)
    return SerialChain(
        links=np.stack([tf.inverse(a) @ b for a, b in pairwise(poses)]),
        joint_types=types,
        names=_names(names, n),
        lower=np.full(n, -math.inf),
        upper=np.full(n, math.inf),
    )


def _checked(source: ArrayLike) -> Array:
    """Typed axes of one of the three shapes, their numbers within bounds."""
    given = real_array(source, "joint axes", "numbers", UrdfError)
    if given.shape[1:] not in ((6,), (2, 3), (4, 4)) or len(given) == 0:
        raise UrdfError(
            f"joint axes of shape {given.shape}: allowed are (n, 6) screws, (n, 2, 3) directions "
            "and points, (n, 4, 4) frames"
        )
    if len(given) > JOINTS:
        raise UrdfError(f"joint axes: {len(given)} joints; a chain has up to {JOINTS}")
    fits = (np.abs(given) <= LENGTH).reshape(len(given), -1).all(axis=1)
    if not fits.all():
        raise UrdfError(f"joint {int(np.argmin(fits)) + 1}: NaN, infinity or beyond {LENGTH:.0e}")
    return given


def _tool_pose(tool: ArrayLike) -> Array:
    given = getattr(tool, "homogeneous", tool)
    matrix = real_array(given, "tool", "a (4, 4) matrix", UrdfError)
    if matrix.shape != (4, 4) or not (np.abs(matrix) <= LENGTH).all():
        raise UrdfError(f"tool: expected one (4, 4) matrix of numbers up to {LENGTH:g}")
    return tf.check_pose(matrix, what="tool")


def _list(given: object, what: str, expected: str, n: int) -> list[Any]:
    """The n entries of a sequence."""
    try:
        entries: list[Any] = list(given)  # type: ignore[call-overload]
    except TypeError:
        raise UrdfError(f"{what}: expected {expected}, got {found(given)}") from None
    if len(entries) != n:
        raise UrdfError(f"{what}: {len(entries)} for {n} joints")
    return entries


def _types(given: str | Sequence[JointType | str] | None, axes: Array) -> tuple[JointType, ...]:
    if given is None:
        return (JointType.REVOLUTE,) * len(axes)
    kinds = {"r": JointType.REVOLUTE, "p": JointType.PRISMATIC}
    kinds |= {str(kind): kind for kind in kinds.values()}
    types = []
    for item in _list(given, "joint_types", "R and P", len(axes)):
        if not isinstance(item, str) or item.lower() not in kinds:
            raise UrdfError(f"joint_types: {found(item)} is not R, P, revolute or prismatic")
        types.append(kinds[item.lower()])
    return tuple(types)


def _names(given: Sequence[str | None] | None, n: int) -> tuple[str, ...]:
    """Names of the joints, ``joint_1`` ... where there is none."""
    names = [None] * n if given is None else _list(given, "names", "texts", n)
    labels = [f"joint_{i}" if name is None else name for i, name in enumerate(names, 1)]
    for label in labels:
        if not isinstance(label, str) or not label or len(label) > TEXT_CHARACTERS:
            raise UrdfError(f"names: expected texts, got {found(label)}")
    if len(set(labels)) < n:
        raise UrdfError("names: two joints of one name")
    return tuple(labels)


def _screws(screws: Array) -> tuple[list[Array], tuple[JointType, ...]]:
    frames, types = [], []
    for i, screw in enumerate(screws, 1):
        omega, v = screw[:3], screw[3:]
        length = float(np.linalg.norm(omega))
        if 0 < length < 1e-9:
            raise UrdfError(f"joint {i}: a zero axis")
        if length == 0:
            frames.append(_frame(i, v, np.zeros(3)))
            types.append(JointType.PRISMATIC)
            continue
        pitch = float(omega @ v) / length**2
        if abs(pitch) > PITCH:
            raise UrdfError(
                f"joint {i}: a screw of pitch {pitch:.3g} m/rad; a joint turns or slides"
            )
        frames.append(_frame(i, omega, np.cross(omega, v) / length**2))
        types.append(JointType.REVOLUTE)
    return frames, tuple(types)


def _frame(i: int, axis: Array, point: Array) -> Array:
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        raise UrdfError(f"joint {i}: a zero axis")
    if np.abs(point).max() > LENGTH:
        raise UrdfError(f"joint {i}: a point beyond {LENGTH:.0e} m")
    return tf.pose(frame_with_z(axis if length == 1.0 else axis / length), point)


def read_axes(path: Path, model: str | None = None) -> tuple[SerialChain, str]:
    """The chain of a file of joint axes or in another form, and its name.

    A calibration.conf may need the UR ``model`` that it belongs to.

    Raises
    ------
    UrdfError, TableFileError
        With the key that is wrong.
    """
    where = shown(path)
    if path.suffix.lower() == CONF:
        return _chain_of_table(path, model)
    if model is not None:
        raise ArgumentError(f"model: only a calibration.conf needs it, not {where}")
    try:
        content = yaml_values(read_text(path, TABLE_BYTES, UrdfError), where)
    except TableFileError as error:
        raise UrdfError(str(error)) from None
    if not isinstance(content, dict):
        raise UrdfError(f"{where}: expected keys such as {', '.join(LISTS)}, got {found(content)}")
    if not any(key in content for key in LISTS) and any(key in content for key in READERS):
        return _chain_of_table(path)
    try:
        return axes_to_chain(content, path.stem)
    except UrdfError as error:
        raise UrdfError(f"{where}: {error}") from None


def _chain_of_table(path: Path, model: str | None = None) -> tuple[SerialChain, str]:
    """The chain of a file that is read as a table, and its name."""
    table = load_table(path, model=model)
    return dh_to_chain(table), table.name


def axes_to_chain(content: Mapping[str, Any], name: str) -> tuple[SerialChain, str]:
    """The chain of a file's keys, and its name, else the given one; UrdfError names the key."""
    given = [key for key in LISTS if key in content]
    if len(given) != 1:
        hint = " (a DH table? `dh2urdf convert` reads those)" if "convention" in content else ""
        raise UrdfError(f"needs one of the lists {', '.join(LISTS)}{hint}")
    source, types, names = content[given[0]], content.get("types"), content.get("names")
    try:
        _check_keys(content, (*LISTS, *OTHERS))
        if given[0] == "axes":
            source, types, names = _axes(source, types, names)
        name = text(content.get("name") or name, "name", UrdfError)
        chain = typed_to_chain(source, types, _tool(content.get("tool")), names)
        lower, upper = (_bounds(content, key, chain.n) for key in ("lower", "upper"))
        return replace(chain, lower=lower, upper=upper), name
    except (UrdfError, PoseError, TableError) as error:
        raise UrdfError(f"{given[0]}: {error}") from None


def _bounds(content: Mapping[str, Any], key: str, n: int) -> Array:
    """Bounds of the joints [rad] or [m], infinite where there is none."""
    none = math.inf if key == "upper" else -math.inf
    cells = _list(content.get(key) or [None] * n, key, "numbers", n)
    bounds = real_array([none if v is None else v for v in cells], key, "numbers", UrdfError)
    if np.isnan(bounds).any():
        raise UrdfError(f"{key}: expected numbers, got {found(cells)}")
    return bounds


def _check_keys(content: Mapping[str, Any], allowed: Sequence[str], what: str = "") -> None:
    unknown = [key for key in content if key not in allowed]
    if unknown:
        raise UrdfError(f"{what}{found(unknown[0])} is not known; allowed: {', '.join(allowed)}")


def _axes(source: Any, types: Any, names: Any) -> tuple[list[Any], Any, Any]:
    """Directions and points, with the types and names that the entries carry themselves."""
    if not isinstance(source, list):
        raise UrdfError(f"expected a list, got {found(source)}")
    pairs, kinds, labels = [], [], []
    for i, entry in enumerate(source, 1):
        if not isinstance(entry, dict) or "axis" not in entry:
            raise UrdfError(f"joint {i}: expected {{axis: [x, y, z], point: [x, y, z]}}")
        _check_keys(entry, AXIS_KEYS, f"joint {i}: ")
        pairs.append([entry["axis"], entry.get("point", [0, 0, 0])])
        kinds.append(entry.get("type") or "revolute")
        labels.append(entry.get("name"))
    return pairs, types or kinds, names or labels


def _tool(tool: Any) -> Any:
    """A matrix, or xyz and rpy."""
    if not isinstance(tool, dict):
        return tool
    _check_keys(tool, ("xyz", "rpy"), "tool: ")
    triples = []
    for key, most in (("xyz", LENGTH), ("rpy", ANGLE)):
        triple = real_array(tool.get(key, (0, 0, 0)), f"tool: {key}", "three numbers", UrdfError)
        if triple.shape != (3,) or not (np.abs(triple) <= most).all():
            raise UrdfError(f"tool: {key}: expected three numbers up to {most:g}")
        triples.append(triple.tolist())
    return tf.origin_matrix(*triples)
