"""Where a robot should stand: jobs made so that the best base is known, or that there is none."""

import math

import numpy as np
import pinocchio as pin
import pytest

from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.exceptions import ArgumentError, NoSolverError, PoseError
from dh2urdf.figures import picture_bytes, placement_figure
from dh2urdf.transforms import pose, rot_z, trans
from dh2urdf.workspace import base_map, place
from dh2urdf.workspace.placing import Job

UR5E = Robot.from_dh("ur5e")
DOWN = np.diag([1.0, -1.0, -1.0])


def gantry():
    """Three slides along x, y and z of the base, 2 m, 1 m and 1 m long."""
    rows = (
        DHRow(alpha=math.pi / 2, joint_type="prismatic", lower=0.0, upper=1.0),
        DHRow(theta=math.pi / 2, alpha=math.pi / 2, joint_type="prismatic", lower=0, upper=1.0),
        DHRow(joint_type="prismatic", lower=0.0, upper=2.0),
    )
    return Robot.from_dh(DHTable(rows, "standard", "gantry"))


def pinocchio_jacobian(robot, q):
    """At the tip, in axes of the base."""
    data = robot.model.createData()
    frame = robot.model.getFrameId(robot.tip)
    way = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    return pin.computeFrameJacobian(robot.model, data, q, frame, way)


def points(*places):
    """Poses at places, tool down."""
    return np.stack([pose(DOWN, np.array(p, float)) for p in places])


def test_a_gantry_stands_so_that_the_job_is_in_its_middle():
    """The margin is that of the axis left: 1 less the job's length by the travel, at one base."""
    robot = gantry()
    middle = robot.fk((robot.lower + robot.upper) / 2)[:3, 3]
    corners = [(x, y, z) for x in (3.0, 3.6) for y in (1.0, 1.2) for z in (0.4, 0.6)]
    found = place(robot, points(*corners), height=(-1, 1), yaw=0.0, task="position")
    assert found.found
    assert found.margin == pytest.approx(0.7, abs=2e-3)
    long = int(np.argmax(np.ptp(found.q, axis=0)))
    assert np.ptp(found.q[:, long]) == pytest.approx(0.6, abs=1e-9)
    best = np.array([3.3, 1.1, 0.5]) - middle
    assert abs((np.array([found.x, found.y, found.z]) - best)[np.abs(middle).argmax()]) < 2e-3


def test_a_planar_arm_stands_where_its_jacobian_is_best():
    """One place: by one search over the elbow, the margin is 1 at the distance it says."""
    robot = Robot.from_dh(DHTable((DHRow(a=1.0), DHRow(a=0.7)), "standard", "planar"))
    elbow = np.linspace(0.0, math.pi, 20_001)
    J = robot.jacobian(np.c_[np.zeros_like(elbow), elbow])[:, :2]
    best = elbow[np.linalg.svd(J, compute_uv=False)[:, -1].argmax()]
    distance = math.sqrt(1.49 + 1.4 * math.cos(best))
    found = place(robot, points((5.0, 3.0, 0.0)), task="position", within_limits=False)
    assert found.margin > 0.999
    assert math.hypot(found.x - 5.0, found.y - 3.0) == pytest.approx(distance, abs=0.03)


def test_a_job_made_from_a_base_is_reached_from_that_base_only():
    """Poses at full stretch all around leave little room: the base is found within a centimetre."""
    T_world_base = trans(2.0, -1.0, 0.3) @ rot_z(0.7)
    rng = np.random.default_rng(4)
    q = np.zeros((24, 6))
    q[:, 0] = np.linspace(-math.pi, math.pi, 24, endpoint=False)
    q[:, 1], q[:, 2] = rng.uniform(-0.4, 0.0, 24), 0.12
    q[:, 3:] = rng.uniform(-0.6, 0.6, (24, 3)) - [math.pi / 2, 0.8, 0.0]
    found = place(UR5E, T_world_base @ UR5E.fk(q), height=0.3)
    assert found.found
    assert math.hypot(found.x - 2.0, found.y + 1.0) < 0.05
    again = found.T_world_base @ UR5E.fk(found.q)
    np.testing.assert_allclose(again, T_world_base @ UR5E.fk(q), atol=1e-8)
    assert found.margins.min() == found.margin > 0.0
    assert (found.q >= UR5E.lower).all()
    assert (found.q <= UR5E.upper).all()


