"""Which of the kernels' two forms runs: C, compiled when the package was installed, or Python.

A kernel is plain Python; that is its definition. What Python calls of them is marked as an
`entry`: its name means the compiled function where the extension has been built from these very
sources, else the interpreted one, thousands of times slower.
"""

import os
import warnings
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

Kernel = TypeVar("Kernel", bound=Callable[..., Any])

side_by_side = range
"""A range whose turns write nothing that another turn reads or writes: they can run as lanes of
vector instructions, in any order."""

INTERPRETED: dict[str, Callable[..., Any]] = {}
"""The entries as they are written, by module and name."""

ADVICE = "pip install --force-reinstall --no-deps dh2urdf, or in a checkout pip install -e ."


def _extension() -> Any:
    """The compiled kernels, if they are wanted, there, and of these sources."""
    wanted = os.environ.get("DH2URDF_ENGINE", "")
    if wanted == "python":
        return None
    try:
        found = import_module("dh2urdf._kernels")
    except ImportError:
        if wanted == "compiled":
            raise
        warnings.warn(f"kernels are not compiled and run interpreted: {ADVICE}", stacklevel=2)
        return None
    if _edited(Path(found.__file__ or "")):
        from dh2urdf.translate.sources import fingerprint

        if fingerprint() != found.SOURCES:
            warnings.warn(f"kernels were edited and run interpreted: {ADVICE}", stacklevel=2)
            return None
    return found


def _edited(built: Path) -> bool:
    """Whether any kernel's file is newer than the extension."""
    then = built.stat().st_mtime
    room = Path(__file__).parent.parent
    return any(path.stat().st_mtime > then for path in room.rglob("*.py"))


_COMPILED = _extension()


def entry(function: Kernel) -> Kernel:
    """Mark a kernel that Python calls."""
    name = f"{function.__module__}.{function.__name__}"
    INTERPRETED[name] = function
    compiled: Kernel = getattr(_COMPILED, name, function)
    return compiled
