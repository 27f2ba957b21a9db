"""Readers of other projects, which a file may drive anywhere: each in a process of its own.

``python -m dh2urdf.conversions.read.apart xacro arm.xacro folder`` leaves what it read in the
folder, or a file ``error``; ``given`` in it tells what a xacro is given. Time and memory are
bounded; what a reader prints goes nowhere.
"""

import ast
import contextlib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from dh2urdf.bounds import APART_BYTES, APART_SECONDS
from dh2urdf.conversions.read.xacro_file import NOTHING, Xacro, expand
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import MissingExtraError, UrdfError

FORBIDDEN = re.compile(
    "_.*|format|format_map|vars|mro|(gi|cr|ag|tb)_(frame|code)|f_(back|builtins|globals|locals)"
)
"""Attributes that lead from a value to the interpreter."""


NEEDS = {"xacro": ("xacro", "xacro"), "mjcf": ("mujoco", "mjcf")}
"""Module and extra of each reader."""


@contextmanager
def read_apart(reader: str, source: Path, given: Xacro = NOTHING) -> Iterator[Path]:
    """The folder in which a reader leaves what it read: ``text``, or ``mjb`` and ``pin``."""
    module, extra = NEEDS[reader]
    if find_spec(module) is None:
        raise MissingExtraError(extra, f"reading {source.name}")
    path = [str(Path(__file__).parents[3]), os.environ.get("PYTHONPATH", "")]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "given").write_text(json.dumps(given), encoding="utf-8")
        try:
            run = subprocess.run(
                [sys.executable, "-m", __name__, reader, os.path.abspath(source), folder],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                timeout=APART_SECONDS,
                check=False,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, path))},
                cwd=folder if reader == "mjcf" else None,  # where MuJoCo leaves its log
            )
        except subprocess.TimeoutExpired:
            raise UrdfError(f"{shown(source)}: {reader}: no end after {APART_SECONDS} s") from None
        if run.returncode:
            error = Path(folder) / "error"
            words = error.read_text() if error.is_file() else f"{reader}: does not come back"
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
    given = Xacro(*json.loads((folder / "given").read_text(encoding="utf-8")))
    (folder / "text").write_text(expand(source, given), encoding="utf-8")


def check_expression(expr: str) -> None:
    """Refuse names by which an expression could leave arithmetic."""
    for node in ast.walk(ast.parse(expr.strip(), mode="eval")):
        attribute, name = getattr(node, "attr", ""), getattr(node, "id", "")
        if FORBIDDEN.fullmatch(attribute) or name.startswith("__"):
            raise UrdfError(f"{attribute or name!r} is not allowed in an expression")


def _mjcf(source: str, folder: Path) -> None:
    import mujoco
    import pinocchio as pin

    mujoco.mj_saveModel(mujoco.MjModel.from_xml_path(source), str(folder / "mjb"))
    pin.buildModelFromMJCF(source).saveToBinary(str(folder / "pin"))


def _main(reader: str, source: str, folder: str) -> int:
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (APART_BYTES, APART_BYTES))
    try:
        {"xacro": _xacro, "mjcf": _mjcf}[reader](source, Path(folder))
    except Exception as error:
        words = " ".join(str(error).rpartition("message:")[2].split()) or type(error).__name__
        words = re.sub(r"<class '[\w.]+'>: (.+) \1", r"\1", words)  # xacro says some twice
        cause = error
        while isinstance(inner := getattr(cause, "exc", None), Exception):  # xacro wraps them
            cause = inner
        if isinstance(cause, MemoryError):
            words = f"asks for more than {APART_BYTES // 10**6} MB of memory {words}"
        told = f"{reader}: {words}".encode(errors="replace")
        (Path(folder) / "error").write_bytes(told)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(_main(*sys.argv[1:]))
