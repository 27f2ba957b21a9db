"""The solver of an arm as source code, to be taken where Python is not.

`program` is what has to be done for a pose, taken from the solver's own steps; `c_kernels` writes
the kernels for one arm, by the translator that builds the package; `c_file` the functions around
them and `head` what stands above; `stack` counts what they need of it. `python_file` takes the
kernels as they are written, with `arrays.py.in` for what of NumPy they use.
"""

from __future__ import annotations

import keyword
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dh2urdf.dh_io.atomic import atomic_write, refuse_foreign, refuse_unwritable
from dh2urdf.dh_io.files import path_of, shown
from dh2urdf.doors import choice, flag, found, instance, integer
from dh2urdf.exceptions import ArgumentError, NameNotFoundError, NoSolverError

if TYPE_CHECKING:
    from dh2urdf.ik.arm import HeldSolver, Solver
    from dh2urdf.robot import Robot

LANGUAGES = ("c", "c++", "python")

SUFFIXES = {".h": "c", ".c": "c", ".hpp": "c++", ".hh": "c++", ".hxx": "c++", ".py": "python"}
"""Languages by the suffixes of their files."""

MARK = "Written by dh2urdf"
"""By which files of ours are known."""


@dataclass(frozen=True)
class Exported:
    """A solver that was written.

    Attributes
    ----------
    text : str
        The whole file.
    language : str
    prefix : str
        With which all names of the file begin.
    solver : str
        Name of the solver.
    solutions : int
        Most solutions that a pose can have.
    stack : int
        Bytes of the stack that are enough for any function of a C file; 0 for Python.
    """

    text: str
    language: str
    prefix: str
    solver: str
    solutions: int
    stack: int

    def __str__(self) -> str:
        length = f"{len(self.text.splitlines())} lines of {self.language.capitalize()}"
        stack = f", {self.stack} bytes of stack" if self.stack else ""
        return f"{self.solver}, up to {self.solutions} solutions, {length}{stack}"


def export_solver(
    robot: Robot,
    path: str | os.PathLike[str],
    *,
    language: str | None = None,
    prefix: str | None = None,
    held: int | str | None = None,
    force: bool = False,
) -> Exported:
    """Write the kinematics of an arm, all of its inverse kinematics included, as one source file.

    Parameters
    ----------
    robot : Robot
    path : path
        The file; ``.h`` is C, ``.hpp`` C++, ``.py`` Python. The C is C99 that is valid C++, too;
        the Python needs nothing but ``math``.
    language : {"c", "c++", "python"}, optional
        Where the suffix does not tell.
    prefix : str, optional
        With which all names of C begin; the name of the table, or the file's, without it.
    held : int or str, optional
        Index or name of a joint of which the caller gives the value with every pose; an arm of
        seven joints needs one.
    force : bool
        Replace a file that dh2urdf did not write.

    Raises
    ------
    ArgumentError, NameNotFoundError, NoSolverError, OutputError

    Examples
    --------
    >>> import os, tempfile
    >>> from dh2urdf import Robot, export_solver
    >>> path = os.path.join(tempfile.mkdtemp(), "ur5.h")
    >>> export_solver(Robot.from_dh("ur5"), path).solver
    'three parallel axes'
    """
    target = path_of(path)
    refuse_unwritable(target)
    made = exported(robot, language=language, prefix=prefix, held=held, path=target)
    if not flag(force, "force"):
        refuse_foreign(target, MARK, same=made.text.encode())
    atomic_write(target, made.text)
    return made


def exported(
    robot: Robot,
    *,
    language: str | None = None,
    prefix: str | None = None,
    held: int | str | None = None,
    path: Path | None = None,
) -> Exported:
    """The same as a text; ``path`` tells the language and the prefix where nothing else does."""
    from dh2urdf.export.source.c_file import CProgram
    from dh2urdf.export.source.program import Program
    from dh2urdf.export.source.python_file import PythonProgram
    from dh2urdf.ik.redundant import SweptJoint
    from dh2urdf.robot import Robot

    instance(robot, "robot", Robot)
    spoken = _language(language, path)
    if spoken == "python" and path is not None:
        _refuse_unimportable(path)
    name = _prefix(robot, prefix, path)
    if robot.is_coupled:
        raise NoSolverError(_not_exported(robot))
    solver: Solver | HeldSolver = robot.solver
    if held is not None:
        joint = _joint(robot, held)
        low, high = np.maximum(robot.lower, -1.0), np.minimum(robot.upper, 1.0)
        solver = robot.solver_for(locked={joint: float(np.clip(0.37, low, high)[joint])})
    elif isinstance(solver, SweptJoint):
        raise NoSolverError(
            "this arm has a joint to spare, whose value the caller has to give: hold one, such as "
            f"{robot.joint_names[solver.joint]} (held=..., --held on the command line)"
        )
    program = Program.of(robot.chain, solver)
    python = spoken == "python"
    written = PythonProgram(robot, program) if python else CProgram(robot, program, name)
    text = written.text()
    return Exported(text, spoken, name, solver.name, solver.kmax, written.stack)


def _not_exported(robot: Robot) -> str:
    """Why no solver of joints that follow others or are coupled is written, and what can be."""
    if robot.n == robot.chain.n:
        return (
            "coupled joints cannot be exported; export the table without couplings, and add them "
            "where its solver is called"
        )
    return (
        f"joints that follow others cannot be exported: {robot.n} values move {robot.chain.n} "
        "joints, and a solver of these without their followers is one of another arm; ik and "
        "ik_batch of the package solve them"
    )


def _language(language: str | None, path: Path | None) -> str:
    """The language, by its name or by a file's suffix."""
    suffix = path.suffix.lower() if path is not None else ""
    if language == "rust" or (language is None and suffix == ".rs"):
        raise ArgumentError("language: Rust is not written; a C file can be built by the crate cc")
    if language is not None:
        return choice(language, "language", LANGUAGES)
    if suffix not in SUFFIXES:
        known = ", ".join(SUFFIXES)
        raise ArgumentError(
            f"{shown(path or '')}: the suffix tells the language: {known}; or --language does"
        )
    return SUFFIXES[suffix]


def _refuse_unimportable(path: Path) -> None:
    """Refuse a Python file that no program could import, or only in the place of a module."""
    name = path.stem
    if not name.isidentifier() or keyword.iskeyword(name):
        raise ArgumentError(f"{shown(path)}: Python imports no module of the name {found(name)}")
    if name in sys.stdlib_module_names:
        raise ArgumentError(
            f"{shown(path)}: the file would stand in the place of Python's own module {name}"
        )


def _prefix(robot: Robot, prefix: str | None, path: Path | None) -> str:
    """A name of C, from what the caller says, the table or the file."""
    if prefix is None:
        named = (robot.table.name if robot.table else "") or (path.stem if path else "")
        plain = re.sub(r"\W+", "_", named, flags=re.ASCII).strip("_").lower()
        return (plain if plain[:1].isalpha() else f"arm_{plain}".rstrip("_"))[:40]
    if not isinstance(prefix, str) or not re.fullmatch(r"[A-Za-z]\w{0,39}", prefix, re.ASCII):
        raise ArgumentError(f"prefix: expected a name of C, up to 40 signs, got {found(prefix)}")
    return prefix


def _joint(robot: Robot, held: int | str) -> int:
    """Index of a joint given by index or name."""
    names = robot.joint_names
    if isinstance(held, str):
        if held not in names:
            raise NameNotFoundError(f"no joint named {held!r}; there are {', '.join(names)}")
        return names.index(held)
    return integer(held, "held", 0, len(names) - 1)
