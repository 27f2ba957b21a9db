"""Readers of other projects, which a file may drive anywhere: each in a process of its own.

``python -m dh2urdf.conversions.apart xacro arm.xacro folder`` leaves what it read in the folder,
or a file ``error``. Time and memory are bounded; what a reader prints goes nowhere.
"""

from __future__ import annotations

import ast
import contextlib
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from dh2urdf.bounds import APART_BYTES, APART_SECONDS, ROBOT_BYTES
from dh2urdf.dh_io.files import read_bytes, shown
from dh2urdf.exceptions import MissingExtraError, UrdfError

__all__ = ["check_expression", "expand_xacro", "is_xacro", "mjcf_apart"]

FORBIDDEN = re.compile(
    "_.*|format|format_map|vars|mro|(gi|cr|ag|tb)_(frame|code)|f_(back|builtins|globals|locals)"
)
"""Attributes that lead from a value to the interpreter."""


def is_xacro(path: str | os.PathLike[str]) -> bool:
    """True by the name of a file."""
    return Path(path).suffix.lower() == ".xacro"


def expand_xacro(source: Path) -> bytes:
    """The URDF text of a xacro file; its expressions compute, and can do nothing else.

    Raises
    ------
    MissingExtraError, UrdfError
    """
    with _apart("xacro", source, "xacro", "xacro", f"reading {source.name}") as folder:
        return read_bytes(folder / "text", ROBOT_BYTES, UrdfError)


@contextmanager
def mjcf_apart(source: Path) -> Iterator[tuple[str, str]]:
    """Files with the models that MuJoCo and Pinocchio make of an MJCF.

    Raises
    ------
    MissingExtraError, UrdfError
    """
    with _apart("mjcf", source, "mujoco", "mjcf", f"reading the MJCF {source}") as folder:
        yield str(folder / "mujoco.mjb"), str(folder / "pinocchio.bin")


@contextmanager
def _apart(reader: str, source: Path, module: str, extra: str, purpose: str) -> Iterator[Path]:
    """The folder into which a reader wrote."""
    if find_spec(module) is None:
        raise MissingExtraError(extra, purpose)
    here = str(Path(__file__).parents[2])
    path = os.pathsep.join(filter(None, [here, os.environ.get("PYTHONPATH", "")]))
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", __name__, reader, os.path.abspath(source), folder]
        try:
            run = subprocess.run(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=APART_SECONDS,
                check=False,
                env={**os.environ, "PYTHONPATH": path},
                cwd=folder if reader == "mjcf" else None,  # where MuJoCo leaves its log
            )
            status = run.returncode
        except subprocess.TimeoutExpired:
            raise UrdfError(f"{shown(source)}: {module}: no end after {APART_SECONDS} s") from None
        error = Path(folder) / "error"
        if status:
            words = error.read_text(errors="replace") if error.is_file() else "does not come back"
            raise UrdfError(f"{shown(source)}: {words[:2000].strip()}")
        yield Path(folder)


def _xacro(source: str, folder: Path) -> None:
    import xacro
    from xacro import substitution_args

    def compute(expr: str, names: dict[str, Any], scope: Any = None) -> object:
        check_expression(expr)
        names["__builtins__"] = {}
        return eval(expr.strip(), names, scope)

    xacro.safe_eval = substitution_args.eval = compute
    try:
        text = xacro.process_file(source).toxml()
    except Exception as error:
        raise UrdfError(f"xacro: {' '.join(str(error).split()) or type(error).__name__}") from None
    (folder / "text").write_text(text, encoding="utf-8")


def check_expression(expr: str) -> None:
    """Refuse names by which an expression could leave arithmetic.

    Raises
    ------
    UrdfError
    """
    for node in ast.walk(ast.parse(expr.strip(), mode="eval")):
        attribute, name = getattr(node, "attr", ""), getattr(node, "id", "")
        if FORBIDDEN.fullmatch(attribute) or name.startswith("__"):
            raise UrdfError(f"{attribute or name!r} is not allowed in an expression")


def _mjcf(source: str, folder: Path) -> None:
    import mujoco
    import pinocchio as pin

    try:
        model = mujoco.MjModel.from_xml_path(source)
        mujoco.mj_saveModel(model, str(folder / "mujoco.mjb"))
    except Exception as error:
        raise UrdfError(f"MuJoCo: {str(error).strip()}") from None
    try:
        pin.buildModelFromMJCF(source).saveToBinary(str(folder / "pinocchio.bin"))
    except Exception as error:
        words = str(error).strip().rpartition("\n")[2]
        raise UrdfError(f"Pinocchio does not load it: {words}") from None


READERS: dict[str, Callable[[str, Path], None]] = {"xacro": _xacro, "mjcf": _mjcf}


def _main(reader: str, source: str, folder: str) -> int:
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (APART_BYTES, APART_BYTES))
    try:
        READERS[reader](source, Path(folder))
    except (UrdfError, MemoryError, RecursionError) as error:
        words = str(error) if isinstance(error, UrdfError) else f"needs too much: {error}"
        (Path(folder) / "error").write_text(words, encoding="utf-8", errors="replace")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(_main(*sys.argv[1:]))
