"""Arms that are not quite what the drawing says: rounded files and factory calibration."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from ik_referee import draw, forward, gaps, jacobians, shipped, solve

import dh2urdf
from dh2urdf.conversions.dh_to_chain import dh_to_chain
from dh2urdf.conversions.dh_to_urdf import UrdfOptions
from dh2urdf.conversions.write_urdf import urdf_text
from dh2urdf.ik.general_6r import General6R
from dh2urdf.ik.solver import select_solver

pytestmark = pytest.mark.exhaustive

ARMS = ["ur5", "puma560"]
NOISE = [1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3]
KEYS = ("theta", "d", "a", "alpha")


def changed(table, change):
    """The table with every parameter of every row changed."""
    rows = tuple(replace(row, **{k: change(getattr(row, k)) for k in KEYS}) for row in table.rows)
    return replace(table, rows=rows)


@cache
def noisy(name, size, seed=0):
    rng = np.random.default_rng(seed)
    table = dh2urdf.load_table(name)
    return dh_to_chain(changed(table, lambda x: x + size * float(rng.uniform(-1, 1))))


def draw_near_singularities(chain, m, seed):
    """Random configurations, one in three near a wrist or an elbow in line."""
    rng = np.random.default_rng(seed)
    q = draw(chain, m, seed)
    for joint in (2, 4):
        near = rng.random(m) < 1 / 6
        q[near, joint] = 10.0 ** rng.uniform(-4, -1, near.sum()) * rng.choice([-1, 1], near.sum())
    return q


def regularity(chain, q):
    J = jacobians(chain, q)
    J[..., :3, :] /= chain.size
    return np.linalg.svd(J, compute_uv=False)[..., -1]


def check_noisy(chain, m, seed):
    """All contracts but completeness, and the rows whose own configuration is missing."""
    q = draw_near_singularities(chain, m, seed)
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    exists = np.arange(found.q.shape[1]) < found.count[:, None]
    owner = np.repeat(np.arange(m), found.count)
    assert np.abs(forward(chain, found.q[exists]) - Ts[owner]).max() <= 1e-9
    least = np.full(m, np.inf)
    np.minimum.at(least, owner, regularity(chain, found.q[exists]))
    assert not (found.count[least > 1e-3] % 2).any()
    away = np.where(exists, gaps(chain, np.nan_to_num(found.q), q[:, None]), np.inf).min(axis=1)
    return np.flatnonzero(away > np.maximum(1e-6, 1e-11 / regularity(chain, q)))


@pytest.mark.parametrize("size", NOISE)
@pytest.mark.parametrize("name", ARMS)
def test_noise_takes_no_configuration_away(name, size):
    """With noise in every parameter each of 500 poses has its own configuration, certified."""
    assert len(check_noisy(noisy(name, size), 500, seed=1)) == 0


@pytest.mark.exhaustive
@pytest.mark.parametrize("size", NOISE)
@pytest.mark.parametrize("name", ARMS)
def test_noise_takes_no_configuration_away_in_100_000_poses(name, size):
    """With noise in every parameter each of 100,000 poses has its own configuration."""
    missing = [len(check_noisy(noisy(name, size, seed), 5_000, seed)) for seed in range(20)]
    assert sum(missing) == 0


@pytest.mark.parametrize("size", [1e-8, 1e-6, 1e-4, 1e-3])
@pytest.mark.parametrize("name", ARMS)
def test_seeds_from_the_nominal_arm_lose_nothing(name, size):
    """Nominal seeds with the general solver in doubt give what the general solver gives alone."""
    chain = noisy(name, size, seed=2)
    solver = select_solver(chain)
    assert solver.name.startswith("nearly ")
    q = draw_near_singularities(chain, 300, seed=3)
    Ts = forward(chain, q)
    mine, general = solve(chain, Ts, solver=solver), solve(chain, Ts, solver=General6R(chain))
    for i in range(len(q)):
        a, b = mine.of(i)[0], general.of(i)[0]
        if len(b) and regularity(chain, b).min() < 1e-4:
            continue
        assert len(a) == len(b)
        assert gaps(chain, b[:, None], a[None]).min(axis=1).max(initial=0.0) < 1e-6


@pytest.mark.parametrize("name", ARMS)
def test_solutions_are_those_of_the_exact_arm(name):
    """The nominal arm misses the pose by the size of the noise, the solutions do not."""
    chain, nominal = noisy(name, 1e-4, seed=4), shipped(name)
    Ts = forward(chain, draw(chain, 20, seed=5))
    found = solve(chain, Ts)
    for i, T in enumerate(Ts):
        q = found.of(i)[0]
        assert np.abs(forward(chain, q) - T).max() < 1e-9
        assert np.abs(forward(nominal, q) - T).max(axis=(1, 2)).min() > 1e-6


ROUNDED = ["ur5", "ur10e", "puma560", "kuka_kr6_r700", "fanuc_lrmate200id", "denso_vs060"]


@pytest.mark.parametrize("digits", [4, 6])
@pytest.mark.parametrize("name", ROUNDED)
def test_a_rounded_arm_keeps_all_its_solutions(name, digits):
    """Rounded to 4 or 6 digits an arm has as many solutions, each near one of the exact arm."""
    exact = shipped(name)
    rounded = dh_to_chain(changed(dh2urdf.load_table(name), lambda x: round(x, digits)))
    q = draw(exact, 100, seed=6)
    before = solve(exact, forward(exact, q))
    after = solve(rounded, forward(rounded, q))
    compared = 0
    for i in range(len(q)):
        a, b = before.of(i)[0], after.of(i)[0]
        if regularity(exact, a).min() < 0.05:
            continue
        compared += 1
        assert len(a) == len(b)
        assert gaps(exact, a[:, None], b[None]).min(axis=1).max() < 0.05
    assert compared > 10


@pytest.mark.parametrize(("digits", "distance"), [(4, 1e-5), (6, 1e-6)])
def test_a_rounded_urdf_is_solved_like_the_table(tmp_path, digits, distance):
    """A URDF with 1.5708 for pi/2 gives a solver that says what was done and how far it is."""
    path = tmp_path / "ur5.urdf"
    options = UrdfOptions(digits=digits, embed_table=False)
    path.write_text(urdf_text(dh2urdf.load_table("ur5"), options))
    robot = dh2urdf.Robot.from_urdf(path, base="base_link", tip="tool0")
    assert str(robot.solver) == "nearly three parallel axes"
    stated = float(re.search(r"up to (\S+) \(m, rad\) away", robot.solver.explain())[1])
    assert 0.1 * distance < stated < 10 * distance
    rng = np.random.default_rng(0)
    for _ in range(20):
        q = robot.random_configuration(rng)
        found = robot.ik(robot.fk(q), seed=q)
        assert np.abs(found[0] - q).max() < 1e-8
        assert found.verify().max() < 1e-9


def test_a_calibrated_arm_with_frames_far_out_is_solved():
    """Nearly parallel axes put DH frames hundreds of metres away, and the arm is solved."""
    table = dh2urdf.load_table("ur10")
    shift = {1: ("d", 430.0), 2: ("d", -437.0), 3: ("d", 7.0)}
    rows = []
    for i, row in enumerate(table.rows):
        key, value = shift.get(i, ("d", 0.0))
        tilt = {1: 1.2e-3, 2: -0.9e-3}.get(i, 1e-4)
        rows.append(replace(row, **{key: row.d + value}, alpha=row.alpha + tilt))
    chain = dh_to_chain(replace(table, rows=tuple(rows)))
    q = draw(chain, 200, seed=7)
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    exists = np.arange(found.q.shape[1]) < found.count[:, None]
    away = np.where(exists, gaps(chain, np.nan_to_num(found.q), q[:, None]), np.inf).min(axis=1)
    assert away.max() < 1e-6
    assert found.residual[exists].max() <= 1e-9


def test_exact_arms_are_not_called_nearly():
    """No shipped arm is taken for a noisy one."""
    for name in dh2urdf.list_tables():
        if shipped(name).n == 6:
            assert "nearly" not in select_solver(shipped(name)).name
