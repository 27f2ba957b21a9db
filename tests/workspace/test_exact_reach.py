"""Exact reach: extremes, sections and volumes against formulas and random joint values."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize

from dh2urdf import DHConvention, DHRow, DHTable, Robot, list_tables
from dh2urdf.exceptions import ArgumentError
from dh2urdf.workspace import counts_at, extreme_reach, reach_map, reach_section, reach_volume

PUMA = Robot.from_dh("puma560")
A2, D3, FOREARM = 0.4318, 0.15005, math.hypot(0.0203, 0.4318)


def arm(*rows, name="arm"):
    """A robot of standard rows."""
    return Robot.from_dh(DHTable(rows, "standard", name))


def torus(**limits):
    """A wrist point on a circle about a circle: radius 2, section an annulus of 0.6 and 1.4."""
    rows = DHRow(a=2.0, alpha=math.pi / 2), DHRow(a=1.0, **limits), DHRow(a=0.4)
    return arm(*rows, name="torus")


def wrist_points(robot, q):
    """Points of axis 4 nearest to axis 5 (k, 3)."""
    axis_4 = 3 if robot.table.convention is DHConvention.STANDARD else 4
    frames = robot.frames(q)[:, axis_4 : axis_4 + 2]
    (z, p), (w, o) = ((frames[:, k, :3, 2], frames[:, k, :3, 3]) for k in (0, 1))
    cosine = np.einsum("ki,ki->k", z, w)[:, None]
    along = np.einsum("ki,ki->k", z - w * cosine, o - p)[:, None]
    return p + along / (1.0 - cosine**2) * z


def sampled(robot, section, count=20_000, within_limits=True):
    """Radius and height of the wrist point at random joint values, by forward kinematics."""
    rng = np.random.default_rng(5)
    bounded = np.isfinite(robot.upper - robot.lower) & within_limits
    low, high = np.where(bounded, robot.lower, -np.pi), np.where(bounded, robot.upper, np.pi)
    q = low + rng.random((count, robot.n)) * (high - low)
    points = robot.fk(q)[:, :3, 3] if section.point == "tip" else wrist_points(robot, q)
    local = (points - section.T_base_axis[:3, 3]) @ section.T_base_axis[:3, :3]
    return np.stack([np.hypot(local[:, 0], local[:, 1]), local[:, 2]], axis=1)


def test_reach_of_a_planar_arm_is_the_annulus():
    """Sum and difference of two links, for three links the largest less the others."""
    two, three = arm(DHRow(a=1.0), DHRow(a=0.7)), arm(*(DHRow(a=a) for a in (1.0, 0.4, 0.3)))
    assert extreme_reach(two, within_limits=False).distance == pytest.approx((0.3, 1.7), abs=1e-9)
    assert extreme_reach(three, within_limits=False).distance == pytest.approx((0.3, 1.7), abs=1e-9)


def test_limits_of_a_planar_elbow_bound_its_reach():
    """With the elbow between 30 and 60 degrees both extremes are at its limits."""
    elbow = DHRow(a=0.7, lower=math.radians(30), upper=math.radians(60))
    found = extreme_reach(arm(DHRow(a=1.0), elbow))
    ends = [math.sqrt(1.49 + 1.4 * math.cos(math.radians(d))) for d in (60, 30)]
    assert found.distance == pytest.approx(ends, abs=1e-9)
    np.testing.assert_allclose(found.q["distance"][:, 1], np.radians([60, 30]), atol=1e-12)


def test_reach_of_the_puma_is_its_formula():
    """The shoulder's offset squared and upper arm plus and less forearm squared."""
    found = extreme_reach(PUMA, "wrist", within_limits=False)
    ends = [math.hypot(D3, A2 + sign * FOREARM) for sign in (-1, 1)]
    assert found.distance == pytest.approx(ends, abs=1e-9)
    assert found.radius == pytest.approx((D3, ends[1]), abs=1e-9)
    assert found.height == pytest.approx((-A2 - FOREARM, A2 + FOREARM), abs=1e-9)
    np.testing.assert_allclose(found.centre, [0.0, 0.0, 26.45 * 0.0254], atol=1e-12)


