"""The general 6R solver against forward kinematics written here and a search from many seeds."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dh2urdf.kernels.general_6r import (
    make_work_6r,
    plan_general_6r,
    solve_general_6r,
    solve_general_6r_batch,
)

PI = math.pi
DEG = PI / 180.0
BEND = 0.0741 / math.sqrt(3.0)

# Rows (theta, d, a, alpha) of standard DH tables. CRX-10iA, Jaco 2, xArm 6 and GoFa 5: makers'
# data sheets. Manseur & Doty 1989: the arm with 16 real solutions. Puma 560: Corke. UR5: maker.
ARMS = {
    "crx10ia": [
        (0, 0.245, 0, -PI / 2),
        (-PI / 2, 0, 0.54, 0),
        (0, 0, 0, -PI / 2),
        (0, 0.54, 0, PI / 2),
        (0, -0.15, 0, -PI / 2),
        (0, 0.16, 0, 0),
    ],
    "jaco2": [
        (0, 0.2755, 0, PI / 2),
        (-PI / 2, 0, 0.41, PI),
        (PI / 2, -0.0098, 0, PI / 2),
        (0, -0.2073 - BEND, 0, PI / 3),
        (PI, -2 * BEND, 0, PI / 3),
        (0, -0.16 - BEND, 0, PI),
    ],
    "xarm6": [
        (0, 0.267, 0, -PI / 2),
        (-1.3849179, 0, 0.28948866, 0),
        (1.3849179, 0, 0.0775, -PI / 2),
        (0, 0.3425, 0, PI / 2),
        (0, 0, 0.076, -PI / 2),
        (0, 0.097, 0, 0),
    ],
    "gofa5": [
        (0, 0.265, 0, -PI / 2),
        (-PI / 2, 0, 0.444, 0),
        (0, 0, 0.11, -PI / 2),
        (0, 0.47, 0, PI / 2),
        (0, 0, 0.08, -PI / 2),
        (PI, 0.101, 0, 0),
    ],
    "manseur_doty": [
        (0, 0, 0.3, PI / 2),
        (0, 0, 1.0, DEG),
        (0, 0.2, 0, PI / 2),
        (0, 0, 1.5, DEG),
        (0, 0, 0, PI / 2),
        (0, 0, 0, DEG),
    ],
    "ur5": [
        (0, 0.089159, 0, PI / 2),
        (0, 0, -0.425, 0),
        (0, 0, -0.39225, 0),
        (0, 0.10915, 0, PI / 2),
        (0, 0.09465, 0, -PI / 2),
        (0, 0.0823, 0, 0),
    ],
    "puma560": [
        (0, 0, 0, PI / 2),
        (0, 0, 0.4318, 0),
        (0, 0.15005, 0.0203, -PI / 2),
        (0, 0.4318, 0, PI / 2),
        (0, 0, 0, -PI / 2),
        (0, 0, 0, 0),
    ],
}
for _seed in range(8):
    _rng = np.random.default_rng(_seed)
    ARMS[f"random{_seed}"] = [
        (*_rng.uniform((-PI, -0.5, -0.5), (PI, 0.5, 0.5)), _rng.uniform(-PI, PI)) for _ in range(6)
    ]
for _name in ("ur5", "puma560"):
    for _exponent in (12, 9, 6, 4, 3):
        _rng = np.random.default_rng(_exponent)
        ARMS[f"{_name}_1e-{_exponent}"] = [
            tuple(
                x + 10.0**-_exponent * e for x, e in zip(row, _rng.uniform(-1, 1, 4), strict=True)
            )
            for row in ARMS[_name]
        ]


def dh_matrix(theta, d, a, alpha):
    """``Rz(theta) Tz(d) Tx(a) Rx(alpha)`` of angles (m,) as (m, 4, 4)."""
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = math.cos(alpha), math.sin(alpha)
    T = np.zeros((*np.shape(theta), 4, 4))
    T[..., 0, 0], T[..., 0, 1], T[..., 0, 2], T[..., 0, 3] = c, -s * ca, s * sa, a * c
    T[..., 1, 0], T[..., 1, 1], T[..., 1, 2], T[..., 1, 3] = s, c * ca, -c * sa, a * s
    T[..., 2, 1], T[..., 2, 2], T[..., 2, 3], T[..., 3, 3] = sa, ca, d, 1.0
    return T


def forward(rows, q):
    """``T_base_tool`` (m, 4, 4) of configurations (m, 6): the product of the table's rows."""
    T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
    for i, (theta, d, a, alpha) in enumerate(rows):
        T = T @ dh_matrix(q[:, i] + theta, d, a, alpha)
    return T


