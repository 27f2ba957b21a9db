"""The real parsers asked for their own words, each in a process of its own."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import zip_longest
from pathlib import Path
from typing import Any

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Consumer, Verdict
from dh2urdf.exceptions import UrdfError

MODULES = {
    Consumer.PINOCCHIO: "pinocchio",
    Consumer.YOURDFPY: "yourdfpy",
    Consumer.MUJOCO: "mujoco",
    Consumer.PYBULLET: "pybullet",
    Consumer.DRAKE: "pydrake",
    Consumer.IKPY: "ikpy",
}

PATIENCE = 20.0
"""Seconds after which a consumer counts as hanging: four times the slowest over a large arm."""

ASKED = 200
"""Joints beyond which `dh2urdf check` asks no consumer: Pinocchio's time grows with their cube,
from 2 s here to more than a minute for 1,000."""

LONGEST = 8
"""Lines of a consumer's words that are kept."""

NOISE = re.compile(
    r"^\s*at line \d+ in /project/|^pybullet build time|^argv\[|^b3Warning\[.*\]:$|^\s*$"
)
"""Lines that say nothing of the file."""


@dataclass(frozen=True)
class Testimony:
    """What a consumer made of a file.

    Parameters
    ----------
    consumer : Consumer
    version : str
        Empty where it did not get so far as to tell.
    verdict : Verdict
        ``ACCEPTS``, ``COMPLAINS`` or ``REFUSES``.
    words : str
        Its own.
    """

    consumer: Consumer
    version: str
    verdict: Verdict
    words: str


def installed() -> tuple[Consumer, ...]:
    """The consumers that can be asked here."""
    found = [consumer for consumer, module in MODULES.items() if find_spec(module)]
    if _check_urdf():
        found.insert(1, Consumer.CHECK_URDF)
    return tuple(found)


def ask_all(
    path: str | os.PathLike[str],
    consumers: Iterable[Consumer] | None = None,
    answered: Callable[[], None] = lambda: None,
) -> tuple[Testimony, ...]:
    """What each consumer makes of a file; by default all that are installed.

    ``answered`` is called whenever one has.
    """

    def one(consumer: Consumer) -> Testimony:
        testimony = ask(consumer, path)
        answered()
        return testimony

    chosen = installed() if consumers is None else tuple(consumers)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return tuple(pool.map(one, chosen))


def why_not_asked(path: str | os.PathLike[str]) -> str:
    """Why it would take too long to ask about a file; empty where it would not."""
    count = len(Document.read(path).joints)
    return f"{count} joints; they are asked about up to {ASKED}" if count > ASKED else ""


def ask(consumer: Consumer, path: str | os.PathLike[str]) -> Testimony:
    """What a consumer makes of a file, asked in a process that may crash or hang."""
    file = os.path.abspath(path)
    if consumer is Consumer.CHECK_URDF:
        command = [_check_urdf() or "check_urdf", file]
    else:
        command = [sys.executable, "-m", "dh2urdf.checks.probe", str(consumer), file]
    with tempfile.TemporaryDirectory() as scratch:
        try:
            streams: Any = {"capture_output": True, "stdin": subprocess.DEVNULL}
            decoded: Any = {"text": True, "errors": "replace"}
            run = subprocess.run(
                command, timeout=PATIENCE, check=False, cwd=scratch, **streams, **decoded
            )
        except subprocess.TimeoutExpired:
            return Testimony(consumer, "", Verdict.REFUSES, f"no answer within {PATIENCE:.0f} s")
    text = run.stderr
    if consumer is Consumer.PYBULLET:
        text = f"{_pybullet_words(run.stdout, _root_of(file))}\n{text}"
    words = _words(text)
    if run.returncode:
        crash = f"crashes (signal {-run.returncode})\n" if run.returncode < 0 else ""
        return Testimony(consumer, "", Verdict.REFUSES, f"{crash}{words}".rstrip())
    last = run.stdout.rstrip().rpartition("\n")[2]
    version = "" if consumer is Consumer.CHECK_URDF else last
    return Testimony(consumer, version, Verdict.COMPLAINS if words else Verdict.ACCEPTS, words)


def _words(text: str) -> str:
    said = (line.rstrip() for line in text.splitlines() if not NOISE.match(line))
    lines = list(dict.fromkeys(said))
    if len(lines) > LONGEST:
        lines[LONGEST:] = [f"(and {len(lines) - LONGEST} lines more)"]
    return "\n".join(lines)


def _pybullet_words(out: str, root: str) -> str:
    """Its warnings and errors, without the one that every massless root link brings about."""
    marks = re.sub(r"b3(Warning|Error)\[[^\]]*\]:\n?", r"\n\1: ", out)
    marks = marks.replace("Warning: joint unsupported", "\nWarning: joint unsupported")
    words = [line for line in marks.splitlines() if line.startswith(("Warning: ", "Error: "))]
    notice = "Warning: No inertial data for link"
    said = []
    for line, following in zip_longest(words, words[1:], fillvalue=""):
        if line.startswith(notice):
            name = following.removeprefix("Warning: ")
            said += [] if name == root else [f"{notice}, using mass=1: {name}"]
        elif not (said and said[-1].endswith(line.removeprefix("Warning: "))):
            said.append(line)
    return "\n".join(line for line in said if line != f"Warning: {root}")


def _root_of(path: str) -> str:
    try:
        return next(iter(Document.read(path).roots), "")
    except UrdfError:
        return ""


def _check_urdf() -> str | None:
    """Path of urdfdom's checker, which comes with Pinocchio's wheel."""
    beside = str(Path(sys.executable).parent)
    return shutil.which("check_urdf", path=os.pathsep.join([beside, os.environ.get("PATH", "")]))
