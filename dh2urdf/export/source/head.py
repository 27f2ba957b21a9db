"""What stands at the head of an exported file: what it is, of which arm, by whom, on what terms."""

import hashlib
import textwrap
from pathlib import Path

import numpy as np

from dh2urdf import __version__, engine
from dh2urdf.export.source.program import Program
from dh2urdf.ik.arm import TRIALS, HeldSolver, Outputs, branch_words_of
from dh2urdf.robot import Robot

LICENCE = """\
SPDX-License-Identifier: BSD-3-Clause
Copyright (c) 2026, the dh2urdf developers

Redistribution and use in source and binary forms, with or without
modification, are permitted provided that the following conditions are met:

1. Redistributions of source code must retain the above copyright notice, this
   list of conditions and the following disclaimer.

2. Redistributions in binary form must reproduce the above copyright notice,
   this list of conditions and the following disclaimer in the documentation
   and/or other materials provided with the distribution.

3. Neither the name of the copyright holder nor the names of its
   contributors may be used to endorse or promote products derived from
   this software without specific prior written permission.

THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS"
AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE
IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE
DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDER OR CONTRIBUTORS BE LIABLE
FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL
DAMAGES (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR
SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER
CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY,
OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE
OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
"""

MARK = "Written by dh2urdf"
"""By which files of ours are known."""


def provenance(robot: Robot, program: Program) -> list[str]:
    """Where the file comes from, in lines."""
    numbers = hashlib.sha256(b"".join(a.tobytes() for a in robot.chain.tables)).hexdigest()
    if robot.table is not None:
        kind = robot.table.convention.value
        made = f"the {kind} DH table {one_line(robot.table.name) or 'without a name'}"
    else:
        made = f"the robot description {robot.source.name if robot.source else 'it was given'}"
    lines = [f"{MARK} {__version__} from {made}, {one_line(robot.base)} to {one_line(robot.tip)}."]
    if robot.table is not None and robot.table.source:
        text = f"Source of the table: {one_line(robot.table.source, 600)}"
        lines += textwrap.wrap(text, 96, subsequent_indent="  ")
    lines += [
        f"SHA-256 of the arm's links and joints: {numbers}",
        f"SHA-256 of the solver's sources:       {engine.fingerprint()}",
        f"Solver: {program.solver.name}",
    ]
    return lines


SEARCHED = """\
complete is {true} of every pose:
where solutions meet or nearly do, others are searched for from many starts, which takes some
hundred times as long as at other poses."""

LEFT = """\
complete is {false}
where there may be more solutions, because the pose is next to one at which solutions meet{held};
Robot.ik of dh2urdf searches there."""

LINED_UP = """,
or has several singularities, or the held joint lines up two others"""


def complete(program: Program, true: str, false: str) -> str:
    """What is said of all solutions being found, with a language's words for it."""
    held = LINED_UP if program.held else ""
    return (SEARCHED if program.searches else LEFT).format(true=true, false=false, held=held)


def joints(robot: Robot) -> list[str]:
    """Names, kinds and limits of the joints, a line for each."""
    rows = []
    for i, name in enumerate(robot.joint_names):
        kind, unit = ("slides", "m") if robot.slides[i] else ("turns", "rad")
        ends = _limits(robot.lower[i], robot.upper[i], unit)
        rows.append(f"q[{i}]  {one_line(name)}, {kind}, {ends}")
    return rows


def _limits(low: float, high: float, unit: str) -> str:
    """From where to where a joint moves."""
    if low == -np.inf and high == np.inf:
        return "without limits"
    if low == -np.inf:
        return f"up to {high:.6g} {unit}"
    return f"from {low:.6g} {unit} on" if high == np.inf else f"{low:.6g} to {high:.6g} {unit}"


def branches(robot: Robot, program: Program) -> str:
    """What the bits of a branch say, a line for each, between commas.

    Nothing, where the solver names no branch of a solution of some poses.
    """
    low, high = robot.bounded(1.0, np.pi)
    q = np.random.default_rng(0).uniform(low, high, (TRIALS, robot.n))
    out = Outputs.of(TRIALS, program.solver.kmax, robot.n)
    if isinstance(program.solver, HeldSolver):
        values = np.ascontiguousarray(q[:, list(program.held)])
        program.solver.solve_held(robot.fk(q), values, False, out)
    else:
        program.solver.solve_batch(robot.fk(q), False, out)
    listed = np.arange(program.solver.kmax) < out.counts[:, None]
    named = bool((out.branch[listed] >= 0).any())
    words = branch_words_of(program.solver) if named else ()
    bits = [f"    bit {i}: 0 {w[0]}, 1 {w[1]}" for i, w in enumerate(words) if w]
    return "\n".join([", or -1,", "", *bits, ""]) if bits else ", -1 as they have none;"


def one_line(text: str, most: int = 200) -> str:
    """A text of a file as a comment may have it, so many signs of it."""
    plain = "".join(c if c.isascii() and c.isprintable() else "_" for c in " ".join(text.split()))
    return plain.replace("*/", "* /").replace("/*", "/ *").replace("\\", "/")[:most]


def file_name(path: Path) -> str:
    """The last part of a path, as a comment may have it."""
    return one_line(path.name)
