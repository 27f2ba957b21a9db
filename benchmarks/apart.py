"""Each piece of work in a process of its own: who breaks it is named and left out.

A peer may crash, hang or raise. Its process ends, :mod:`benchmarks.marker` says who was at work,
and the work is done again without that peer. Only what breaks in our own hands is a failure.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks import marker
from benchmarks.peers.ours import OURS
from benchmarks.results import Results

__all__ = ["ROOT", "do_apart", "do_here"]

ROOT = Path(__file__).parent.parent
PATIENCE = 900.0
"""Seconds after which a process is taken for stuck; a peer on a busy machine takes minutes."""


def do_apart(
    results: Results, module: str, keys: tuple[str, ...], patience: float = PATIENCE
) -> str:
    """Do a module's work in a process and add its rows; what failed in our own hands, or nothing.

    The module has ``run(results, keys)``, like those of :mod:`benchmarks.work`.
    """
    while True:
        with TemporaryDirectory() as folder:
            wrong = _attempt(results, module, keys, Path(folder), patience)
            name = marker.read(Path(folder, "marker"))
        if not wrong:
            return ""
        if name in ("", OURS) or name in results.excluded:
            return wrong
        results.excluded.add(name)
        results.left_out[f"{name}, {module.rpartition('.')[2]} {' '.join(keys)}"] = (
            wrong.strip().splitlines()[-1]
        )


def _attempt(
    results: Results, module: str, keys: tuple[str, ...], folder: Path, patience: float
) -> str:
    """One process; what went wrong with it."""
    task = {"quick": results.quick, "excluded": sorted(results.excluded), "keys": keys}
    Path(folder, "task.json").write_text(json.dumps(task))
    try:
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.child", "work", module, str(folder)],
            cwd=ROOT,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            check=False,
            timeout=patience,
        )
    except subprocess.TimeoutExpired:
        return f"no end after {patience:.0f} s"
    if done.returncode < 0:
        return f"ended by {signal.Signals(-done.returncode).name}"
    if done.returncode:
        return done.stderr or f"ended with {done.returncode}"
    results.include(Results.load(Path(folder, "rows.json")))
    return ""


def do_here(module: str, folder: Path) -> None:
    """Do a module's work in this process and write its rows; called by ``benchmarks.child``."""
    marker.write_to(folder / "marker")
    task = json.loads(Path(folder, "task.json").read_text())
    results = Results(task["quick"], excluded=set(task["excluded"]))
    import_module(module).run(results, tuple(task["keys"]))
    results.save(folder / "rows.json")
