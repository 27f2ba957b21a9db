"""``python -m benchmarks.slides``: six joints of which one, two or three slide, a class a row.

Two arms a class, of random lengths with random twists and with right angles; random poses in a
batch on one thread, those in doubt included. Microseconds a pose of processor time, medians over
the rounds; how many solutions a pose has, and the most.
"""

import argparse
import itertools

import numpy as np

from benchmarks.clock import interleaved
from benchmarks.compare import table
from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.ik.arm import Outputs, select_solver

SLIDES = (1, 2, 3)


def arm(kinds: str, right_angled: bool) -> Robot:
    """An arm of six random rows."""
    rng = np.random.default_rng([right_angled, *map(ord, kinds)])
    rows = []
    for kind in kinds:
        theta, d, a, alpha = rng.uniform((-3.0, -0.5, -0.5, -3.0), (3.0, 0.5, 0.5, 3.0)).tolist()
        if right_angled:
            alpha = float(rng.choice((-1, 1))) * np.pi / 2
        rows.append(DHRow(theta, d, a, alpha, "prismatic" if kind == "P" else "revolute"))
    return Robot.from_dh(DHTable(tuple(rows), "standard", name=kinds))


def row(kinds: str, poses: int, budget: float) -> list[str]:
    """One class: times of both arms, within a budget [s], and their solutions."""
    times, counts = [], []
    for right_angled in (False, True):
        chain = arm(kinds, right_angled).chain
        q = np.random.default_rng(1).uniform(-np.pi, np.pi, (poses, 6))
        q[:, chain.prismatic] /= np.pi
        Ts = np.stack([chain.fk(one) for one in q])
        solver = select_solver(chain)
        out = Outputs.of(poses, solver.kmax, 6)

        def solving() -> int:
            solver.solve_batch(Ts, False, out)  # noqa: B023 - called before the next arm is made
            return poses

        times.append(interleaved({"ours": solving}, budget)["ours"].processor)
        counts.append(out.counts.copy())
    shown = [f"{1e6 * time:.1f} us" for time in times]
    return [kinds, *shown, f"{np.mean(counts):.1f}", str(np.max(counts))]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.slides", description=__doc__)
    parser.add_argument("--poses", type=int, default=1000, help="of a batch")
    parser.add_argument("--seconds", type=float, default=0.5, help="an arm")
    given = parser.parse_args()
    rows = []
    for slides in SLIDES:
        for places in itertools.combinations(range(6), slides):
            kinds = "".join("P" if i in places else "R" for i in range(6))
            rows.append(row(kinds, given.poses, given.seconds))
    print(table(["joints", "any twists", "right angles", "solutions", "most"], rows))


if __name__ == "__main__":
    main()
