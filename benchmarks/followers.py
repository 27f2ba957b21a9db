"""``python -m benchmarks.followers``: what a pose takes of arms whose joints follow others.

Random poses in a batch on one thread, limits aside: the least of several rounds, microseconds a
pose, with the number of solutions, the residual of the worst, and the part of the poses at which
the polynomial leaves doubt, so that more is searched for.
"""

import argparse
import time

import numpy as np

from benchmarks.compare import table
from dh2urdf import DHRow, DHTable, Mimic, Robot
from dh2urdf.ik.arm import Outputs
from dh2urdf.ik.families.followers import Followers
from dh2urdf.transforms import Array

H = float(np.pi / 2)
BEND = 0.610865238198015
"""35 degrees."""


def hollow_wrist(leader: int = 5, by: float = -1.0) -> Robot:
    """A painter of seven joints, one of which follows."""
    rows = [
        DHRow(d=0.66, a=0.3, alpha=-H),
        DHRow(theta=-H, a=1.2),
        DHRow(a=0.186, alpha=-H),
        DHRow(d=1.4083, alpha=BEND),
        DHRow(d=0.079169, alpha=-2 * BEND),
        DHRow(d=0.079169, alpha=BEND, mimic=Mimic(f"joint_{leader}", by)),
        DHRow(d=0.082),
    ]
    return Robot.from_dh(DHTable(tuple(rows), "standard", name="painter"))


def palletiser() -> Robot:
    """Two rods keep the tool level."""
    rows = (
        DHRow(d=0.131305, alpha=-H),
        DHRow(theta=-H, a=0.135),
        DHRow(theta=H, a=0.147),
        DHRow(mimic=Mimic("joint_2", -1.0)),
        DHRow(a=0.06, alpha=H, mimic=Mimic("joint_3", -1.0)),
        DHRow(),
    )
    return Robot.from_dh(DHTable(rows, "standard", name="palletiser"))


ARMS = {
    "hollow wrist": hollow_wrist(),
    "axis 6 with axis 4, one between": hollow_wrist(4, 1.0),
    "axis 6 with axis 3, two between": hollow_wrist(3, -1.0),
    "axis 6 by half of axis 5": hollow_wrist(5, 0.5),
    "palletiser": palletiser(),
}


def in_doubt(robot: Robot, Ts: Array) -> str:
    """The part of poses Ts (m, 4, 4) at which the polynomial leaves doubt."""
    solver = robot.solver
    if not isinstance(solver, Followers):
        return "-"
    out = Outputs.of(len(Ts), solver.kmax, robot.n)
    return f"{len(solver.solve_sure(Ts, False, out)) / len(Ts):.2%}"


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.followers")
    parser.add_argument("--poses", type=int, default=2000)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    rows = []
    for name, robot in ARMS.items():
        q = np.random.default_rng(0).uniform(-np.pi, np.pi, (options.poses, robot.n))
        Ts, times = robot.fk(q), []
        for _ in range(options.rounds):
            begun = time.perf_counter()
            batch = robot.ik_batch(Ts, within_limits=False, threads=1)
            times.append(time.perf_counter() - begun)
        micro, worst = 1e6 * min(times) / len(Ts), float(np.nanmax(batch.residual))
        cells = f"{micro:.1f}", f"{batch.count.mean():.2f}", f"{worst:.1e}"
        rows.append((name, *cells, in_doubt(robot, Ts)))
    print(table(("arm", "us a pose", "solutions", "residual", "in doubt"), rows))


if __name__ == "__main__":
    main()
