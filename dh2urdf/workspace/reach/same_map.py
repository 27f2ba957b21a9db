"""Whether a map that is there was begun with the settings that are asked for."""

import json
from typing import Any

import numpy as np

from dh2urdf.exceptions import ArgumentError
from dh2urdf.workspace.reach.dataset import KEY


def refuse_others(path: str, here: dict[str, Any], asked: dict[str, Any]) -> None:
    """Refuse to go on with a map of other settings, naming the first.

    Raises
    ------
    ArgumentError
    """
    for key, value in asked[KEY].items():
        was = here[KEY].get(key)
        if was == value:
            continue
        if key == "chain":
            chains = json.loads(here["chain"]), json.loads(asked["chain"])
            what, was, now = _other_part(*chains)
        else:
            what, now = key, value
        told, other = (str(v) if len(str(v)) <= 60 else "another" for v in (was, now))
        raise ArgumentError(
            f"{path}: is a map with {what} {told}, asked is {other}; maps are not mixed: give "
            "another path, or the settings it was begun with"
        )


def _other_part(here: dict[str, Any], asked: dict[str, Any]) -> tuple[str, Any, Any]:
    """The first joint, limit or link in which two chains differ, and both values."""
    names, others = here["joint_names"], asked["joint_names"]
    if names != others:
        return "joints", ", ".join(names), ", ".join(others)
    for k, name in enumerate(names):
        for key in ("joint_types", "lower", "upper"):
            a, b = here[key][k], asked[key][k]
            if a != b:
                what = {"joint_types": "type", "lower": "lower limit", "upper": "upper limit"}[key]
                free = "none" if what.endswith("limit") else ""
                return f"{what} of {name}", free if a is None else a, free if b is None else b
    for name, a, b in zip(["the base", *names], here["links"], asked["links"], strict=True):
        if a != b:
            row, column = np.argwhere(np.asarray(a) != np.asarray(b))[0]
            what = f"link after {name}, row {row + 1}, column {column + 1}:"
            return what, a[row][column], b[row][column]
    for key in ("value_names", "value_types", "value_lower", "value_upper", "matrix", "offset"):
        a, b = here.get(key, "none"), asked.get(key, "none")
        if a != b:
            words = {"matrix": "couplings", "offset": "offsets of couplings"}
            return words.get(key, f"{key.removeprefix('value_')} of q"), a, b
    raise AssertionError("chains of another digest are the same")
