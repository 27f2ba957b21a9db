"""``python -m benchmarks.one_call``: what one call costs, and what comes before the first answer.

Of each arm, medians over interleaved rounds: ``robot.ik(T)`` within the limits, the same with a
seed, or with a joint of an arm of seven held (``franka_fer:6``), ``robot.fk(q)``,
``robot.jacobian(q)`` and ``robot.with_table`` of tables that differ by a tenth of a millimetre,
without and with a first solution, in this process; and over processes of their own, the time to
import the package, build the robot and solve the first pose, and that of ``dh2urdf ik`` as a whole.
"""

import argparse
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial

import numpy as np

from benchmarks.clock import Block, each, interleaved
from benchmarks.compare import table
from dh2urdf import DHTable, Robot

ARMS = ("puma560", "denso_vs060", "stanford", "kuka_kr6_r700", "ur5", "ur10e", "planar_rr")
ARMS += ("omron_cobra600", "fanuc_crx10ia", "franka_fer:6", "kuka_iiwa7:2")

FIRST = """
import sys, time
begin = time.perf_counter()
import numpy as np
import dh2urdf
robot = dh2urdf.Robot.from_dh(sys.argv[1])
imported = time.perf_counter() - begin
T = robot.fk(np.clip(0.3, robot.lower, robot.upper))
begin = time.perf_counter()
robot.ik(T)
print(imported + time.perf_counter() - begin)
"""


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.one_call", description=__doc__)
    parser.add_argument("arms", nargs="*", default=ARMS)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--processes", type=int, default=5)
    given = parser.parse_args()
    blocks: dict[str, Block] = {}
    for arm in given.arms:
        name, _, held = arm.partition(":")
        robot, rng = Robot.from_dh(name), np.random.default_rng(0)
        lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
        q = rng.uniform(lower, upper, (200, robot.n))
        locked = None
        if held:
            q[:, int(held)], locked = 0.3, {int(held): 0.3}
        solve = partial(robot.ik, locked=locked)
        solve(robot.fk(q[0]))  # which builds the solver
        blocks[f"{arm} ik"] = each(solve, robot.fk(q))
        blocks[f"{arm} seeded"] = each(partial(solve, seed=q[0]), robot.fk(q))
        blocks[f"{arm} fk"] = each(robot.fk, q)
        blocks[f"{arm} jacobian"] = each(robot.jacobian, q)
        tables = [_moved(robot.table, move) for move in rng.normal(0.0, 1e-4, 50)]
        blocks[f"{arm} table"] = each(robot.with_table, tables)
        blocks[f"{arm} table, ik"] = each(partial(_first_of, robot, robot.fk(q[0])), tables)
    found = interleaved(blocks, given.seconds, most=400)
    rows = []
    for arm in given.arms:
        name = arm.partition(":")[0]
        asked = "ik", "seeded", "fk", "jacobian", "table", "table, ik"
        calls = [f"{1e6 * found[f'{arm} {what}'].median:.2f}" for what in asked]
        first = [_first(name) for _ in range(given.processes)]
        whole = [_whole(name) for _ in range(given.processes)]
        rows.append([arm, *calls, *(f"{np.median(t):.2f}" for t in (first, whole))])
    head = ["arm", "ik, us", "with a seed, us", "fk, us", "jacobian, us"]
    head += ["with_table, us", "and its first ik, us"]
    head += ["first ik in Python, s", "dh2urdf ik, s"]
    print(table(head, rows))


def _moved(table: DHTable, move: float) -> DHTable:
    """The table with a longer first offset [m]."""
    first, *others = table.rows
    return replace(table, rows=(replace(first, d=first.d + move), *others))


def _first_of(robot: Robot, T: np.ndarray, table: DHTable) -> None:
    """The first solution of a robot like another one."""
    robot.with_table(table).ik(T)


def _first(name: str) -> float:
    """Seconds from the import to the first answer, in a process of its own."""
    words = [sys.executable, "-c", FIRST, name]
    return float(subprocess.run(words, capture_output=True, text=True, check=True).stdout)


def _whole(name: str) -> float:
    """Seconds of the command, from its start to its end."""
    robot = Robot.from_dh(name)
    numbers = robot.fk(np.clip(0.3, robot.lower, robot.upper)).ravel().tolist()
    words = [sys.executable, "-m", "dh2urdf", "ik", name, f"--matrix={','.join(map(str, numbers))}"]
    begin = time.perf_counter()
    subprocess.run(words, capture_output=True, check=True)
    return time.perf_counter() - begin


if __name__ == "__main__":
    main()
