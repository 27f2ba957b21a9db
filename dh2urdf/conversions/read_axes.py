"""Joint axes typed into a YAML or JSON file: homework without a URDF.

One of three lists, in the base frame at q = 0, in metres and radians::

    axes:                                   # a direction and a point on each axis
      - {axis: [0, 0, 1], point: [0, 0, 0], type: revolute, name: waist}
      - {axis: [0, 1, 0], point: [0, 0, 0.3]}
    # screws: [[0, 0, 1, 0, 0, 0], ...]     # or omega, v
    # frames: [[[1, 0, 0, 0], ...], ...]    # or 4 x 4 frames, z along the axis
    types: RR                               # for points and frames, if not all revolute
    tool: {xyz: [0.5, 0, 0.3], rpy: [0, 0, 0]}   # or a 4 x 4 matrix
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.typed_axes import typed_to_chain
from dh2urdf.dh import Origin
from dh2urdf.exceptions import PoseError, TableError, UrdfError

__all__ = ["SUFFIXES", "read_axes"]

SUFFIXES = (".yaml", ".yml", ".json")

LISTS = ("axes", "screws", "frames")
OTHERS = ("types", "tool", "names", "name")
AXIS_KEYS = ("axis", "point", "type", "name")


def read_axes(path: Path, data: bytes) -> SerialChain:
    """The chain of a file of joint axes.

    Raises
    ------
    UrdfError
        Not such a file; the message names the key.
    """
    content = _load(path, data)
    given = [key for key in LISTS if key in content]
    if len(given) != 1:
        hint = " (a DH table? `dh2urdf convert` reads those)" if "convention" in content else ""
        raise UrdfError(f"{path}: needs one of the lists {', '.join(LISTS)}{hint}")
    unknown = [str(key) for key in content if key not in (*LISTS, *OTHERS)]
    if unknown:
        raise UrdfError(
            f"{path}: {unknown[0]!r} is not known; allowed: {', '.join(LISTS + OTHERS)}"
        )
    source, types, names = content[given[0]], content.get("types"), content.get("names")
    try:
        if given[0] == "axes":
            source, types, names = _axes(source, types, names)
        return typed_to_chain(source, types, _tool(content.get("tool")), names)
    except (UrdfError, PoseError, TableError) as error:
        raise UrdfError(f"{path}: {given[0]}: {error}") from None


def _load(path: Path, data: bytes) -> Mapping[str, Any]:
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        content = YAML(typ="safe", pure=True).load(data.decode("utf-8"))
    except (YAMLError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{path}:{mark.line + 1}" if mark else str(path)
        raise UrdfError(f"{place}: {getattr(error, 'problem', None) or error}") from None
    if not isinstance(content, Mapping):
        raise UrdfError(f"{path}: expected keys such as {', '.join(LISTS)}, got {content!r:.40}")
    return content


def _axes(
    source: Any, types: Any, names: Any
) -> tuple[list[Any], Sequence[Any] | None, Sequence[str] | None]:
    """Directions and points, with the types and names that the entries carry themselves."""
    if not isinstance(source, Sequence) or isinstance(source, str):
        raise UrdfError(f"expected a list, got {source!r:.40}")
    pairs, kinds, labels = [], [], []
    for i, entry in enumerate(source, 1):
        if not isinstance(entry, Mapping) or "axis" not in entry:
            raise UrdfError(f"joint {i}: expected {{axis: [x, y, z], point: [x, y, z]}}")
        unknown = [str(key) for key in entry if key not in AXIS_KEYS]
        if unknown:
            allowed = ", ".join(AXIS_KEYS)
            raise UrdfError(f"joint {i}: {unknown[0]!r} is not known; allowed: {allowed}")
        pairs.append([entry["axis"], entry.get("point", [0, 0, 0])])
        kinds.append(entry.get("type", "revolute"))
        labels.append(str(entry.get("name", f"joint_{i}")))
    return pairs, types or kinds, names or labels


def _tool(tool: Any) -> Any:
    """A matrix, or xyz and rpy."""
    if not isinstance(tool, Mapping):
        return tool
    unknown = [str(key) for key in tool if key not in ("xyz", "rpy")]
    if unknown:
        raise UrdfError(f"tool: {unknown[0]!r} is not known; allowed: xyz, rpy")
    zero = (0.0, 0.0, 0.0)
    return Origin(tool.get("xyz", zero), tool.get("rpy", zero)).matrix
