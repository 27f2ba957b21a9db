"""``python -m benchmarks.families``: two parallel axes against the general solver, in turns.

Both solve the same random poses on one thread, candidates in doubt included; microseconds a pose,
medians over the rounds, and how many times as long the general solver takes.
"""

from __future__ import annotations

import argparse

import numpy as np

from benchmarks.clock import interleaved
from benchmarks.compare import table
from dh2urdf import Robot
from dh2urdf.ik.arm import Outputs, SolverBase
from dh2urdf.ik.families.general_6r import General6R
from dh2urdf.ik.families.two_parallel import TwoParallel

ARMS = ("fanuc_crx10ia", "xarm6", "abb_gofa5", "kinova_jaco2")


def row(name: str, poses: int, budget: float) -> list[str]:
    """One arm: times of both a pose, within a budget [s], and their ratio."""
    robot = Robot.from_dh(name)
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (poses, 6))
    Ts, out = np.ascontiguousarray(robot.fk(q)), Outputs.of(poses, 16, 6)

    def solving(solver: SolverBase) -> int:
        solver.solve_batch(Ts, False, out)
        return poses

    family, general = TwoParallel(robot.chain), General6R(robot.chain)
    times = interleaved(
        {"family": lambda: solving(family), "general": lambda: solving(general)}, budget
    )
    ours, theirs = times["family"].processor, times["general"].processor
    return [name, f"{1e6 * ours:.2f} us", f"{1e6 * theirs:.2f} us", f"{theirs / ours:.2f}"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=1000, help="of a batch")
    parser.add_argument("--seconds", type=float, default=4.0, help="an arm")
    given = parser.parse_args()
    rows = [row(name, given.poses, given.seconds) for name in ARMS]
    print(table(["arm", "two parallel axes", "general 6R", "ratio"], rows))


if __name__ == "__main__":
    main()
