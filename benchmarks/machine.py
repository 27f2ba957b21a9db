"""What a figure has to name: machine, versions, commit, and what others did on the machine."""

from __future__ import annotations

import os
import platform
import resource
import subprocess
import sys
import time
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

__all__ = ["Watch", "commit", "describe", "load_average", "touch_memory", "versions", "worked"]

PACKAGES = (
    "dh2urdf",
    "numpy",
    "pin",
    "eaik",
    "ssik",
    "ik-geo",
    "py-ikgeo-kinematics",
    "py-opw-kinematics",
    "spherical-wrist",
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
    return found | {"kernels": _kernels()}


def _kernels() -> str:
    """Level of processor and compiler of the kernels that run."""
    try:
        built = import_module("dh2urdf._kernels")
    except ImportError:
        return "interpreted"
    return f"{built.LEVEL} ({built.COMPILER})"


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


def touch_memory(size: int = 1 << 27) -> None:
    """Write to some memory and give it back: what a virtual machine has not got is slow at first.

    Seconds after it was given back, the host may take it again.
    """
    np.full(size // 8, 1.0)


def worked() -> float:
    """Processor time of this process, its threads and the processes that it waited for [s]."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


class Watch:
    """From when it is made: time that went by, and processor time that others had of it.

    Attributes
    ----------
    load : list of float
        Load averages at the beginning.
    """

    def __init__(self) -> None:
        self.load = load_average()
        self._start = time.perf_counter(), _machine_worked(), worked()

    def seconds(self) -> float:
        """Time since the beginning [s]."""
        return time.perf_counter() - self._start[0]

    def others(self) -> float:
        """Cores that other programs, or other guests of the host, have used on average."""
        _, machine, own = self._start
        return max(0.0, _machine_worked() - machine - (worked() - own)) / self.seconds()


def _machine_worked() -> float:
    """Processor time of everything on the machine [s]; 0 where the system does not say."""
    for line in _lines("/proc/stat")[:1]:
        user, nice, system, _, _, irq, softirq, steal = (float(v) for v in line.split()[1:9])
        return (user + nice + system + irq + softirq + steal) / os.sysconf("SC_CLK_TCK")
    return 0.0
