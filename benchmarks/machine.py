"""What a figure has to name: machine, versions, commit, and how busy the machine was."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

__all__ = ["commit", "describe", "load_average", "versions"]

PACKAGES = (
    "dh2urdf",
    "numpy",
    "numba",
    "pin",
    "eaik",
    "ssik",
    "ik-geo",
    "py-ikgeo-kinematics",
    "py-opw-kinematics",
    "ur-analytic-ik",
    "frankik",
    "crx-kinematics",
    "ikdh",
    "roboticstoolbox-python",
    "ikpy",
)


def describe() -> dict[str, str | int]:
    """Processor, number of cores, memory, system, Python."""
    info = {
        key.strip(): value.strip()
        for key, _, value in (
            line.partition(":") for line in _lines("/proc/cpuinfo") + _lines("/proc/meminfo")
        )
    }
    return {
        "processor": info.get("model name", platform.processor()),
        "cores": os.cpu_count() or 1,
        "memory": info.get("MemTotal", "unknown"),
        "system": platform.system() + " " + platform.release(),
        "python": sys.version.split()[0],
    }


def _lines(path: str) -> list[str]:
    file = Path(path)
    return file.read_text().splitlines() if file.exists() else []


def versions() -> dict[str, str]:
    """Versions of what takes part; a package that is not there is left out."""
    found = {}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def commit() -> str:
    """Commit of the working tree, with ``+`` where ``dh2urdf`` or ``benchmarks`` differ from it."""
    here = Path(__file__).parent.parent
    try:
        head = subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"],
            cwd=here,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
        changed = subprocess.run(
            ["git", "status", "--porcelain", "--", "dh2urdf", "benchmarks/*.py"],
            cwd=here,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return head + ("+" if changed else "")


def load_average() -> list[float]:
    """Load of the machine over 1, 5 and 15 minutes."""
    return [round(v, 2) for v in os.getloadavg()]