def links_of(rows):
    """The constant transforms around the joints: links[0] = 1, links[i] = row i at q = 0."""
    return np.array([np.eye(4)] + [dh_matrix(np.float64(row[0]), *row[1:]) for row in rows])


def residuals(T, target):
    """Larger of position and orientation error, (m,)."""
    position = np.linalg.norm(T[:, :3, 3] - target[:, :3, 3], axis=1)
    chord = np.linalg.norm(T[:, :3, :3] - target[:, :3, :3], axis=(1, 2))
    return np.maximum(position, chord / math.sqrt(2.0))


def angular_distance(a, b):
    """Largest joint difference, wrapped, over the last axis."""
    return np.abs((a - b + PI) % (2 * PI) - PI).max(axis=-1)


def solve_poses(rows, poses):
    """Plan an arm and solve poses (m, 4, 4): angles, residuals, counts."""
    m = len(poses)
    q, residual = np.zeros((m, 16, 6)), np.zeros((m, 16))
    count = np.zeros(m, dtype=np.int64)
    solve_general_6r_batch(*plan_general_6r(links_of(rows)), poses, q, residual, count)
    return q, residual, count


def check_sweep(rows, count, seed):
    """Number of random poses whose generating configuration is missing, after all other checks."""
    rng = np.random.default_rng(seed)
    generating = rng.uniform(-PI, PI, (count, 6))
    poses = np.ascontiguousarray(forward(rows, generating))
    q, residual, found = solve_poses(rows, poses)
    live = np.arange(16) < found[:, None]
    assert np.isfinite(q[live]).all()
    independent = residuals(forward(rows, q[live]), np.repeat(poses, found, axis=0))
    assert independent.max() <= 1e-9
    assert np.median(independent) <= 1e-13
    np.testing.assert_allclose(residual[live], independent, atol=1e-12)
    apart = angular_distance(q[:, :, None], q[:, None, :])
    apart[~(live[:, :, None] & live[:, None, :])] = np.inf
    apart[:, np.arange(16), np.arange(16)] = np.inf
    assert apart.min() > 1e-6
    nearest = np.where(live, angular_distance(q, generating[:, None]), np.inf).min(axis=1)
    return int((nearest > 1e-5).sum()), int((found % 2).sum())


@pytest.mark.parametrize("name", ARMS)
def test_generating_configuration_is_found(name):
    """Every random pose's own configuration is among distinct solutions, in even number."""
    misses, odd = check_sweep(ARMS[name], 500, seed=1)
    assert misses == 0
    assert odd == 0


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_generating_configuration_is_found_in_100_000_poses(name):
    """No generating configuration of 100,000 is missing; odd counts are merged branches."""
    misses, odd = check_sweep(ARMS[name], 100_000, seed=77)
    assert misses == 0
    assert odd <= 10


