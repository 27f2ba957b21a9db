"""Arms with two parallel axes and two that meet, against their configurations and two referees."""

import math

import numpy as np
import pytest
from ik_referee import (
    GAP,
    RESIDUAL,
    distances,
    draw,
    exists,
    forward,
    gaps,
    misses,
    noisy_table,
    regularity,
    rows_of,
    search,
    shipped,
    solve,
)
from margins import assert_margin

from dh2urdf import Robot
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.general_6r import General6R

SHIPPED = ["fanuc_crx10ia", "fanuc_crx10ia_l", "kinova_jaco2", "xarm6", "abb_gofa5"]

CLASSES = {
    "2 || 3, 4 meets 5": (1, 3),
    "2 || 3, 5 meets 6": (1, 4),
    "4 || 5, 2 meets 3": (3, 1),
    "4 || 5, 1 meets 2": (3, 0),
}
"""Links between axes that are parallel, and between axes that meet."""

REGULAR = 1e-4
"""Smallest singular value of a Jacobian, lengths relative, from which on no solution is lost."""

GRIDS = (90, 45, 30, 15)
NOISE = (0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2)

FOLDED = DHTable(
    tuple(
        DHRow(math.radians(theta), d, a, math.radians(alpha))
        for theta, d, a, alpha in [
            (0, 0.275, 0, -90),
            (-90, 0, 0.7, 180),
            (-90, 0, 0, -90),
            (0, -0.5, 0, 90),
            (0, -0.162, 0, -90),
            (0, -0.13, 0, 180),
        ]
    ),
    "standard",
)


def random_chain(geometry, convention, seed, square=False):
    """An arm of a class with random lengths; twists too, unless they are right angles."""
    rng = np.random.default_rng(seed)
    parallel, meeting = CLASSES[geometry]
    rows = rng.uniform((-3, -0.5, 0.1, 0.4), (3, 0.5, 0.5, 2.7), (6, 4))
    rows[:, 3] *= rng.choice([-1, 1], 6)
    if square:
        rows[:, 0], rows[:, 3] = 0.0, rng.choice([-1, 1], 6) * math.pi / 2
        rows[rng.random(6) < 0.4, 1] = 0.0
    first = 0 if convention == "standard" else 1
    rows[(parallel + first) % 6, 3] = rng.choice([0.0, math.pi])
    rows[(meeting + first) % 6, 2] = 0.0
    return dh_to_chain(DHTable(tuple(DHRow(*row) for row in rows.tolist()), convention))


def structured(rng, m):
    """Configurations (m, 6) on grids, up to two joints anywhere, each with its noise."""
    step = np.radians(rng.choice(GRIDS, (m, 1)))
    q = step * np.round(rng.uniform(-math.pi, math.pi, (m, 6)) / step)
    order = np.argsort(rng.random((m, 6)), axis=1)
    q = np.where(order < rng.integers(0, 3, (m, 1)), rng.uniform(-math.pi, math.pi, (m, 6)), q)
    return q + rng.choice(NOISE, (m, 1)) * rng.uniform(-1.0, 1.0, (m, 6))


def check(chain, q):
    """All contracts at the poses of configurations; none that is regular may be lost."""
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    solutions, owner = rows_of(found)
    error = np.abs(forward(chain, solutions) - Ts[owner]).max(axis=(1, 2))
    assert_margin(error, RESIDUAL, quantile=0.99)
    assert_margin(found.residual[exists(found)], RESIDUAL, quantile=0.99)
    assert (distances(chain, found) > GAP).all()
    regular = regularity(chain, q) > REGULAR
    assert regular.any()
    lost = regular & (misses(chain, found, q) > GAP)
    assert not lost.any(), q[lost]
    return found


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("geometry", CLASSES)
def test_random_arms_of_each_class_lose_nothing(geometry, convention):
    """Every configuration is found, and as many solutions as the general solver finds or more."""
    for seed in range(3):
        chain = random_chain(geometry, convention, seed)
        assert select_solver(chain).name == "two parallel axes"
        q = draw(chain, 150, seed)
        found, general = check(chain, q), solve(chain, forward(chain, q), solver=General6R(chain))
        assert (found.count >= general.count).all()
        assert (found.count == general.count).mean() > 0.98


@pytest.mark.parametrize("geometry", CLASSES)
def test_square_arms_lose_no_regular_pose_of_a_grid(geometry):
    """Arms of right angles, some offsets zero, at structured poses."""
    rng, chains = np.random.default_rng(1), 0
    for seed in range(20):
        chain = random_chain(geometry, "standard", seed, square=True)
        if select_solver(chain).name == "two parallel axes":
            check(chain, structured(rng, 40))
            chains += 1
    assert chains >= 5


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_arms_lose_no_regular_pose_of_a_grid(name):
    """Grids of 90, 45, 30, 15 deg, up to two joints anywhere, noise of 0 to 1e-2."""
    check(shipped(name), structured(np.random.default_rng(2), 400))


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_arms_lose_none_of_20_000_poses_of_a_grid(name):
    """The same, fifty times over."""
    for seed in range(10):
        check(shipped(name), structured(np.random.default_rng(seed), 2_000))


