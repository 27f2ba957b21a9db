"""``python -m benchmarks.exported``: what a pose takes in the C files that `export` writes.

Each arm's file is compiled (-O2 without options for the processor) and solves random poses within
the limits one after the other in a loop in C. So does what robotics-toolbox-python writes as C,
with the same options, and the core of EAIK, if ``--eaik`` tells where its source distribution is.
The extension modules of EAIK (C++) and ik-geo (Rust) have no other way in than Python: EAIK's
batch call on one thread, and ik-geo's call of one pose, of which the way through Python is a part.
Medians of interleaved rounds, microseconds a pose; beside them how long writing the file took, and
its size.
"""

import argparse
import ctypes
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import ARMS, Arm
from benchmarks.clock import Block, interleaved
from benchmarks.compare import table
from benchmarks.contestant import BatchContestant
from benchmarks.peers import contestants
from benchmarks.peers.eaik_core import eaik_core, loop_of
from benchmarks.results import Results
from dh2urdf import Robot
from dh2urdf.export.source import exported

NAMES = ("puma560", "stanford", "ur5", "planar_rr", "omron_cobra600", "rpr_new_frame", "xarm6")
NAMES += ("franka_fer:6", "kuka_iiwa7:2")

PEERS = {
    "EAIK": "batch call of Python",
    "ik-geo": "calls of Python",
    "roboticstoolbox C": "the same loop in C",
}
"""Those whose cores are compiled code, and how these are called."""

POSES = 2000

FLAGS = ("-std=c99", "-O2", "-shared", "-fPIC")

LOOP = """
#include "arm.h"
int many(int poses, const double *T, const double *held, arm_solutions *found)
{{
    int count = 0;
    {prepare}
    (void)held;
    for (int i = 0; i < poses; i++) {{
        count += arm_ik(T + 16 * i, {held}true, {work}found);
    }}
    return count;
}}
"""


def compiled(
    robot: Robot, held: int | None, folder: str, *flags: str
) -> tuple[Callable[..., int], float, int]:
    """The loop over poses of an arm's file; the seconds that writing it took, and its lines."""
    start = time.perf_counter()
    text = exported(robot, language="c", prefix="arm", held=held).text
    seconds, place = time.perf_counter() - start, Path(folder)
    needs = "arm_prepare(" in text
    loop = LOOP.format(
        prepare="static arm_workspace work;\n    arm_prepare(&work);" if needs else "",
        work="&work, " if needs else "",
        held="" if held is None else "held[i], ",
    )
    (place / "arm.h").write_text(text)
    (place / "many.c").write_text(loop)
    command = ["gcc", *FLAGS, *flags, "many.c", "-o", "many.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    function: Callable[..., int] = ctypes.CDLL(str(place / "many.so")).many
    return function, seconds, len(text.splitlines())


def looped(many: Callable[..., int], Ts: NDArray[np.float64], values: NDArray[np.float64]) -> Block:
    """The loop over poses as something to time."""
    room = ctypes.create_string_buffer(1 << 20)
    poses, held = Ts.ctypes.data_as(ctypes.c_void_p), values.ctypes.data_as(ctypes.c_void_p)

    def block() -> int:
        many(len(Ts), poses, held, room)
        return len(Ts)

    block.kept = Ts, values  # type: ignore[attr-defined]
    return block


def peers(arm: Arm, Ts: NDArray[np.float64]) -> dict[str, Block]:
    """Calls of the peers that are installed and cover an arm, through the thinnest way in."""
    with suppress(ImportError):
        from benchmarks.peers.toolbox_analytic import ToolboxC

        ToolboxC.flags = FLAGS[1:]
    found: dict[str, Block] = {}
    for name, way in PEERS.items():
        for solver in contestants(arm, Results(), only=name):
            if isinstance(solver, BatchContestant):
                call = partial(solver.solve_batch, solver.encode_batch(Ts), 1)
            else:
                call = partial(_one_by_one, solver.solve, solver.encode(Ts))
            found[f"{name} ({way})"] = partial(_called, call, len(Ts))
    return found


def _one_by_one(solve: Callable[[Any], Any], poses: Sequence[Any]) -> None:
    for pose in poses:
        solve(pose)


def _called(call: Callable[[], object], units: int) -> int:
    call()
    return units


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.exported", description=__doc__)
    parser.add_argument("arms", nargs="*", default=NAMES)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--eaik", type=Path, help="folder of its unpacked source distribution")
    parser.add_argument("--eigen", type=Path, default=Path("/usr/include/eigen3"))
    given, known = parser.parse_args(), {arm.key: arm for arm in ARMS}
    blocks: dict[str, Block] = {}
    with tempfile.TemporaryDirectory() as folder:
        core = None
        if given.eaik:
            core = eaik_core(given.eaik, given.eigen, given.eaik / "core.so")
        for name in given.arms:
            key, _, joint = name.partition(":")
            robot, rng = Robot.from_dh(key), np.random.default_rng(0)
            low, high = robot.bounded(1.0, np.pi)
            q = rng.uniform(np.maximum(low, -np.pi), np.minimum(high, np.pi), (POSES, robot.n))
            Ts, held = robot.fk(q), int(joint) if joint else None
            values = np.ascontiguousarray(q[:, held or 0])
            for kind, flags in {"C": (), "C, this processor": ("-O3", "-march=native")}.items():
                place = Path(folder, f"{key} {kind}")
                place.mkdir()
                many, seconds, lines = compiled(robot, held, str(place), *flags)
                blocks[f"{name}: {kind}"] = looped(many, Ts, values)
            print(f"{name}: written in {seconds:.2f} s, {lines} lines", flush=True)
            if key in known:
                blocks |= {f"{name}: {peer}": b for peer, b in peers(known[key], Ts).items()}
                if core and held is None:
                    many = loop_of(core, known[key], Ts)
                    blocks[f"{name}: EAIK's core, a loop in C++"] = partial(_called, many, POSES)
        found = interleaved(blocks, given.seconds, most=200)
    rows = [[name, f"{1e6 * timing.median:.2f}"] for name, timing in found.items()]
    print(table(["solver", "us a pose"], rows))


if __name__ == "__main__":
    main()
