"""``python -m benchmarks.threads``: batches of all sizes on one thread and on two.

Medians over interleaved rounds, in nanoseconds a pose; ``out`` is into the arrays of an earlier
batch, without new memory. With ``--cold`` 128 MB are written before each turn: neither the poses
nor the solver are in the processor's cache, and a thread that waits has slept.
"""

import argparse
from functools import partial

import numpy as np

from benchmarks.clock import Block, interleaved
from benchmarks.compare import table
from benchmarks.machine import touch_memory
from dh2urdf import Robot

SIZES = (300, 1000, 2000, 4000, 20_000, 100_000)
WAYS = {"one": (1, False), "two": (2, False), "one, out": (1, True), "two, out": (2, True)}


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.threads", description=__doc__)
    parser.add_argument("arms", nargs="*", default=("puma560", "ur5", "so101", "fanuc_crx10ia"))
    parser.add_argument("--seconds", type=float, default=3.0, help="for each arm and size")
    parser.add_argument("--cold", action="store_true")
    given = parser.parse_args()
    rows = []
    for name in given.arms:
        robot, rng = Robot.from_dh(name), np.random.default_rng(0)
        lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
        poses = robot.fk(rng.uniform(lower, upper, (max(SIZES), robot.n)))
        for m in SIZES:
            blocks = {way: _block(robot, poses[:m], *how) for way, how in WAYS.items()}
            before = touch_memory if given.cold else int
            found = interleaved(blocks, given.seconds, most=400, before=before)
            one, two, one_out, two_out = (1e9 * found[way].median for way in WAYS)
            times = [f"{t:.0f}" for t in (one, two, one_out, two_out)]
            rows.append([name, f"{m}", *times, f"{one / two:.2f}", f"{one_out / two_out:.2f}"])
    print(table(["arm", "poses", *WAYS, "one / two", "the same, out"], rows))


def _block(robot: Robot, poses: np.ndarray, threads: int, again: bool) -> Block:
    """Solve the poses, into the same arrays or into new ones."""
    solve = partial(robot.ik_batch, poses, threads=threads)
    solve = partial(solve, out=solve()) if again else solve
    return lambda: len(solve())


if __name__ == "__main__":
    main()
