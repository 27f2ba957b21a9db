"""Arms that are not quite what the drawing says: rounded files and factory calibration."""

import re
from dataclasses import replace
from functools import cache

import ik_referee as ref
import numpy as np
import pytest
from ik_referee import draw, exists, forward, gaps, misses, regularity, rows_of, shipped, solve

import dh2urdf
from dh2urdf.conversions.write.table_chain import dh_to_chain
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.general_6r import General6R
from dh2urdf.ik.families.near_family import NearFamily
from dh2urdf.transforms import inverse, matrix_to_rpy

ARMS = ["ur5", "puma560"]
NOISE = [1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3]


@cache
def noisy(name, size, seed=0):
    return dh_to_chain(ref.noisy_table(name, size, seed))


def draw_near_singularities(chain, m, seed):
    """Random configurations, one in three near a wrist or an elbow in line."""
    rng = np.random.default_rng(seed)
    q = draw(chain, m, seed)
    for joint in (2, 4):
        near = rng.random(m) < 1 / 6
        q[near, joint] = 10.0 ** rng.uniform(-4, -1, near.sum()) * rng.choice([-1, 1], near.sum())
    return q


def check_noisy(chain, m, seed):
    """All contracts but completeness, and the rows whose own configuration is missing."""
    q = draw_near_singularities(chain, m, seed)
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    solutions, owner = rows_of(found)
    assert np.abs(forward(chain, solutions) - Ts[owner]).max() <= 1e-9
    least = np.full(m, np.inf)
    np.minimum.at(least, owner, regularity(chain, solutions))
    assert not (found.count[least > 1e-3] % 2).any()
    return np.flatnonzero(misses(chain, found, q) > np.maximum(1e-6, 1e-11 / regularity(chain, q)))


@pytest.mark.parametrize("size", NOISE)
@pytest.mark.parametrize("name", ARMS)
def test_noise_takes_no_configuration_away(name, size):
    """With noise in every parameter each of 500 poses has its own configuration, certified."""
    assert len(check_noisy(noisy(name, size), 500, seed=1)) == 0


@pytest.mark.parametrize(("name", "size", "seed"), [("ur5", 1e-9, 0), ("ur5", 1e-3, 13)])
def test_branches_near_a_singularity_survive_noise(name, size, seed):
    """Among 5,000 poses are some that the nominal arm, taken for the arm, reaches less often."""
    assert len(check_noisy(noisy(name, size, seed), 5_000, seed)) == 0


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


CALIBRATED = ["ur3", "ur5", "ur10e", "ur30", "techman_tm5_700"]


def lost_by_the_general_solver(name, seed, m):
    """Poses that have fewer solutions where a calibrated arm's general solver comes first."""
    chain, rng = noisy(name, 2e-3, seed), np.random.default_rng(seed)
    first, both = NearFamily(chain), NearFamily(chain)
    first.far, both.far = True, False
    quarters = rng.integers(-4, 5, (m, 6)) * np.pi / 4
    beside = quarters + 10.0 ** rng.uniform(-6, -1.5, (m, 1)) * rng.standard_normal((m, 6))
    Ts = forward(chain, np.concatenate([draw(chain, m, seed), quarters, beside]))
    return (solve(chain, Ts, solver=first).count < solve(chain, Ts, solver=both).count).sum()


@pytest.mark.parametrize("name", CALIBRATED)
def test_far_from_a_nominal_ur_the_general_solver_loses_nothing(name):
    """Where it comes first, as many solutions as with the nominal arm's seeds at every pose."""
    assert NearFamily(noisy("ur5", 2e-3, 1)).far
    assert lost_by_the_general_solver(name, 1, 60) == 0


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", CALIBRATED)
def test_the_general_solver_loses_nothing_of_ten_calibrations(name):
    """The same of 6,000 poses of ten calibrated arms."""
    assert sum(lost_by_the_general_solver(name, seed, 200) for seed in range(10)) == 0


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
    rounded = dh_to_chain(ref.changed(dh2urdf.load_table(name), lambda x: round(x, digits)))
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