def newton_search(rows, pose, starts, seed):
    """Isolated solutions of one pose by damped Newton from many random seeds, (k, 6)."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-PI, PI, (starts, 6))
    damping = np.full(starts, 1e-2)
    error, J = twist_and_jacobian(rows, q, pose)
    for _ in range(80):
        normal = J.transpose(0, 2, 1) @ J + damping[:, None, None] * np.eye(6)
        step = np.linalg.solve(normal, J.transpose(0, 2, 1) @ error[:, :, None])[:, :, 0]
        step *= np.minimum(1.0, 0.6 / np.abs(step).max(axis=1))[:, None]
        new_error, new_J = twist_and_jacobian(rows, q + step, pose)
        better = (new_error**2).sum(axis=1) < (error**2).sum(axis=1)
        q[better] += step[better]
        error[better], J[better] = new_error[better], new_J[better]
        damping = np.where(better, np.maximum(damping * 0.2, 1e-14), np.minimum(damping * 4, 1e3))
    reached = (np.abs(error).max(axis=1) < 1e-10) & (np.linalg.svd(J)[1][:, -1] > 1e-3)
    distinct = []
    for x in q[reached]:
        if all(angular_distance(x, y) > 1e-4 for y in distinct):
            distinct.append(x)
    return np.array(distinct).reshape(-1, 6)


def twist_and_jacobian(rows, q, pose):
    """Twist to the pose (m, 6), linear over angular, and geometric Jacobian (m, 6, 6)."""
    T = np.broadcast_to(np.eye(4), (len(q), 4, 4))
    frames = []
    for i, (theta, d, a, alpha) in enumerate(rows):
        frames.append(T)
        T = T @ dh_matrix(q[:, i] + theta, d, a, alpha)
    J = np.empty((len(q), 6, 6))
    for i, frame in enumerate(frames):
        J[:, :3, i] = np.cross(frame[:, :3, 2], T[:, :3, 3] - frame[:, :3, 3])
        J[:, 3:, i] = frame[:, :3, 2]
    turn = pose[:3, :3] @ T[:, :3, :3].transpose(0, 2, 1)
    axis = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=1) / 2
    axis -= np.stack([turn[:, 1, 2], turn[:, 2, 0], turn[:, 0, 1]], axis=1) / 2
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, (np.trace(turn, axis1=1, axis2=2) - 1) / 2)
    axis *= (angle / np.maximum(sine, 1e-12))[:, None]
    return np.hstack([pose[:3, 3] - T[:, :3, 3], axis]), J


def check_against_search(rows, configurations, starts):
    """Every isolated solution found from random seeds is among the solver's."""
    poses = np.ascontiguousarray(forward(rows, configurations))
    q, _, count = solve_poses(rows, poses)
    for m, pose in enumerate(poses):
        searched = newton_search(rows, pose, starts, seed=m)
        for x in searched:
            assert angular_distance(q[m, : count[m]], x).min() < 1e-5, configurations[m]
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
    live = np.arange(16) < count[:, None]
    nearest = np.where(live, angular_distance(found, q[:, None]), np.inf).min(axis=1)
    isolated = smallest > 1e-3
    assert isolated.sum() >= 15
    assert (nearest[isolated] < 1e-6).all()


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
    live = np.arange(16) < count[:, None]
    nearest = np.where(live, angular_distance(found, q[:, None]), np.inf).min(axis=1)
    assert nearest.max() < 1e-6
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
    assert independent.max() <= 1e-9
    assert (residual[0, : count[0]] <= 1e-9).all()


def test_one_pose_and_a_batch_agree():
    """The kernel for one pose and that for many return the same numbers."""
    rows = ARMS["gofa5"]
    plan = plan_general_6r(links_of(rows))
    poses = np.ascontiguousarray(forward(rows, np.random.default_rng(3).uniform(-PI, PI, (20, 6))))
    q, residual, count = solve_poses(rows, poses)
    work = make_work_6r()
    for m, pose in enumerate(poses):
        one_q, one_residual = np.zeros((16, 6)), np.zeros(16)
        k = solve_general_6r(*plan, pose, one_q, one_residual, work)
        assert k == count[m]
        np.testing.assert_array_equal(one_q[:k], q[m, :k])
        np.testing.assert_array_equal(one_residual[:k], residual[m, :k])