def test_a_pose_far_from_the_others_stands_in_the_way():
    """Five poses together and one 3 m away: the one is named, five are reached, none is never."""
    job = points(
        (0, 0, 0.3), (0.1, 0, 0.3), (0.1, 0.1, 0.3), (0, 0.1, 0.3), (0, 0, 0.4), (3, 0, 0.3)
    )
    found = place(UR5E, job)
    assert (found.found, found.missed, found.margin) == (False, (5,), 0.0)
    assert "outside the reach" in found.reasons[0]
    assert np.isnan(found.q[5]).all()
    assert np.isfinite(found.q[:5]).all()
    assert found.margins[:5].min() > 0.0


def test_a_pose_out_of_reach_from_everywhere_is_named_so():
    """A pose 3 m high is in reach of no base on the floor; with the base raised all are reached."""
    job = points((0, 0, 0.3), (0.2, 0, 0.3), (0.1, 0.3, 2.6))
    found = place(UR5E, job)
    assert (found.missed, found.never) == ((2,), (2,))
    assert place(UR5E, job[2:], height=(1.8, 2.2)).found


@pytest.mark.parametrize("seed", range(12, 18))
def test_a_base_between_the_places_of_the_lattice_is_found(seed):
    """Twelve poses of random joint values: few bases reach all, none of the first lattice need."""
    T_world_base = trans(2.0, 1.0, 0.0) @ rot_z(0.7)
    robot = Robot.from_dh("denso_vs060")
    q = np.random.default_rng(seed).uniform(robot.lower, robot.upper, (12, robot.n))
    found = place(robot, T_world_base @ robot.fk(q))
    assert found.found
    assert found.margin > 0.0
    assert found.tried < 60_000


def test_mounting_region_and_yaw_are_kept():
    """Hanging from above, inside the region and the turns asked for; the poses are reached."""
    job = points((0, 0, 0.2), (0.2, 0.1, 0.2))
    region = [[-0.5, 0.0], [0.1, 0.6]]
    found = place(UR5E, job, region=region, height=1.0, yaw=(0.0, 0.5), mount=(math.pi, 0, 0))
    assert found.found
    assert (-0.5 <= found.x <= 0.0, 0.1 <= found.y <= 0.6, 0.0 <= found.yaw <= 0.5) == (True,) * 3
    np.testing.assert_allclose(found.T_world_base[:3, 2], [0, 0, -1], atol=1e-12)
    np.testing.assert_allclose(found.T_world_base @ UR5E.fk(found.q), job, atol=1e-8)


def test_the_margin_is_what_it_is_said_to_be():
    """By NumPy's singular values of Pinocchio's Jacobian, and the joints' distance from limits."""
    for name in ("puma560", "stanford", "ur5e"):
        robot = Robot.from_dh(name)
        job = Job(robot, points((0, 0, 0)), np.eye(4), "pose", True)
        rng = np.random.default_rng(1)
        low, high = robot.lower, robot.upper
        q = low + rng.random((500, robot.n)) * (high - low)
        J = np.stack([pinocchio_jacobian(robot, each) for each in q])
        J[:, :3] /= robot.chain.size
        J[:, :, robot.slides] *= robot.chain.size
        least = np.linalg.svd(J, compute_uv=False)[:, -1] / job.best_singular
        room = (2 * np.minimum(q - low, high - q) / (high - low)).min(axis=1)
        np.testing.assert_allclose(job.margin_of(q), np.minimum(least.clip(0, 1), room), atol=1e-9)


