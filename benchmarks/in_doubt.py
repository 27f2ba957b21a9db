"""``python -m benchmarks.in_doubt``: what poses cost at which equations say little.

There solutions meet or move along families, and many starts are followed. Of each kind the time of
``robot.ik(T, within_limits=False)`` or of a batch with a held joint, a pose, over poses in doubt of
that kind: the median, the mean and the longest of them, and how many solutions there are.
"""

import argparse
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from benchmarks.compare import table
from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.transforms import Array

Solve = Callable[[Robot, Array, Array], int]
"""Solve the pose of a configuration; how many solutions there are."""

FOUR_PARALLEL = ((0.4, 0, 0), (0.3, 0, 0), (0.1, 90, 0), (0, -90, 0.1), (0, 90, 0.1), (0, 0, 0.1))
"""Rows (a, alpha [deg], d) of an arm whose axes 1, 2, 3 are parallel, and 5 where joint 4 is 0."""


def plain(robot: Robot, T: Array, q: Array) -> int:
    """All solutions."""
    return len(robot.ik(T, within_limits=False))


def seeded(robot: Robot, T: Array, q: Array) -> int:
    """All solutions, each family entered by the seed."""
    return len(robot.ik(T, seed=q, within_limits=False))


def held(joint: int, robot: Robot, T: Array, q: Array) -> int:
    """All solutions with a joint at its value."""
    return len(robot.ik(T, locked={joint: float(q[joint])}, within_limits=False))


def four_parallel() -> Robot:
    """The arm whose axis 5 may be parallel to the first three."""
    rows = [DHRow(a=a, alpha=float(np.radians(alpha)), d=d) for a, alpha, d in FOUR_PARALLEL]
    return Robot.from_dh(DHTable(tuple(rows), "standard"))


KINDS: dict[str, tuple[Callable[[], Robot], dict[int, float], Solve]] = {
    "four parallel axes": (four_parallel, {3: 0.0}, plain),
    "four parallel axes, seeded": (four_parallel, {3: 0.0}, seeded),
    "stanford, wrist 1e-8 off axis 2": (partial(Robot.from_dh, "stanford"), {2: 1e-8}, plain),
    "stanford, the same, seeded": (partial(Robot.from_dh, "stanford"), {2: 1e-8}, seeded),
    "ur5, axes 4 and 6 parallel": (partial(Robot.from_dh, "ur5"), {4: 0.0}, plain),
    "crx10ia, two joints at 0, one at 90 deg": (
        partial(Robot.from_dh, "fanuc_crx10ia"),
        {3: 0.0, 4: 0.0, 2: np.pi / 2},
        plain,
    ),
    "iiwa7, elbow folded, joint 1 held": (
        partial(Robot.from_dh, "kuka_iiwa7"),
        {3: np.pi},
        partial(held, 0),
    ),
    "iiwa7, joint 2 held at 0": (partial(Robot.from_dh, "kuka_iiwa7"), {1: 0.0}, partial(held, 1)),
    "iiwa7, elbow held at 1e-6": (
        partial(Robot.from_dh, "kuka_iiwa7"),
        {3: 1e-6},
        partial(held, 3),
    ),
    "fr3, shoulder 1e-8 off straight, joint 4 held": (
        partial(Robot.from_dh, "franka_fr3"),
        {1: 1e-8, 4: np.pi / 2},
        partial(held, 3),
    ),
    "iiwa14, wrist and shoulder straight, joint 1 held": (
        partial(Robot.from_dh, "kuka_iiwa14"),
        {1: 0.0, 5: 0.0},
        partial(held, 0),
    ),
}


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.in_doubt", description=__doc__)
    parser.add_argument("--poses", type=int, default=12)
    parser.add_argument("--only", default="", help="kinds whose name has this in it")
    given = parser.parse_args()
    rows = []
    for name, (make, at, solve) in KINDS.items():
        if given.only not in name:
            continue
        robot = make()
        q = np.random.default_rng(1).uniform(-2.0, 2.0, (given.poses + 1, robot.n))
        q[:, list(at)] = list(at.values())
        Ts, taken, found = robot.fk(q), [], []
        for T, configuration in zip(Ts, q, strict=True):
            begin = time.perf_counter()
            found.append(solve(robot, T, configuration))
            taken.append(1e3 * (time.perf_counter() - begin))
        times = np.array(taken[1:])  # the first one builds the solver
        figures = np.median(times), times.mean(), times.max()
        rows.append([name, *(f"{x:.2f}" for x in figures), f"{np.mean(found[1:]):.1f}"])
    print(table(["poses in doubt", "median, ms", "mean, ms", "longest, ms", "solutions"], rows))


if __name__ == "__main__":
    main()
