"""``python -m benchmarks.held_batch``: random poses with one of seven joints held, in batches.

A few of 20,000 such poses are in doubt and take as long as thousands of others. Each batch has
poses of its own; of each arm and joint the time a pose of the fastest batch, the mean of all, and
how many batches are slower than the fastest by half.
"""

import argparse
import time

import numpy as np

from benchmarks.compare import table
from dh2urdf import Robot

ARMS = ("kuka_iiwa7", "kuka_iiwa14", "kinova_gen3", "franka_fer")


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.held_batch", description=__doc__)
    parser.add_argument("arms", nargs="*", default=ARMS)
    parser.add_argument("--joints", type=int, nargs="*", default=(0, 2, 4, 6))
    parser.add_argument("--poses", type=int, default=20_000)
    parser.add_argument("--batches", type=int, default=3)
    given = parser.parse_args()
    rows = []
    for name in given.arms:
        robot = Robot.from_dh(name)
        for joint in given.joints:
            rng, times = np.random.default_rng(0), np.empty(given.batches)
            for k in range(given.batches):
                q = rng.uniform(robot.lower, robot.upper, (given.poses, robot.n))
                Ts = robot.fk(q)
                begun = time.perf_counter()
                robot.ik_batch(Ts, within_limits=False, locked={joint: q[:, joint]})
                times[k] = 1e6 * (time.perf_counter() - begun) / given.poses
            least, slow = times.min(), int((times > 1.5 * times.min()).sum())
            rows.append([name, str(joint), f"{least:.2f}", f"{times.mean():.2f}", str(slow)])
    print(table(["arm", "joint", "fastest, us", "mean, us", "slower by half"], rows))


if __name__ == "__main__":
    main()