def scattered_urdf(chain, digits, seed):
    """A URDF as a CAD program writes it: frames turned anyhow, all numbers rounded."""
    rng = np.random.default_rng(seed)
    T_base_last, parts, parent = np.eye(4), ['<robot name="cad"><link name="base"/>'], "base"
    for i in range(chain.n + 1):
        T_base_new = ref.random_pose(rng, 0.0)
        axis = "1 0 0"
        if i < chain.n:
            along = chain.axes[i]
            T_base_new[:3, 3] = chain.points[i] + rng.uniform(-0.2, 0.2) * along
            axis = " ".join(f"{x:.{digits}f}" for x in T_base_new[:3, :3].T @ along)
        else:
            T_base_new = chain.tool
        T = inverse(T_base_last) @ T_base_new
        xyz = " ".join(f"{x:.{digits}f}" for x in T[:3, 3])
        rpy = " ".join(f"{x:.{digits}f}" for x in matrix_to_rpy(T[:3, :3]))
        kind = "revolute" if i < chain.n else "fixed"
        parts.append(
            f'<link name="l{i}"/><joint name="j{i}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="l{i}"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>'
            '<limit lower="-3.1" upper="3.1" effort="1" velocity="1"/></joint>'
        )
        T_base_last, parent = T_base_new, f"l{i}"
    return "".join([*parts, "</robot>"])


@pytest.mark.parametrize("digits", [4, 6])
@pytest.mark.parametrize(
    ("name", "family"), [("ur5", "three parallel axes"), ("puma560", "spherical wrist")]
)
def test_a_rounded_urdf_keeps_all_its_solutions(tmp_path, name, family, digits):
    """A CAD export with few digits is solved for itself, and says how far it is from its family."""
    path = tmp_path / "cad.urdf"
    path.write_text(scattered_urdf(shipped(name), digits, seed=1))
    robot = dh2urdf.Robot.from_urdf(path)
    assert str(robot.solver) == f"nearly {family}"
    stated = float(re.search(r"up to (\S+) \(m, rad\) away", robot.solver.explain())[1])
    assert 0.1 * 10.0**-digits < stated < 20 * 10.0**-digits
    exact, rng = shipped(name), np.random.default_rng(0)
    compared = 0
    for _ in range(60):
        q = rng.uniform(-3, 3, 6)
        found = robot.ik(robot.fk(q), seed=q, within_limits=False)
        assert np.abs(found[0] - q).max() < 1e-6
        assert found.verify().max() < 1e-9
        before = solve(exact, forward(exact, q)[None]).of(0)[0]
        if regularity(exact, before).min() > 0.05:
            compared += 1
            assert len(found) == len(before)
    assert compared > 5


def test_a_calibrated_arm_with_frames_far_out_is_solved():
    """Nearly parallel axes put DH frames hundreds of metres away, and the arm is solved."""
    table = dh2urdf.load_table("ur10")
    shifts, tilts = (0, 430.0, -437.0, 7.0, 0, 0), (1e-4, 1.2e-3, -0.9e-3, 1e-4, 1e-4, 1e-4)
    rows = tuple(
        replace(row, d=row.d + shift, alpha=row.alpha + tilt)
        for row, shift, tilt in zip(table.rows, shifts, tilts, strict=True)
    )
    chain = dh_to_chain(replace(table, rows=rows))
    q = draw(chain, 200, seed=7)
    found = solve(chain, forward(chain, q))
    assert misses(chain, found, q).max() < 1e-6
    assert found.residual[exists(found)].max() <= 1e-9


def test_exact_arms_are_not_called_nearly():
    """No shipped arm is taken for a noisy one."""
    for name in dh2urdf.list_tables():
        if shipped(name).n == 6:
            assert "nearly" not in select_solver(shipped(name)).name
