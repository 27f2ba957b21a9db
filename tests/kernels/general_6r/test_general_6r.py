"""The general 6R solver against kinematics written apart from it and a search from many seeds."""

import numpy as np
import pytest
from general_6r_arms import (
    ARMS,
    DEG,
    PI,
    angular_distance,
    forward,
    links_of,
    newton_search,
    residuals,
    twist_and_jacobian,
)
from margins import assert_apart, assert_margin

from dh2urdf.ik.families.general_6r import plan_general_6r, replan_general_6r
from dh2urdf.kernels.general_6r import solve_general_6r


def solve_poses(rows, poses):
    """Plan an arm and solve poses (m, 4, 4): angles, residuals, counts."""
    m = len(poses)
    q, residual = np.zeros((m, 16, 6)), np.zeros((m, 16))
    count = np.zeros(m, dtype=np.int64)
    plan, doubt = plan_general_6r(links_of(rows)), np.zeros(m, dtype=np.int64)
    solve_general_6r(plan, poses, q, residual, count, doubt)
    return q, residual, count


def nearest(q, count, generating):
    """Distance of each generating configuration (m, 6) from the nearest solution, (m,)."""
    live = np.arange(16) < count[:, None]
    return np.where(live, angular_distance(q, generating[:, None]), np.inf).min(axis=1)


def check_sweep(rows, count, seed):
    """Number of random poses with an odd number of solutions, after all other checks."""
    rng = np.random.default_rng(seed)
    generating = rng.uniform(-PI, PI, (count, 6))
    poses = np.ascontiguousarray(forward(rows, generating))
    q, residual, found = solve_poses(rows, poses)
    live = np.arange(16) < found[:, None]
    assert np.isfinite(q[live]).all()
    independent = residuals(forward(rows, q[live]), np.repeat(poses, found, axis=0))
    # A fold that noise has just closed leaves a nearest approach that the contract takes.
    assert_margin(independent, 1e-9, quantile=0.9999)
    assert np.median(independent) <= 1e-13
    np.testing.assert_allclose(residual[live], independent, atol=1e-12)
    apart = angular_distance(q[:, :, None], q[:, None, :])
    apart[~(live[:, :, None] & live[:, None, :])] = np.inf
    apart[:, np.arange(16), np.arange(16)] = np.inf
    assert_apart(apart[np.isfinite(apart)], 1e-6, quantile=0.999)
    assert_margin(nearest(q, found, generating), 1e-5, 100, quantile=0.999)
    return int((found % 2).sum())


@pytest.mark.parametrize("name", ARMS)
def test_generating_configuration_is_found(name):
    """Every random pose's own configuration is among distinct solutions, in even number."""
    assert check_sweep(ARMS[name], 500, seed=1) == 0


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_generating_configuration_is_found_in_100_000_poses(name):
    """No generating configuration of 100,000 is missing; odd counts are merged branches."""
    assert check_sweep(ARMS[name], 100_000, seed=77) <= 10


def check_against_search(rows, configurations, starts):
    """Every isolated solution found from random seeds is among the solver's."""
    poses = np.ascontiguousarray(forward(rows, configurations))
    q, _, count = solve_poses(rows, poses)
    for m, pose in enumerate(poses):
        searched = newton_search(rows, pose, starts, seed=m)
        for x in searched:
            assert angular_distance(q[m, : count[m]], x).min() < 1e-7, configurations[m]
        yield len(searched), count[m]


@pytest.mark.parametrize("name", ["crx10ia", "jaco2", "manseur_doty", "random0"])
def test_count_equals_that_of_a_search_from_random_seeds(name):
    """At random poses the solver finds what damped Newton from 600 seeds finds, and no less."""
    q = np.random.default_rng(5).uniform(-PI, PI, (3, 6))
    for searched, found in check_against_search(ARMS[name], q, 600):
        assert searched <= found


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ["crx10ia", "jaco2", "xarm6", "gofa5", "manseur_doty", "random1"])
def test_counts_equal_those_of_a_long_search(name):
    """At random poses both find equally many solutions."""
    q = np.random.default_rng(6).uniform(-PI, PI, (40, 6))
    counts = np.array(list(check_against_search(ARMS[name], q, 3000)))
    assert (counts[:, 0] == counts[:, 1]).mean() > 0.95


@pytest.mark.parametrize("name", ["crx10ia", "jaco2", "xarm6", "gofa5", "ur5", "manseur_doty"])
@pytest.mark.parametrize("unit", [PI / 2, PI / 6])
def test_symmetric_poses_keep_their_configuration(name, unit):
    """Joints at multiples of 90 and 30 degrees are found where they are an isolated solution."""
    rows = ARMS[name]
    q = np.random.default_rng(9).integers(-6, 7, (60, 6)) * unit
    poses = np.ascontiguousarray(forward(rows, q))
    smallest = np.array(
        [
            np.linalg.svd(twist_and_jacobian(rows, x[None], T)[1][0])[1][-1]
            for x, T in zip(q, poses, strict=True)
        ]
    )
    found, _, count = solve_poses(rows, poses)
    isolated = smallest > 1e-3
    assert isolated.sum() >= 15
    assert_margin(nearest(found, count, q)[isolated], 1e-6)


