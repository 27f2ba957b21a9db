"""Which of the kernels' two forms runs: C, compiled when the package was installed, or Python.

A kernel is plain Python; that is its definition. What Python calls of them is marked as an
`entry`: its name means the compiled function where the extension has been built from these very
sources, else the interpreted one, hundreds of times slower.

The variable ``DH2URDF_ENGINE`` decides otherwise: ``python`` interprets, ``compiled`` takes nothing
but the extension. In that, ``DH2URDF_LEVEL`` names the code for a level of processors, ``any``,
``v3`` or ``v4`` of x86-64, instead of the best one; all give the same bits.
"""

import os
import warnings
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

Kernel = Callable[..., Any]
AtOnce = Callable[..., bytes | None]

Step = tuple[Kernel, tuple[Any, ...], bool]
"""An entry, its arguments, and what it has to answer: nothing and zero are false."""

side_by_side = range
"""A range whose turns write nothing that another turn reads or writes: they can run as lanes of
vector instructions, in any order."""

INTERPRETED: dict[str, Callable[..., Any]] = {}
"""The entries as they are written, by module and name."""

LENGTHS: dict[str, dict[str, int]] = {}
"""Lengths of their arrays that are known before they run."""

PACKAGE = Path(__file__).parent

ADVICE = "python -m dh2urdf.translate.build compiles them, as does an installation"


def _extension() -> Any:
    """The compiled kernels, if they are wanted, there, and of these sources."""
    wanted = os.environ.get("DH2URDF_ENGINE") or "either"
    if wanted not in ("either", "compiled", "python"):
        raise ValueError(f"DH2URDF_ENGINE: expected compiled or python, got {wanted!r}")
    if wanted == "python":
        return None
    try:
        found = import_module("dh2urdf._kernels")
        fault = "were edited after they were compiled" if _edited(found) else ""
    except ImportError as error:
        found, fault = None, f"are not compiled ({error})"
    if fault and wanted == "compiled":
        raise ImportError(f"DH2URDF_ENGINE=compiled: the kernels {fault}; {ADVICE}")
    if fault:
        text = f"the kernels {fault} and run interpreted, hundreds of times slower; {ADVICE}"
        warnings.warn_explicit(text, UserWarning, "dh2urdf", 1)  # in one line, without code
        return None
    return found


def _edited(built: Any) -> bool:
    """Whether the extension is of other sources; they are read only if one is newer."""
    then = Path(built.__file__).stat().st_mtime
    newer = any(path.stat().st_mtime > then for path in sources())
    return newer and fingerprint() != built.SOURCES


def sources() -> list[Path]:
    """Files that decide what the extension is: the kernels and their translator."""
    patterns = ("engine.py", "kernels/**/*.py", "translate/*.py", "translate/*.[ch]")
    return sorted(path for pattern in patterns for path in PACKAGE.glob(pattern))


def fingerprint() -> str:
    """Of the sources, as they are on disk."""
    import hashlib

    seen = hashlib.sha256()
    for path in sources():
        seen.update(path.relative_to(PACKAGE).as_posix().encode() + b"\0" + path.read_bytes())
    return seen.hexdigest()


_COMPILED = _extension()


def entry(**lengths: int) -> Callable[[Kernel], Kernel]:
    """Mark a kernel that Python calls; ``lengths`` are those that are the same for all arms."""

    def mark(function: Kernel) -> Kernel:
        name = f"{function.__module__}.{function.__name__}"
        INTERPRETED[name], LENGTHS[name] = function, lengths
        compiled: Kernel = getattr(_COMPILED, name.replace(".", "__"), function)
        return compiled

    return mark


def at_once(memory: Any, *steps: Step, more: tuple[Any, ...] = ()) -> AtOnce:
    """The function of a pose (4, 4) that calls entries one after the other.

    It copies the pose to the beginning of ``memory``, of which all arrays that change are a part,
    and answers a copy of the memory. For each array of ``more``, (k,), it takes k numbers after the
    pose and copies them there. It answers None where a step does not answer what it has to, where
    the pose or the numbers are no usual arrays, and if a kernel is interpreted.
    """
    if any(getattr(_COMPILED, step[0].__name__, None) is not step[0] for step in steps):
        return nothing_at_once
    named = tuple((kernel.__name__, *rest) for kernel, *rest in steps)
    function: AtOnce = _COMPILED.at_once(memory, more, named)
    return function


def nothing_at_once(*given: Any) -> None:
    """What calls nothing."""