def test_reach_of_the_ur5_is_its_formula():
    """Stretched, the tip is off by d4 and d6 across, a2, a3 and d5 along; joint 5 alone is left."""
    found = extreme_reach(Robot.from_dh("ur5"), within_limits=False)
    a2, a3, d4, d5, d6 = 0.425, 0.39225, 0.10915, 0.09465, 0.0823
    t5 = np.linspace(-np.pi, np.pi, 2_000_001)
    along = a2 + a3 + np.hypot(d5, d6 * np.sin(t5))
    assert found.distance[1] == pytest.approx(np.hypot(along, d4 + d6 * np.cos(t5)).max(), abs=1e-9)
    assert found.radius[0] == pytest.approx(d4 - d6, abs=1e-9)


@pytest.mark.parametrize("name", ["franka_fer", "ur5", "so101", "stanford"])
def test_no_configuration_reaches_farther_or_nearer(name):
    """Random configurations within the limits stay inside; those told reach just so far."""
    robot = Robot.from_dh(name)
    found = extreme_reach(robot)
    rng = np.random.default_rng(2)
    q = robot.lower + rng.random((20_000, robot.n)) * (robot.upper - robot.lower)
    far = np.linalg.norm(robot.fk(q)[:, :3, 3] - found.centre, axis=1)
    assert found.distance[0] <= far.min() + 1e-9
    assert far.max() - 1e-9 <= found.distance[1]
    ends = robot.fk(found.q["distance"])[:, :3, 3] - found.centre
    np.testing.assert_allclose(np.linalg.norm(ends, axis=1), found.distance, atol=1e-12)
    assert (found.q["distance"] >= robot.lower).all()
    assert (found.q["distance"] <= robot.upper).all()


def random_arm(seed):
    """Three to six turning joints with limits; lengths and twists that makers use, or any."""
    rng = np.random.default_rng(seed)
    rows = [
        DHRow(
            a=rng.choice([0.0, 0.1, 0.3, rng.uniform(0.0, 0.5)]),
            d=rng.choice([0.0, 0.1, rng.uniform(0.0, 0.5)]),
            alpha=rng.choice([0.0, math.pi / 2, -math.pi / 2]),
            lower=-rng.uniform(0.3, 3.0),
            upper=rng.uniform(0.3, 3.0),
        )
        for _ in range(int(rng.integers(3, 7)))
    ]
    return arm(*rows)


def bounded_search(robot, centre, sign):
    """Smallest (sign 1) or largest (-1) distance by SciPy's L-BFGS-B from six starts."""

    def signed(q):
        gap = robot.fk(q)[:3, 3] - centre
        return sign * gap @ gap / 2, sign * gap @ robot.jacobian(q)[:3]

    rng = np.random.default_rng(8)
    q = robot.lower + rng.random((4_000, robot.n)) * (robot.upper - robot.lower)
    at = rng.random(q.shape)
    q = np.where(at < 0.15, robot.lower, np.where(at > 0.85, robot.upper, q))
    order = np.argsort(sign * np.linalg.norm(robot.fk(q)[:, :3, 3] - centre, axis=1))
    bounds = list(zip(robot.lower, robot.upper, strict=True))
    options = {"ftol": 1e-16, "gtol": 1e-11}
    ends = [
        minimize(signed, q[i], jac=True, bounds=bounds, method="L-BFGS-B", options=options).fun
        for i in order[[0, 2, 10, 50, 200, 1000]]
    ]
    return math.sqrt(2 * max(sign * min(ends), 0.0))


@pytest.mark.parametrize("which", ["stanford", "omron_cobra600", *range(20)])
def test_a_bounded_search_finds_nothing_farther_or_nearer(which):
    """SciPy's, within the limits, from starts on and between them: to a ten-millionth."""
    robot = Robot.from_dh(which) if isinstance(which, str) else random_arm(which)
    found = extreme_reach(robot)
    nearest, farthest = (bounded_search(robot, found.centre, sign) for sign in (1, -1))
    assert found.distance[0] <= nearest + 1e-7
    assert found.distance[1] >= farthest - 1e-7


def test_the_stanford_arm_comes_nearest_with_two_joints_at_limits():
    """The slide drawn in and joint 6 at its limit: 0.3237 m from the shoulder, no start nearby."""
    robot = Robot.from_dh("stanford")
    found = extreme_reach(robot)
    q = np.array([1.12039, 0.587277, 0.3048, 0.0, math.pi / 2, -2.96706])
    assert (robot.lower - 1e-5 <= q).all()
    assert (q <= robot.upper + 1e-5).all()
    told = float(np.linalg.norm(robot.fk(q)[:3, 3] - found.centre))
    assert found.distance[0] == pytest.approx(told, abs=1e-7)


