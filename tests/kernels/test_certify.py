"""Certification: residual, polishing, clustering, limits."""

import math

import numpy as np
import pytest
from margins import assert_margin

from dh2urdf.kernels.certificate.certify import finish_pose
from dh2urdf.kernels.newton.steps import pose_residual, work_array

HALF_PI = math.pi / 2
PUMA = ((0, 0, HALF_PI), (0, 0.4318, 0), (0.15005, 0.0203, -HALF_PI), (0.4318, 0, HALF_PI))
PUMA += ((0, 0, -HALF_PI), (0.0563, 0, 0))


def dh_links(rows):
    """Links of revolute standard DH rows (d, a, alpha), written by hand."""
    links = [np.eye(4)]
    for d, a, alpha in rows:
        c, s = math.cos(alpha), math.sin(alpha)
        links.append(np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1.0]]))
    return np.stack(links)


def fk(links, q, slides=None):
    """Product of the chain, independent of the kernels."""
    T = links[0]
    for i, qi in enumerate(q):
        Z = np.eye(4)
        if slides is not None and slides[i]:
            Z[2, 3] = qi
        else:
            Z[:2, :2] = [[math.cos(qi), -math.sin(qi)], [math.sin(qi), math.cos(qi)]]
        T = T @ Z @ links[i + 1]
    return T


def revolute(n, lower=-math.inf, upper=math.inf):
    joints = np.zeros((n, 3))
    joints[:, 1], joints[:, 2] = lower, upper
    return joints


def finish(links, joints, T, candidates, *, within_limits=True, residual=None):
    q = np.array(candidates, float)
    k, n = q.shape
    residual = np.full(k, -1.0) if residual is None else np.array(residual, float)
    branch, free = np.arange(k), np.zeros(k, np.int64)
    work = work_array(n)
    arm, rows = (links, joints), (q, residual, branch, free)
    count = finish_pose(arm, np.ascontiguousarray(T), within_limits, *rows, k, work)
    return q[:count], residual[:count], branch[:count]


def rotation_about(axis, angle):
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


@pytest.mark.parametrize("angle", [0.0, 1e-15, 1e-9, 1e-3, 1.0])
def test_residual_is_the_larger_of_distance_and_sine_of_the_angle(angle):
    """A turn by some angle and a shift by half of it measure as the sine of that angle."""
    links = dh_links(PUMA)
    q = np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8])
    T = fk(links, q)
    T[:3, :3] = rotation_about([1, 2, 3], angle) @ T[:3, :3]
    T[:3, 3] += angle / 2 * np.array([0.6, 0.0, 0.8])
    found = pose_residual((links, revolute(6)), T, q)
    assert found == pytest.approx(math.sin(angle), abs=3e-16, rel=1e-9)


def test_residual_of_an_orientation_that_is_turned_round_is_pi():
    """Half a turn has sine 0 and is not mistaken for the target."""
    links = dh_links(PUMA)
    q = np.zeros(6)
    T = fk(links, q)
    T[:3, :3] = rotation_about([1, 2, 3], math.pi) @ T[:3, :3]
    assert pose_residual((links, revolute(6)), T, q) == math.pi


@pytest.mark.parametrize("noise", [1e-12, 1e-8, 1e-4, 1e-2])
def test_polishing_reaches_rounding_from_nearby(noise):
    """Candidates off by up to 0.01 rad converge to the generating configuration."""
    rng = np.random.default_rng(1)
    links, joints = dh_links(PUMA), revolute(6)
    residuals, away = np.empty(300), np.empty((300, 6))
    for i in range(300):
        q = rng.uniform(-2, 2, 6)
        q[2], q[4] = rng.uniform(-1.0, 1.0), rng.uniform(0.3, 2.5)
        T = fk(links, q)
        found, residual, _ = finish(links, joints, T, [q + rng.uniform(-noise, noise, 6)])
        assert len(found) == 1
        residuals[i], away[i] = residual[0], np.abs(found[0] - q)
    # 1e-13 is where Newton's method stops (newton.POLISH), wherever it then is.
    assert_margin(residuals, 1e-13, quantile=0.95)
    assert_margin(away, 1e-11, quantile=0.95)


def test_polishing_a_sliding_joint():
    """A prismatic joint in the chain is polished in metres."""
    links = dh_links(PUMA)
    joints = revolute(6)
    joints[2, 0] = 1.0
    slides = joints[:, 0] != 0
    q = np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8])
    T = fk(links, q, slides)
    found, residual, _ = finish(links, joints, T, [q + 1e-3])
    assert_margin(residual, 1e-13)
    assert_margin(np.abs(found[0] - q), 1e-12)


def test_duplicates_are_one_and_the_best_stays():
    """Two copies a whole turn and 1e-8 apart are returned once, with the smaller residual."""
    links, joints = dh_links(PUMA), revolute(6)
    q = np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8])
    copies = [q + 1e-8, q + 2 * math.pi, q - 1e-8]
    found, residual, _ = finish(links, joints, fk(links, q), copies, residual=[2e-10, -1.0, -1.0])
    assert len(found) == 1
    assert_margin(residual, 1e-13)
    assert_margin(np.abs(found[0] - q), 1e-12)


def test_distinct_solutions_are_kept():
    """The two wrist branches of a Puma, far apart, are both returned in order."""
    links, joints = dh_links(PUMA), revolute(6)
    q = np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8])
    flipped = q + np.array([0, 0, 0, math.pi, -1.4, math.pi])
    found, _, branch = finish(links, joints, fk(links, q), [q, flipped])
    assert list(branch) == [0, 1]
    assert np.all(np.abs(found) <= math.pi)


def test_a_wrong_candidate_is_dropped():
    """A configuration of another pose does not come back, nor anything made from it."""
    links, joints = dh_links(PUMA), revolute(6)
    q = np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8])
    T = fk(links, q)
    T[:3, 3] *= 3.0
    assert len(finish(links, joints, T, [q, np.zeros(6)])[0]) == 0


@pytest.mark.parametrize(
    ("lower", "upper", "expected"),
    [
        (-math.inf, math.inf, 0.3),
        (5.0, 8.0, 0.3 + 2 * math.pi),
        (-4 * math.pi, 0.0, 0.3 - 2 * math.pi),
        (-math.inf, -20.0, 0.3 - 8 * math.pi),
        (20.0, math.inf, 0.3 + 8 * math.pi),
        (0.3, 1.0, 0.3),
        (0.3 + 1e-12, 1.0, 0.3 + 1e-12),
        (0.31, 1.0, None),
        (0.3 + 1e-6, 1.0, None),
    ],
)
def test_turns_into_limits(lower, upper, expected):
    """An angle comes back in the turn nearest to the middle of its range, or not at all."""
    links, joints = dh_links(PUMA), revolute(6)
    joints[0, 1:] = lower, upper
    q = np.array([0.3, -0.4, 0.5, 0.6, 0.7, 0.8])
    found, residual, _ = finish(links, joints, fk(links, q), [q])
    if expected is None:
        assert len(found) == 0
        assert len(finish(links, joints, fk(links, q), [q], within_limits=False)[0]) == 1
    else:
        assert found[0, 0] == pytest.approx(expected, abs=1e-14)
        assert lower <= found[0, 0] <= upper
        assert residual[0] <= 2e-12
