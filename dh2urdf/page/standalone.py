"""One file with everything: the arm as data, our scripts and style, and no request to anywhere."""

import base64
import json
import os
from html import escape
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.conversions.write import grouped_rows, link_frames
from dh2urdf.dh import DHRow, DHTable, JointType
from dh2urdf.dh.print import title
from dh2urdf.dh.variables import moved_by
from dh2urdf.dh_io import atomic_write, refuse_foreign
from dh2urdf.dh_io.files import path_of, shown
from dh2urdf.drawing.arm import DrawnArm, drawn_arm, table_of, zero_configuration
from dh2urdf.drawing.colours import AXIS, QUANTITY
from dh2urdf.drawing.lesson import motions
from dh2urdf.drawing.row import subscript
from dh2urdf.drawing.surfaces import Node, TableDrawing
from dh2urdf.exceptions import OutputError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, inverse

HERE = Path(__file__).parent

SCRIPTS = ("kinematics.js", "projection.js", "bodies.js", "marks.js", "numbers.js", "panel.js")

SUFFIXES = (".html", ".htm")

MARK = '<meta name="generator" content="dh2urdf'
"""What a page of ours has near its top."""

TURN = 2 * np.pi
"""Range of a slider [rad] where a joint has no limit."""


def page_html(robot: Robot, q: ArrayLike | None = None) -> str:
    """The page of an arm.

    It shows the drawn bodies of the arm's DH table, which for an arm without one is found, its
    frames, sliders within the limits, the table, the tip's pose, and each row motion by motion.

    Parameters
    ----------
    robot : Robot
    q : array_like, shape (n,), optional
        Configuration to start from [rad] or [m]; zero, or what the limits allow nearest to it.

    Returns
    -------
    str
        One HTML document, no part of which is loaded from elsewhere.

    Raises
    ------
    ConfigurationError
    """
    arm = drawn_arm(table_of(robot))
    data = json.dumps(_data(robot, arm, zero_configuration(robot, q)), ensure_ascii=False)
    parts = {
        "TITLE": escape(title(arm.table).partition("\n")[0]),
        "VERSION": escape(version("dh2urdf")),
        "STYLE": (HERE / "page.css").read_text(encoding="utf-8"),
        "DATA": data.replace("<", "\\u003c"),
        "SCRIPT": "\n".join((HERE / name).read_text(encoding="utf-8") for name in SCRIPTS),
    }
    pieces = (HERE / "page.html").read_text(encoding="utf-8").split("@@")
    return "".join(parts[p] if k % 2 else p for k, p in enumerate(pieces))


def save_page(
    robot: Robot, path: str | os.PathLike[str], q: ArrayLike | None = None, *, force: bool = False
) -> Path:
    """Write the page of an arm; a file that is no such page is replaced with ``force`` only.

    Raises
    ------
    ConfigurationError, OutputError, OutputExistsError
    """
    target = path_of(path)
    if target.suffix.lower() not in SUFFIXES:
        raise OutputError(f"{shown(target)}: pages are written as {' or '.join(SUFFIXES)}")
    if not force:
        refuse_foreign(target, MARK)
    return atomic_write(path, page_html(robot, q))


def _data(robot: Robot, arm: DrawnArm, q: Array) -> dict[str, Any]:
    """What the page knows of the arm: metres, radians, matrices by rows."""
    table = arm.table
    low, high = robot.bounded(max(robot.chain.size, 0.1), TURN)
    offset = robot.chain_configuration(np.zeros(robot.n))
    gain = np.stack([robot.chain_configuration(e) - offset for e in np.eye(robot.n)], axis=1)
    names = zip(robot.joint_names, robot.slides.tolist(), low.tolist(), high.tolist(), strict=True)
    return {
        "name": table.name,
        "title": title(table),
        "standard": table.convention == "standard",
        "source": table.source,
        "base": robot.base,
        "tip": robot.tip,
        "size": arm.size,
        "joints": [dict(zip(("name", "slides", "low", "high"), j, strict=True)) for j in names],
        "start": q.tolist(),
        "offset": offset.tolist(),
        "gain": gain.tolist(),
        "first": table.base_frame.ravel().tolist(),
        "rows": [_row(table, i, row) for i, (row, _) in enumerate(grouped_rows(table)[1], 1)],
        "tool": table.tool.matrix.ravel().tolist(),
        "shifts": arm.shifts.tolist(),
        "nodes": _nodes(arm),
        "colours": {**AXIS, **QUANTITY},
    }


def _row(table: DHTable, i: int, row: DHRow) -> dict[str, Any]:
    """One joint's row, and what leads from it to frame i."""
    steps = motions(table, i)
    variable, constant = moved_by(table.joint_map, i - 1, row.sign, lambda k: subscript("q", k))
    after = next((m.T.ravel().tolist() for m in steps if m.key == "step"), None)
    return {
        **{key: getattr(row, key) for key in ("theta", "d", "a", "alpha", "sign")},
        "slides": row.joint_type is JointType.PRISMATIC,
        "variable": variable,
        "constant": constant,
        "motions": [[m.key, m.words, m.factor] for m in steps],
        "after": after,
    }


def _nodes(arm: DrawnArm) -> list[dict[str, Any]]:
    """The bodies of each link: in the frame of the base, then of DH frame i; then bars."""
    T_dh_link = inverse(np.stack(link_frames(arm.table).dh))
    places: list[dict[str, Any]] = [
        {"fixed": T.ravel().tolist() if i else None} for i, T in enumerate(T_dh_link)
    ]
    for bar in arm.bars:
        numbers = {"point": bar.point.tolist(), "shift": bar.shift.tolist()}
        places.append({"bar": {"turn": bar.turn, "at": bar.at, "keep": bar.keep, **numbers}})
    nodes = TableDrawing(arm).nodes
    return [
        {**place, "surfaces": _surfaces(node)} for place, node in zip(places, nodes, strict=True)
    ]


def _surfaces(node: Node) -> list[dict[str, Any]]:
    return [
        {
            "colour": surface.colour,
            "vertices": _packed(surface.vertices, np.float32),
            "faces": _packed(surface.faces, np.uint32),
        }
        for surface in node.surfaces
    ]


def _packed(values: Any, kind: Any) -> str:
    """Little-endian numbers as base64."""
    numbers = np.ascontiguousarray(values, np.dtype(kind).newbyteorder("<"))
    return base64.b64encode(numbers.tobytes()).decode()