@pytest.mark.parametrize(
    ("name", "sign"), [("kuka_kr16_2", -1.0), ("kinova_gen3", -1.0), ("puma560", 1.0)]
)
def test_heights_are_up_where_axis_1_points_down(name, sign):
    """Lowest and highest of random places along z of the base are inside those told as above."""
    robot = Robot.from_dh(name)
    found = extreme_reach(robot)
    assert found.axis == pytest.approx(robot.chain.axes[0], abs=1e-12)
    assert sign * found.axis[2] > 0.0
    low, high = found.above
    z = np.sort(found.places["height"][:, 2] - found.centre[2])
    np.testing.assert_allclose(z, (low, high), atol=1e-9)
    q = robot.lower + np.random.default_rng(1).random((5_000, robot.n)) * (
        robot.upper - robot.lower
    )
    heights = robot.fk(q)[:, 2, 3] - found.centre[2]
    assert low - 1e-9 <= heights.min() < heights.max() <= high + 1e-9


def test_heights_of_an_arm_that_lies_are_along_axis_1():
    """Axis 1 across z of the base, as the gantry's slide: nothing is told as above."""
    found = extreme_reach(Robot.from_dh("gantry"))
    np.testing.assert_allclose(found.axis, [1.0, 0.0, 0.0], atol=1e-12)
    assert found.above is None


def test_section_of_a_torus_has_its_void():
    """An annulus around 2 m: outline and void on circles, area, volume and what it holds."""
    found = reach_section(torus(), within_limits=False)
    outline, void = found.rings
    assert (outline.area > 0.0, void.area < 0.0, found.voids) == (True, True, (void,))
    for ring, radius in ((outline, 1.4), (void, 0.6)):
        off = np.hypot(ring.points[:, 0] - 2.0, ring.points[:, 1])
        np.testing.assert_allclose(off, radius, atol=1e-9)
        assert set(ring.kinds) == {"fold"}
    assert found.area == pytest.approx(math.pi * (1.4**2 - 0.6**2), abs=1e-4)
    volume = reach_volume(torus(), found)
    exact = 2 * math.pi * 2.0 * math.pi * (1.4**2 - 0.6**2)
    assert abs(volume.value - exact) <= volume.bound < 1e-3
    places = [(2.0, 0.0), (2.5, 0.0), (2.7, 0.0), (3.5, 0.0), (0.0, 0.0), (2.0, -1.3)]
    assert found.holds(places).tolist() == [False, False, True, False, False, True]


def test_limits_cut_the_torus():
    """Joint 2 within a quarter turn: its limits are part of the boundary, all of it on them."""
    robot = torus(lower=0.0, upper=math.pi / 2)
    found = reach_section(robot)
    kinds = {kind for ring in found.rings for kind in ring.kinds}
    assert kinds == {"fold", "joint_2 lower", "joint_2 upper"}
    for ring in found.rings:
        r, z = ring.points.T
        off = {"fold": np.minimum(*(abs(np.hypot(r - 2, z) - b) for b in (0.6, 1.4)))}
        off["joint_2 lower"] = abs(np.hypot(r - 3, z) - 0.4)
        off["joint_2 upper"] = abs(np.hypot(r - 2, z - 1) - 0.4)
        assert max(off[kind][i] for i, kind in enumerate(ring.kinds)) < 1e-9
    places = sampled(robot, found)
    assert found.holds(places).mean() > 0.999
    near = np.linalg.norm(found.rings[0].through - places[~found.holds(places), None], axis=-1)
    assert near.min(axis=1, initial=1.0).max(initial=0.0) < 0.01


def test_volume_of_the_puma_is_that_of_its_shells():
    """Two spheres about the offset shoulder, 4/3 pi (R^3 - r^3) of upper arm and forearm."""
    found = reach_volume(PUMA, within_limits=False)
    exact = 4 / 3 * math.pi * ((A2 + FOREARM) ** 3 - abs(A2 - FOREARM) ** 3)
    assert abs(found.value - exact) <= found.bound < 1e-5


def test_volume_of_a_scara_whose_first_joint_does_not_turn_around():
    """Against random places: the angle is missing where neither elbow brings joint 1 there."""
    robot = Robot.from_dh("omron_cobra600")
    found = reach_volume(robot)
    rng = np.random.default_rng(0)
    p = rng.uniform([-0.61, -0.61, 0], [0.61, 0.61, 1], (40_000, 3))
    T = np.tile(robot.chain.tool, (len(p), 1, 1))
    T[:, :2, 3], T[:, 2, 3] = p[:, :2], robot.fk((robot.lower + robot.upper) / 2)[2, 3]
    hit = robot.ik_batch(T).count > 0
    box = 1.22**2 * (robot.upper[2] - robot.lower[2])
    noise = 4 * box * math.sqrt(hit.mean() * (1 - hit.mean()) / len(p))
    assert abs(found.value - box * hit.mean()) < noise + found.bound
    assert found.bound < 2e-3 * found.value


