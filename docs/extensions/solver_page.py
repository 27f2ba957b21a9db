"""The page that solves a typed table in the browser: ``docs/solver`` with the kernels in it."""

import base64
import json
import sys
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from sphinx.application import Sphinx
from sphinx.util import logging

import dh2urdf
from dh2urdf.dh import DHTable, JointType
from dh2urdf.ik.arm import LIMIT_SLACK, Task
from dh2urdf.ik.families import general_6r
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.general_6r import ARM_6R, MOST
from docs.extensions import wasm

HERE = Path(__file__).parent.parent / "solver"
VIEW = Path(str(sys.modules["dh2urdf"].__file__)).parent / "page"

SCRIPTS = [VIEW / name for name in ("kinematics.js", "projection.js", "numbers.js")]
SCRIPTS += [
    HERE / f"{name}.js"
    for name in ("cells", "chain", "kernels", "general", "families", "scene", "panel")
]

KERNELS = ["solve_wrist_arm", "solve_three_parallel", "solve_general_6r", "solve_planar"]
KERNELS += ["finish_batch", "turn_back", "families_inside"]

SOLVED = ("spherical wrist", "three parallel axes", "two parallel axes", "general 6R", "planar arm")
"""The package's solvers whose arms the page has to begin with."""

BENT = (0.4, -1.1, 1.2, 0.3, 0.8, 0.2)
"""A configuration at which hardly any arm is singular [rad, m]."""

PAGE = "solver.html"


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension."""
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _write(app: Sphinx, exception: Exception | None) -> None:
    if exception is not None or app.builder.format != "html":
        return
    if wasm.compiler() is None:
        logging.getLogger(__name__).warning("%s is not made: install clang and lld", PAGE)
        return
    Path(app.outdir, PAGE).write_text(page_text(), encoding="utf-8")


@cache
def page_text() -> str:
    """The page, all in one."""
    data = json.dumps(_data(), ensure_ascii=False, separators=(",", ":"))
    style = [VIEW / "page.css", HERE / "page.css"]
    parts = {
        "VERSION": escape(dh2urdf.__version__),
        "STYLE": "\n".join(path.read_text(encoding="utf-8") for path in style),
        "DATA": data.replace("<", "\\u003c"),
        "SCRIPT": "\n".join(path.read_text(encoding="utf-8") for path in SCRIPTS),
    }
    pieces = (HERE / "page.html").read_text(encoding="utf-8").split("@@")
    return "".join(parts[p] if k % 2 else p for k, p in enumerate(pieces))


def _data() -> dict[str, Any]:
    """What the scripts take from the package: kernels, the solver's numbers, arms to begin with."""
    code, entries = wasm.wasm(KERNELS)
    fields = {
        name: {
            "offset": offset,
            "size": int(np.prod(dtype.shape, dtype=int)),
            "whole": dtype.base.kind == "i",
        }
        for name, (dtype, offset) in (ARM_6R.fields or {}).items()
    }
    general = {
        "fields": fields,
        "size": ARM_6R.itemsize,
        "turn": general_6r.TURN.tolist(),
        "poses": general_6r.POSES,
        "dearest": general_6r.DEAREST,
        "worth": general_6r.WORTH,
        "usable": general_6r.USABLE,
        "most": MOST,
    }
    presets = [preset(name) for name in dh2urdf.list_tables() if _is_solved(name)]
    kernels = {"code": base64.b64encode(code).decode(), "entries": entries}
    numbers = {"deep": DEEP, "slack": LIMIT_SLACK, "tasks": {t.value: t.number for t in Task}}
    return {"kernels": kernels, **numbers, "general": general, "presets": presets}


def _is_solved(name: str) -> bool:
    robot = dh2urdf.Robot.from_dh(name)
    return not robot.is_coupled and robot.solver.name in SOLVED


def preset(table: DHTable | str) -> dict[str, Any]:
    """A table without fixed rows as the page has it: metres, radians, matrices by rows."""
    table = dh2urdf.load_table(table) if isinstance(table, str) else table
    rows = table.joints
    start = [
        q if low is None or high is None else min(max(q, low), high)
        for q, low, high in zip(
            BENT, (r.lower for r in rows), (r.upper for r in rows), strict=False
        )
    ]
    return {
        "name": table.name,
        "standard": table.convention == "standard",
        "rows": [
            {
                **{key: getattr(row, key) for key in ("theta", "d", "a", "alpha", "sign")},
                "slides": row.joint_type is JointType.PRISMATIC,
            }
            for row in rows
        ],
        "lower": [row.lower for row in rows],
        "upper": [row.upper for row in rows],
        "base": table.base_frame.ravel().tolist(),
        "tool": table.tool.matrix.ravel().tolist(),
        "start": start,
    }
