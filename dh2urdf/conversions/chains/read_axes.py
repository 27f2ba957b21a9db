"""Joint axes typed into a YAML or JSON file: homework without a URDF.

One of three lists, in the base frame at q = 0, in metres and radians::

    axes:                                   # a direction and a point on each axis
      - {axis: [0, 0, 1], point: [0, 0, 0], type: revolute, name: waist}
      - {axis: [0, 1, 0], point: [0, 0, 0.3]}
    # screws: [[0, 0, 1, 0, 0, 0], ...]     # or omega, v
    # frames: [[[1, 0, 0, 0], ...], ...]    # or 4 x 4 frames, z along the axis
    name: elbow_arm                         # else that of the file
    types: RR                               # for points and frames, if not all revolute
    tool: {xyz: [0.5, 0, 0.3], rpy: [0, 0, 0]}   # or a 4 x 4 matrix
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.bounds import ANGLE, LENGTH, TABLE_BYTES
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.chains.typed_axes import typed_to_chain
from dh2urdf.dh_io.files import read_text, shown
from dh2urdf.dh_io.formats.yaml import yaml_values
from dh2urdf.doors import found, real_array, text
from dh2urdf.exceptions import PoseError, TableError, TableFileError, UrdfError

SUFFIXES = (".yaml", ".yml", ".json")

LISTS = ("axes", "screws", "frames")
OTHERS = ("types", "tool", "names", "name")
AXIS_KEYS = ("axis", "point", "type", "name")


def read_axes(path: Path) -> tuple[SerialChain, str]:
    """The chain of a file of joint axes, and its name.

    Raises
    ------
    UrdfError
        Not such a file; the message names the key.
    """
    where = shown(path)
    try:
        content = yaml_values(read_text(path, TABLE_BYTES, UrdfError), where)
    except TableFileError as error:
        raise UrdfError(str(error)) from None
    if not isinstance(content, dict):
        raise UrdfError(f"{where}: expected keys such as {', '.join(LISTS)}, got {found(content)}")
    given = [key for key in LISTS if key in content]
    if len(given) != 1:
        hint = " (a DH table? `dh2urdf convert` reads those)" if "convention" in content else ""
        raise UrdfError(f"{where}: needs one of the lists {', '.join(LISTS)}{hint}")
    source, types, names = content[given[0]], content.get("types"), content.get("names")
    try:
        _check_keys(content, (*LISTS, *OTHERS))
        if given[0] == "axes":
            source, types, names = _axes(source, types, names)
        name = text(content.get("name") or path.stem, "name", UrdfError)
        return typed_to_chain(source, types, _tool(content.get("tool")), names), name
    except (UrdfError, PoseError, TableError) as error:
        raise UrdfError(f"{where}: {given[0]}: {error}") from None


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