TEN = {name: shipped(name) for name in (*SHIPPED, "niryo_ned2")}
TEN |= {geometry: random_chain(geometry, "standard", 0) for geometry in CLASSES}


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", TEN)
def test_100_000_random_poses_of_ten_arms_miss_nothing(name):
    """Nor is a solution wrong or there twice; a configuration is found as its pose tells it."""
    chain = TEN[name]
    for seed in range(20):
        q = draw(chain, 5_000, seed)
        found = check(chain, q)
        assert found.residual[exists(found)].max() <= 1e-12 * max(1.0, chain.size)
        told = np.maximum(GAP, 1e-12 / np.maximum(regularity(chain, q), 1e-12))
        assert (misses(chain, found, q) <= told).all()


@pytest.mark.parametrize(
    ("chain", "q"),
    [
        (shipped("fanuc_crx10ia"), (90, 0, 30, -90, -90, -60)),
        (dh_to_chain(FOLDED), (45, 0, 90, -90, 90, 90)),
    ],
    ids=["crx", "folded"],
)
def test_several_solutions_with_one_value_of_joint_1_are_all_found(chain, q):
    """Roots of multiplicity two and more carry eight regular solutions, not six."""
    T = forward(chain, np.radians(q)[None])
    found = solve(chain, T).of(0)[0]
    assert len(found) == 8
    assert (regularity(chain, found) > 1e-2).all()


def missing(chain, seed, m, starts):
    """Regular solutions that a search finds at structured poses, and the solver does not."""
    q = structured(np.random.default_rng(seed), m)
    Ts, lost = forward(chain, q), []
    found = solve(chain, Ts)
    for i, T in enumerate(Ts):
        others = search(chain, T, seed=i, starts=starts)
        mine = found.of(i)[0]
        others = others[regularity(chain, others) > REGULAR]
        known = [len(mine) > 0 and gaps(chain, p, mine).min() < 1e-5 for p in others]
        lost += [(i, p) for p, yes in zip(others, known, strict=True) if not yes]
    return lost


@pytest.mark.parametrize("name", SHIPPED)
def test_a_search_finds_no_other_regular_solution(name):
    """Damped Newton from 100 starts a structured pose finds nothing that is not known."""
    assert not missing(shipped(name), 5, 12, 100)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_a_search_of_1_000_poses_finds_no_other_regular_solution(name):
    """The same for 1,000 structured poses of all arms, 400 starts each."""
    assert not missing(shipped(name), 6, 200, 400)


@pytest.mark.parametrize("size", [1e-8, 1e-7, 1e-6, 3e-6])
@pytest.mark.parametrize("name", SHIPPED)
def test_rounded_arms_have_the_general_solver_s_solutions(name, size):
    """A nearly nominal arm has its own solutions, not those of the nominal one."""
    chain = dh_to_chain(noisy_table(name, size, seed=1))
    assert select_solver(chain).name == "nearly two parallel axes"
    q = draw(chain, 100, 3)
    found, general = check(chain, q), solve(chain, forward(chain, q), solver=General6R(chain))
    assert (found.count >= general.count).all()


def test_few_random_poses_are_left_to_the_general_solver(monkeypatch):
    """Of 1,000 random poses of each arm fewer than one in twenty is in doubt."""
    for name in SHIPPED:
        asked = []
        solver = select_solver(shipped(name))

        def counted(Ts, rows, within_limits, out, asked=asked, look_wider=solver.look_wider):
            asked.append(np.count_nonzero(out.counts < 0))
            return look_wider(Ts, rows, within_limits, out)

        monkeypatch.setattr(solver, "look_wider", counted)
        solve(shipped(name), forward(shipped(name), draw(shipped(name), 1_000, 4)), solver=solver)
        assert 0 < sum(asked) < 50


@pytest.mark.parametrize(
    "degrees", [(-90, 90, -90, 90, 0, 0), (180, 90, -90, 90, 90, 180), (17, -90, -90, -90, 33, 4)]
)
def test_a_family_with_every_value_of_joint_1_is_named(degrees):
    """Axes 1 and 5 are one line, joints 1 and 5 turn against each other: F is zero throughout."""
    robot, q = Robot.from_dh("fanuc_crx10ia"), np.radians(degrees)
    found = robot.ik(robot.fk(q), seed=q, within_limits=False)
    k = np.linalg.norm(found.q - q, axis=1).argmin()
    assert found.free_joints[k] == (0, 4)
    assert_margin(np.abs(found.q[k] - q), 1e-7)


def test_the_solver_explains_itself():
    """The explanation names the axes, the method, and what helps it."""
    text = select_solver(shipped("xarm6")).explain()
    assert "2 || 3, 4 meets 5" in text
    assert "polynomial" in text
    assert "general" in text
    mirrored = select_solver(random_chain("4 || 5, 1 meets 2", "standard", 0))
    assert "from the tool" in mirrored.explain()