@pytest.mark.parametrize("name", ["crx10ia", "xarm6", "ur5", "puma560", "random2"])
def test_unreachable_poses_have_no_solution(name):
    """A tool ten arm lengths away is reached by no configuration."""
    poses = np.tile(np.eye(4), (5, 1, 1))
    poses[:, :3, 3] = np.random.default_rng(2).normal(size=(5, 3)) * 10.0
    assert (solve_poses(ARMS[name], poses)[2] == 0).all()


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_size_of_the_arm_does_not_matter(size):
    """An arm scaled by a thousand either way keeps its solutions, in number and value."""
    rows = [(theta, d * size, a * size, alpha) for theta, d, a, alpha in ARMS["crx10ia"]]
    q = np.random.default_rng(4).uniform(-PI, PI, (50, 6))
    found, _, count = solve_poses(rows, np.ascontiguousarray(forward(rows, q)))
    assert_margin(nearest(found, count, q), 1e-6)
    np.testing.assert_array_equal(
        count, solve_poses(ARMS["crx10ia"], forward(ARMS["crx10ia"], q))[2]
    )


SINGULAR = {
    "ur5": [[0, -90, 0, -90, 0, 0], [30, -60, 0, 40, 50, 60], [30, -60, 70, 40, 0, 60]],
    "puma560": [[0, 0, 0, 0, 0, 0], [0, 90, -90, 0, 0, 0], [10, 20, 30, 40, 0, 50]],
    "crx10ia": [[0, 0, 0, 0, 0, 0], [0, 0, 90, 0, 90, 0], [10, 20, 30, 0, 0, 50]],
    "jaco2": [[0, 180, 180, 0, 0, 0], [10, 180, 90, 0, 180, 50]],
    "xarm6": [[0, 0, 0, 0, 0, 0], [10, 20, -30, 0, 0, 50]],
}


@pytest.mark.parametrize(
    ("name", "degrees"), [(name, q) for name, poses in SINGULAR.items() for q in poses]
)
def test_singular_poses_have_a_solution(name, degrees):
    """Where joints are free or the arm is stretched, a certified solution comes back too."""
    rows = ARMS[name]
    pose = forward(rows, np.array([degrees]) * DEG)
    q, residual, count = solve_poses(rows, np.ascontiguousarray(pose))
    assert count[0] >= 1
    independent = residuals(forward(rows, q[0, : count[0]]), np.tile(pose, (count[0], 1, 1)))
    assert_margin(independent, 1e-9)
    assert_margin(residual[0, : count[0]], 1e-9)


def test_what_was_solved_before_does_not_matter():
    """Poses one by one, in the reverse order, give the same numbers as all at once."""
    rows = ARMS["gofa5"]
    arm = plan_general_6r(links_of(rows))
    poses = np.ascontiguousarray(forward(rows, np.random.default_rng(3).uniform(-PI, PI, (20, 6))))
    q, residual, count = solve_poses(rows, poses)
    for m in reversed(range(20)):
        one_q, one_residual, found = np.zeros((1, 16, 6)), np.zeros((1, 16)), np.zeros(1, np.int64)
        solve_general_6r(arm, poses[m : m + 1], one_q, one_residual, found, found.copy())
        k = found[0]
        assert k == count[m]
        np.testing.assert_array_equal(one_q[0, :k], q[m, :k])
        np.testing.assert_array_equal(one_residual[0, :k], residual[m, :k])


def test_an_arm_with_other_links_keeps_its_eliminations():
    """Planned again with its own links, an arm gives the same solutions; another arm, its own."""
    arms = [links_of(ARMS[name]) for name in ("gofa5", "crx10ia")]
    poses = np.ascontiguousarray(
        forward(ARMS["gofa5"], np.random.default_rng(8).uniform(-PI, PI, (20, 6)))
    )
    plans = [plan_general_6r(arms[0])]
    plans.append(replan_general_6r(plans[0], arms[0]))
    plans.append(replan_general_6r(replan_general_6r(plans[0], arms[1]), arms[0]))
    results = []
    for plan in plans:
        q, residual, count = np.zeros((20, 16, 6)), np.zeros((20, 16)), np.zeros(20, np.int64)
        solve_general_6r(plan, poses, q, residual, count, count.copy())
        results.append((q, count))
    for q, count in results[1:]:
        np.testing.assert_array_equal(count, results[0][1])
        np.testing.assert_array_equal(q, results[0][0])