def test_two_searches_give_the_same_bits():
    """The same call finds the same base, whoever asks."""
    job = points((0, 0, 0.3), (0.3, 0.2, 0.2))
    first, second = place(UR5E, job), place(Robot.from_dh("ur5e"), job)
    assert first.T_world_base.tobytes() == second.T_world_base.tobytes()
    assert first.map.margin.tobytes() == second.map.margin.tobytes()


def test_the_inverse_map_of_a_pose_is_the_reach_turned_around():
    """A planar arm reaches a point just from the places of an annulus about it."""
    robot = Robot.from_dh(DHTable((DHRow(a=1.0), DHRow(a=0.7)), "standard", "planar"))
    found = base_map(robot, points((1.0, 2.0, 0.0)), task="position", within_limits=False)
    far = np.hypot(found.x - 1.0, found.y[:, None] - 2.0)
    clear = (np.abs(far - 1.7) > 1e-6) & (np.abs(far - 0.3) > 1e-6)
    np.testing.assert_array_equal((found.reached > 0)[clear], ((far < 1.7) & (far > 0.3))[clear])


def test_of_many_poses_the_fewest_are_missed():
    """Of 120 along a line longer than the arm no base of the lattice misses fewer than are told."""
    job = points(*[(x, 0.0, 0.3) for x in np.linspace(0.0, 2.4, 120)])
    found = place(UR5E, job, region=[[0.0, 2.4], [0.3, 0.5]], yaw=0.0)
    reached = UR5E.ik_batch(np.linalg.inv(found.T_world_base) @ job).count > 0
    assert found.missed == tuple(np.flatnonzero(~reached))
    bases = [trans(x, y, 0.0) for x in found.map.x for y in found.map.y]
    counts = [(UR5E.ik_batch(np.linalg.inv(T) @ job).count == 0).sum() for T in bases]
    assert 0 < len(found.missed) <= min(counts)
    assert not found.never


def test_bad_arguments_are_refused():
    """Each by name."""
    job = points((0, 0, 0.3))
    for wrong, words in (
        ({"region": [[1, 0], [0, 1]]}, "region, x: lower end first, got 1 and 0"),
        ({"height": (1.0, 0.0)}, "height: lower end first, got 1 and 0"),
        ({"height": np.ma.masked_all(())}, "height: expected a number from"),
        ({"yaw": (-6.0, 6.0)}, "one turn"),
        ({"task": "all"}, "task"),
        ({"mount": [0, 0]}, "mount"),
    ):
        with pytest.raises(ArgumentError, match=words):
            place(UR5E, job, **wrong)
    with pytest.raises(ArgumentError, match="poses"):
        place(UR5E, np.eye(4))
    with pytest.raises(PoseError):
        place(UR5E, 2 * job)
    with pytest.raises(NoSolverError, match="task 'position'; it has one for") as told:
        place(Robot.from_dh("franka_fer"), job, task="position")
    assert "\n" not in str(told.value)


def test_progress_of_each_part_rises():
    """Bases, then finer lattices: within a total what is done never falls."""
    job = points(*[(x, 0.0, 0.3) for x in np.linspace(0.0, 1.2, 150)])
    told = []
    place(UR5E, job, yaw=0.0, progress=lambda *step: told.append(step))
    parts = [[step for step in told if step[::2] == key] for key in {each[::2] for each in told}]
    assert {what for what, *_ in told} == {"bases", "finer lattices"}
    for part in parts:
        done = [step[1] for step in part]
        assert done == sorted(done)


def test_the_picture_is_the_same_each_time():
    """A map of bases with poses in and out of reach, two arms side by side."""
    job = points((0, 0, 0.3), (0.2, 0.1, 0.3), (2.5, 0, 0.3))
    arms = [UR5E, Robot.from_dh("puma560")]
    placed = [(arm, place(arm, job, yaw=0.0)) for arm in arms]
    pictures = [picture_bytes(placement_figure(job, placed), "svg") for _ in range(2)]
    assert pictures[0] == pictures[1]
    assert b"no base found that reaches all 3 poses" in pictures[0]
    with pytest.raises(ArgumentError):
        placement_figure(job, [])
