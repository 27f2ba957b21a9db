"""Whole processes: imports, first calls, the command line.

Their bytecode is cached, as installing a package leaves it, whatever the environment says.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.apart import ROOT
from benchmarks.arms import arm_named
from benchmarks.clock import Block, Timing, interleaved
from benchmarks.results import Results, Row
from dh2urdf import save_table, urdf_text

__all__ = ["KEYS", "QUICK", "child", "run"]

IMPORTS = {
    "dh2urdf": "dh2urdf",
    "EAIK": "eaik.IK_Homogeneous",
    "ssik prebuilt": "ssik.prebuilt.universal_robots.ur5_ik",
    "py-ikgeo": "py_ikgeo_kinematics",
    "Pinocchio": "pinocchio",
    "roboticstoolbox": "roboticstoolbox",
    "ikpy": "ikpy.chain",
}
FIRST = ("puma560", "ur5", "fanuc_crx10ia", "franka_fer")
"""Arms of the first calls, one a class."""


def child(*arguments: str, **env: str) -> dict[str, Any]:
    """Run ``benchmarks.child``, with more in its environment, and read its answer."""
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks.child", *arguments],
        cwd=ROOT,
        env={**os.environ, **env},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(f"benchmarks.child {' '.join(arguments)}:\n{done.stderr}")
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def run(results: Results, keys: tuple[str, ...]) -> None:
    """Imports, first calls, the command line, of which the keys name some."""
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    with TemporaryDirectory() as cache:
        os.environ["PYTHONPYCACHEPREFIX"] = cache
        for key in keys:
            TASKS[key](results)


def _imports(results: Results) -> None:
    """Seconds beyond NumPy, medians of interleaved processes."""
    found: dict[str, list[dict[str, Any]]] = {}
    modules = {"dh2urdf": "dh2urdf"} if results.quick else IMPORTS
    for _ in range(1 if results.quick else 7):
        for name, module in modules.items():
            try:
                found.setdefault(name, []).append(child("imports", module))
            except RuntimeError as error:
                results.left_out[f"import {name}"] = str(error).strip().splitlines()[-1]
    for name, answers in found.items():
        if answers:
            extra = {"loaded": answers[0]["loaded"]}
            results.add(Row.timed("import", "", name, _timing(answers), extra=extra))


def _timing(answers: list[dict[str, Any]]) -> Timing:
    """Summary of what children found."""
    return Timing.of([a["total"] for a in answers], 1, [a["processor"] for a in answers])


def _first_calls(results: Results) -> None:
    """From nothing to a robot and its first solutions, medians of processes."""
    for key in FIRST:
        found = [child("first", key) for _ in range(1 if results.quick else 7)]
        parts = {k: float(np.median([f[k] for f in found])) for k in ("robot", "ik")}
        results.add(Row.timed("first call", key, "dh2urdf", _timing(found), extra=parts))


def _command_line(results: Results) -> None:
    """``convert`` and ``extract`` as a shell starts them, beside a bare interpreter."""
    with TemporaryDirectory() as folder:
        _verbs(results, Path(folder))


def _verbs(results: Results, folder: Path) -> None:
    table, urdf = folder / "arm.yaml", folder / "given.urdf"
    save_table(arm_named("ur5").table, table)
    urdf.write_text(urdf_text(arm_named("ur5").table))
    verbs: Mapping[str, list[str]] = {
        "convert": ["-m", "dh2urdf", "convert", str(table), "-o", str(folder / "arm.urdf")],
        "extract": ["-m", "dh2urdf", "extract", str(urdf), "--tip", "tool0"],
        "fk": ["-m", "dh2urdf", "fk", "ur5", "0", "-90", "90", "0", "0", "0", "--deg"],
        "Python itself": ["-c", "pass"],
        "Python, NumPy, Pinocchio": ["-c", "import numpy, pinocchio"],
    }
    blocks: dict[str, Block] = {}
    for name, arguments in verbs.items():
        blocks[name] = _process(arguments)
    timings = interleaved(blocks, 0.0, least=1 if results.quick else 9)
    for name, timing in timings.items():
        results.add(Row.timed("process", "ur5", name, timing))


def _process(arguments: list[str]) -> Callable[[], int]:
    def block() -> int:
        subprocess.run(
            [sys.executable, *arguments], cwd=ROOT, check=True, capture_output=True, text=True
        )
        return 1

    return block


TASKS: dict[str, Callable[[Results], None]] = {
    "imports": _imports,
    "first calls": _first_calls,
    "command line": _command_line,
}
KEYS = QUICK = tuple(TASKS)