@pytest.mark.parametrize(("name", "limits"), [("puma560", True), ("denso_vs6556", True)])
def test_sections_hold_all_that_is_reached_and_no_more(name, limits):
    """Random joint values fall inside, and inverse kinematics finds none beside the boundary."""
    robot = Robot.from_dh(name)
    found = reach_section(robot, within_limits=limits)
    size = robot.chain.size
    places = sampled(robot, found, within_limits=limits)
    assert (~found.holds(places)).mean() < 2e-3
    ring = found.rings[0]
    start, end = ring.points[:-1], ring.points[1:]
    length = np.linalg.norm(end - start, axis=1, keepdims=True)
    out = np.c_[(end - start)[:, 1], -(end - start)[:, 0]] / np.maximum(length, 1e-300)
    for side, all_in in ((-1, True), (1, False)):
        spots = ((start + end) / 2 + side * 1e-3 * size * out)[length[:, 0] > 1e-9]
        inside = found.holds(spots)
        assert inside.mean() > 0.95 if all_in else inside.mean() < 0.05


def test_the_section_agrees_with_the_solver_of_six_joints():
    """A place is held just where some orientation puts a wrist there, but for the boundary."""
    found = reach_section(PUMA, within_limits=False)
    rng = np.random.default_rng(3)
    spots = rng.uniform([0.0, -0.9], [0.9, 0.9], (4_000, 2))
    points = np.c_[spots[:, 0], np.zeros(len(spots)), spots[:, 1]] + found.T_base_axis[:3, 3]
    reached = counts_at(PUMA, points, np.diag([1.0, -1.0, -1.0]), False) > 0
    edge = np.linalg.norm(found.rings[0].points[::4, None] - spots, axis=-1).min(axis=0) < 0.01
    np.testing.assert_array_equal(found.holds(spots)[~edge], reached[~edge])


def test_the_section_agrees_with_the_map_within_a_voxel():
    """Of the Puma, whose tip is its wrist point: voxels are reached just where the section is."""
    found, step = reach_section(PUMA), 0.05
    region = [[-0.95, 0.95], [0.0, step], [-0.3, 1.6]]
    share = reach_map(PUMA, step=step, orientations=120, region=region).share.isel(y=0)
    x, z = (a.ravel() for a in np.meshgrid(share.x, share.z, indexing="ij"))
    r = np.hypot(x, float(share.y))
    spots = np.c_[r, z - found.T_base_axis[2, 3]]
    corners = np.concatenate([ring.through for ring in found.rings])
    edge = np.linalg.norm(corners[::4, None] - spots, axis=-1).min(axis=0) < step
    reached = share.values.ravel() > 0.0
    np.testing.assert_array_equal(reached[~edge], found.holds(spots)[~edge])
    assert 0.1 < reached.mean() < 0.9


def test_arms_without_a_section_say_why():
    """Seven joints, a first joint that slides, a point that stays on a surface, endless slides."""
    cases = {"franka_fer": "no wrist point", "gantry": "turns", "rpr_new_frame": "on a surface"}
    for name, words in cases.items():
        with pytest.raises(ArgumentError, match=words):
            reach_section(Robot.from_dh(name))
    endless = arm(DHRow(alpha=1.0), DHRow(alpha=1.0), DHRow(joint_type="prismatic"))
    with pytest.raises(ArgumentError, match="slides without limits"):
        extreme_reach(endless)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", list_tables())
def test_sections_of_all_arms_hold_random_places(name):
    """Every table that ships and has a section, with limits and without."""
    robot = Robot.from_dh(name)
    for limits in (False, True):
        try:
            found = reach_section(robot, within_limits=limits)
        except ArgumentError:
            continue
        if limits or not robot.slides.any():
            places = sampled(robot, found, within_limits=limits)
            assert (~found.holds(places)).mean() < 3e-3
        ends = extreme_reach(robot, "wrist", within_limits=limits)
        corners = np.concatenate([ring.points for ring in found.rings])
        for k, each in enumerate((ends.radius, ends.height)):
            low, high = corners[:, k].min(), corners[:, k].max()
            assert (low, high) == pytest.approx(each, abs=1e-5 * robot.chain.size)
