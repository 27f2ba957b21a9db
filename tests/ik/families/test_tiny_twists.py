"""Axes that are parallel but for a hair: every pose of an arm's own is reached, at any twist.

The reference is the table's own product of matrices.
"""

from functools import cache

import numpy as np
import pytest

import dh2urdf
from dh2urdf.dh import DHRow, DHTable, JointType

TWISTS = [0.0, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3]

POSES = 12


def plain(*values):
    """A row from d, a, alpha, at a theta that means nothing."""
    return DHRow(0.37, *values)


def slide(row):
    return DHRow(row.theta, row.d, row.a, row.alpha, JointType.PRISMATIC)


def short(rng, n, kinds, twist):
    """A random chain with one or two tiny twists; half of its lengths are zero."""
    lengths = rng.uniform(0.1, 0.8, (n, 2)) * rng.integers(0, 2, (n, 2))
    alphas = rng.choice([np.pi / 2, -np.pi / 2, 0.9], n)
    alphas[rng.choice(n, min(n, 2), replace=False)] = twist
    rows = [plain(*ds, al) for ds, al in zip(lengths.tolist(), alphas.tolist(), strict=True)]
    if kinds == "slide":
        at = int(rng.integers(n))
        rows[at] = slide(rows[at])
    return rows


def wrist(rng, _, twist):
    """Six joints with a spherical wrist and tiny twists in the arm."""
    rows = [plain(0.3, 0.1, np.pi / 2), plain(0.0, 0.5, twist), plain(0.1, 0.2, np.pi / 2)]
    rows[int(rng.integers(2))] = plain(0.2, 0.4, -twist)
    return [*rows, plain(0.4, 0, -1.2), plain(0, 0, 1.2), plain(0.1, 0, 0)]


def parallel(rng, _, twist):
    """Six joints like a UR's, two of its parallel axes out by a hair."""
    rows = [plain(0.1, 0, np.pi / 2), plain(0, 0.4, twist), plain(0, 0.4, twist * rng.integers(2))]
    return [*rows, plain(0.1, 0, np.pi / 2), plain(0.1, 0, -np.pi / 2), plain(0.1, 0, 0)]


def general(rng, _, twist):
    """Six joints of any geometry with one or two tiny twists."""
    alphas = rng.uniform(0.4, 1.4, 6)
    alphas[rng.choice(5, 2, replace=False)] = twist
    return [plain(*rng.uniform(0.1, 0.5, 2).tolist(), float(al)) for al in alphas]


FAMILIES = {
    "of the report": lambda _rng, _n, twist: [plain(0, 0, 1.0), plain(0, 0, twist), plain(0, 0, 0)],
    **{
        f"{n} joints, {kinds}": lambda rng, n, twist, kinds=kinds: short(rng, n, kinds, twist)
        for kinds in ("turning", "slide")
        for n in (2, 3, 4, 5)
    },
    "spherical wrist": wrist,
    "three parallel": parallel,
    "general": general,
}


@cache
def case(family, twist, seed):
    """An arm, configurations within half a turn, their poses."""
    rng = np.random.default_rng(seed)
    n = int(family[0]) if family[0].isdigit() else 6
    table = DHTable(tuple(FAMILIES[family](rng, n, twist)), "standard")
    robot = dh2urdf.Robot.from_dh(table)
    q = rng.uniform(-3.0, 3.0, (POSES, robot.n)) * np.where(robot.slides, 0.2, 1.0)
    return robot, q, np.stack([table.fk(row) for row in q])


def check_reached(family, twist, seed):
    """Every pose made from a configuration has a solution, and each solution reaches it."""
    robot, _, T = case(family, twist, seed)
    found = robot.ik_batch(T, within_limits=False)
    assert found.solved.all()
    for k in range(POSES):
        for row in found[k].q:
            D = robot.table.fk(row) - T[k]
            assert np.linalg.norm(D[:3, 3]) <= 1.1e-9
            assert np.abs(D[:3, :3]).max() <= 1.1e-9


@pytest.mark.parametrize("twist", TWISTS)
@pytest.mark.parametrize("family", FAMILIES)
def test_poses_of_its_own_are_reached_at_any_twist(family, twist):
    """Every pose of an arm's own is reached: 12 poses, of three arms of a family one in turn."""
    check_reached(family, twist, TWISTS.index(twist) % 3)


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("twist", TWISTS)
@pytest.mark.parametrize("family", FAMILIES)
def test_all_three_arms_reach_poses_of_their_own_at_any_twist(family, twist, seed):
    """Each of them at every twist."""
    check_reached(family, twist, seed)


@pytest.mark.parametrize("twist", [1e-7, 1e-5, 1e-3])
@pytest.mark.parametrize("family", ["spherical wrist", "three parallel", "general"])
def test_the_configuration_itself_is_found_as_far_as_the_pose_tells(family, twist):
    """Six joints with a tiny twist give back the configuration that a pose was made from."""
    for seed in range(3):
        robot, q, T = case(family, twist, seed)
        found = robot.ik_batch(T, within_limits=False)
        for k in range(POSES):
            J = robot.jacobian(q[k])
            least = np.linalg.svd(J, compute_uv=False)[-1]
            gap = np.abs(np.remainder(found[k].q - q[k] + np.pi, 2.0 * np.pi) - np.pi)
            assert gap.max(axis=1).min() < max(1e-6, 1e-8 / least)
