"""``python -m benchmarks.seven_joints``: what an arm with a joint to spare takes, a pose a call.

Of each arm, medians over interleaved rounds on random poses: ``robot.ik(T)``, which sweeps a joint,
for each of its solutions too; the same with a seed, and how many solutions that has; with the swept
joint held, and that with a seed; ``robot.ik_intervals(T)``.
"""

import argparse
from functools import partial

import numpy as np

from benchmarks.clock import Block, each, interleaved
from benchmarks.compare import table
from dh2urdf import Robot

ARMS = ("franka_fer", "kuka_iiwa14", "kinova_gen3", "xarm7")
ASKED = ("swept", "seeded", "held", "held, seeded", "intervals")


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.seven_joints", description=__doc__)
    parser.add_argument("arms", nargs="*", default=ARMS)
    parser.add_argument("--seconds", type=float, default=20.0)
    given = parser.parse_args()
    blocks: dict[str, Block] = {}
    found = {}
    for name in given.arms:
        robot, rng = Robot.from_dh(name), np.random.default_rng(0)
        lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
        q = rng.uniform(lower, upper, (100, robot.n))
        Ts, seed, joint = robot.fk(q), rng.uniform(lower, upper), robot.solver.joint
        held = q.copy()
        held[:, joint] = 0.3
        locked = {joint: 0.3}
        towards = partial(robot.ik, seed=seed)
        found[name] = [np.mean([len(solve(T)) for T in Ts]) for solve in (robot.ik, towards)]
        blocks |= {
            f"{name} swept": each(robot.ik, Ts),
            f"{name} seeded": each(towards, Ts),
            f"{name} held": each(partial(robot.ik, locked=locked), robot.fk(held)),
            f"{name} held, seeded": each(partial(towards, locked=locked), robot.fk(held)),
            f"{name} intervals": each(robot.ik_intervals, Ts[:20]),
        }
    times = interleaved(blocks, given.seconds, most=400)
    rows = []
    for name in given.arms:
        calls = [1e6 * times[f"{name} {what}"].median for what in ASKED]
        (swept, seeded), (first, *others) = found[name], [f"{t:.1f}" for t in calls]
        rows.append([name, first, f"{swept:.1f}", f"{calls[0] / swept:.2f}", others[0]])
        rows[-1] += [f"{seeded:.1f}", *others[1:]]
    head = ["arm", "swept, us", "solutions", "us a solution", "seeded, us", "solutions"]
    print(table([*head, "held, us", "held and seeded, us", "intervals, us"], rows))


if __name__ == "__main__":
    main()
