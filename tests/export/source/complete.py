"""At how many poses an exported file says that its solutions are all.

``python -m tests.export.source.complete [ARM...]``: each arm's file is compiled and solves 3000
poses, a third of them random, a third at multiples of 45 degrees, a third beside such, and 300 with
all joints at multiples of 90 degrees; of arms with a joint to spare that one is held. Others
are left to ``Robot.ik``.
"""

import sys
import tempfile

import numpy as np

from dh2urdf import Robot
from dh2urdf.robots import list_tables
from tests.export.source.compiled import Arm, configurations

POSES = 3000


def main(names):
    """Print a line for each arm: all, of these the random, the singular, those beside.

    Then those at multiples of 90 degrees, and how many of them have no solution in the file.
    """
    for name in names or list_tables():
        robot = Robot.from_dh(name)
        held = robot.solver.joint if robot.n == 7 else None
        with tempfile.TemporaryDirectory() as folder:
            arm = Arm(robot, folder, held)
            arm.compile("-O1", "-ffp-contract=off")
            found = arm.run(configurations(robot, np.random.default_rng(2), POSES))
            whole = found["inside"]["complete"]
            low, high = robot.bounded(1.0, np.pi)
            turns = np.random.default_rng(3).uniform(low, high, (300, robot.n))
            q = np.where(robot.slides, turns, 0.5 * np.pi * np.round(turns / (0.5 * np.pi)))
            square = arm.run(np.clip(q, low, high))["inside"]
        shares = [100.0 * np.mean(x) for x in (whole, *(whole[k::3] for k in range(3)))]
        shares += [100.0 * np.mean(x) for x in (square["complete"], square["count"] == 0)]
        text = " ".join(f"{share:6.1f}" for share in shares)
        print(f"{name:24s} {arm.made.solver:28s} {text} %", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
