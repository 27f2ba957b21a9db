"""Ranges, seeds and turns of every kind: what is returned was measured, nothing foreign raised."""

import time
from dataclasses import replace

import numpy as np
import pytest
from hostile import hostile, outcome
from hypothesis import strategies as st

import dh2urdf
from dh2urdf.bounds import ANGLE, LENGTH
from dh2urdf.dh import DHRow, DHTable, JointType
from dh2urdf.exceptions import ArgumentError, ConfigurationError, Dh2UrdfError, NoSolutionError

SEVEN = ["franka_fer", "xarm7", "kinova_gen3", "kuka_iiwa7"]

RANGES = [(3.5, 5.0), (-5.0, -3.5), (20.0, 25.0), (-7.0, 7.0), (1000.0, 1001.0), (0.5, 0.50001)]


def with_range(name, joint, lower, upper):
    """A shipped arm with other limits of one joint."""
    table = dh2urdf.load_table(name)
    rows = list(table.rows)
    at = [i for i, row in enumerate(rows) if row.is_joint][joint]
    rows[at] = replace(rows[at], lower=lower, upper=upper)
    return dh2urdf.Robot.from_dh(replace(table, rows=tuple(rows)))


TURNED = ["planar_rr", "puma560", "ur5", "stanford", "xarm5", "fanuc_crx10ia"]


def far_off(robot, q, T):
    """Largest difference of the table's own product from a pose."""
    return np.abs(robot.table.fk(robot.chain_configuration(q)) - T).max()


def apart(a, b):
    """Joint distance without full turns."""
    return np.abs(np.remainder(a - b + np.pi, 2.0 * np.pi) - np.pi).max(axis=-1)


@pytest.mark.parametrize("bounds", RANGES)
@pytest.mark.parametrize("name", SEVEN)
def test_seven_joints_take_any_range(name, bounds):
    """With a joint's range anywhere the seed is found, held or not, within limits and intervals."""
    for joint in (0, 3, 6):
        robot = with_range(name, joint, *bounds)
        q = robot.random_configuration(joint)
        T = robot.table.fk(q)
        found = robot.ik(T, seed=q)
        assert np.abs(found[0] - q).max() < 1e-5
        assert len(robot.ik(T)) > 0
        assert apart(robot.ik(T, seed=q, locked={joint: float(q[joint])}).q, q).min() < 1e-5
        for row in found.q:
            assert far_off(robot, row, T) < 1e-9
            assert (row >= robot.lower - 1e-9).all()
            assert (row <= robot.upper + 1e-9).all()
        swept = q[robot.solver.joint]
        assert any(a - 1e-7 <= swept <= b + 1e-7 for a, b in robot.ik_intervals(T))


@pytest.mark.parametrize("upper", [1e1, 1e3, ANGLE])
@pytest.mark.parametrize("name", TURNED)
def test_the_residual_is_that_of_the_turn_that_is_returned(name, upper):
    """Limits turns away give configurations that reach the pose as well as their residual says."""
    robot = with_range(name, 0, 0.98 * upper - 7.0, upper)
    for k in range(5):
        q = robot.random_configuration(k)
        T = robot.table.fk(q)
        found = robot.ik(T)
        assert apart(found.q, q).min() < 1e-5
        for row, residual in zip(found.q, found.residual, strict=True):
            D = robot.table.fk(row) - T
            true = max(np.linalg.norm(D[:3, 3]), np.abs(D[:3, :3]).max() / 2.0)
            assert true <= residual + 1e-14
        for other in (robot.ik(T, seed=q), robot.ik_batch(T[None])[0]):
            assert (other.verify() <= 1e-9).all()
            assert np.abs(other.residual - other.verify()).max() <= 1e-14


@pytest.mark.parametrize("task", ["pose", "position", "position+axis"])
def test_solutions_towards_a_far_seed_are_measured_there(task):
    """A seed thousands of turns away is reached with the residual that it has there."""
    for name in ("puma560", "planar_rr", "franka_fer", "omron_cobra600", "xarm5"):
        robot = dh2urdf.Robot.from_dh(name)
        T = robot.fk(robot.random_configuration(3))
        seed = np.full(robot.n, 0.9 * ANGLE)
        try:
            found = robot.ik(T, seed=seed, within_limits=False, task=task)
        except dh2urdf.exceptions.NoSolverError:
            continue
        assert len(found) > 0
        assert (found.residual <= 1e-9).all()
        assert np.abs(found.verify() - found.residual).max() < 1e-10


BIG = st.floats(allow_nan=True, allow_infinity=True) | st.sampled_from([1e5, 1e9, 1e18, 1e300])


SEEDED = st.sampled_from(["puma560", "stanford", "xarm5", "planar_rr"])


@hostile(name=SEEDED, value=BIG, at=st.integers(0, 5))
def test_any_seed_is_answered_or_refused(name, value, at):
    """A seed, start or configuration beyond its bound is one error that names value and bound."""
    robot = dh2urdf.Robot.from_dh(name)
    q = np.zeros(robot.n)
    q[at % robot.n] = value
    T = robot.fk(np.full(robot.n, 0.3))
    bound = LENGTH if robot.slides[at % robot.n] else ANGLE
    nearest = robot.ik(T, within_limits=False).nearest
    for call in (
        lambda: robot.ik(T, seed=q, within_limits=False).residual,
        lambda: robot.ik_path(T[None], start=q, within_limits=False),
        lambda: robot.ik_numeric(T, seed=q, within_limits=False, starts=2).residual,
        lambda: nearest(q),
        lambda: robot.ik(T, locked={at % robot.n: value}, within_limits=False).residual,
    ):
        answer = outcome(call)
        refused = isinstance(answer, Dh2UrdfError)
        assert refused == (not abs(value) <= bound)
        if refused:
            assert isinstance(answer, ConfigurationError)
            assert f"[{at % robot.n}]" in str(answer)
            assert not str(answer).endswith("allows it")


def test_more_turns_than_can_be_listed_are_refused():
    """turns='all' with limits of 1e5 rad says how many there are, before it takes memory."""
    table = dh2urdf.load_table("puma560")
    rows = tuple(replace(row, lower=-ANGLE, upper=ANGLE) for row in table.rows)
    robot = dh2urdf.Robot.from_dh(replace(table, rows=rows))
    T = robot.fk(np.full(6, 0.4))
    start = time.monotonic()
    with pytest.raises(ArgumentError, match="at most 100000"):
        robot.ik(T, turns="all")
    assert robot.ik_path(T[None]).continuous
    assert time.monotonic() - start < 5.0
    few = with_range("puma560", 0, -1000.0, 1000.0)
    found = few.ik(T, turns="all")
    assert len(found) > 300
    assert (found.verify() <= 1e-9).all()


def test_more_intervals_than_can_be_tried_are_refused():
    """Intervals over a range of 1e5 rad say how many values that takes."""
    robot = with_range("franka_fer", 6, -ANGLE, ANGLE)
    with pytest.raises(ArgumentError, match="within_limits=False"):
        robot.ik_intervals(robot.fk(np.full(7, 0.4)))


def test_nearest_of_nothing_is_an_error_of_the_package():
    """Choosing from an empty result raises one error, which is a LookupError too."""
    robot = dh2urdf.Robot.from_dh("puma560")
    T = np.eye(4)
    T[:3, 3] = 9.0
    for found in (robot.ik(T), robot.ik_numeric(T, starts=2)):
        with pytest.raises(NoSolutionError, match="no solution"):
            found.nearest(np.zeros(6))
    assert issubclass(NoSolutionError, (LookupError, Dh2UrdfError))


TASKS = ["pose", "position", "position+axis"]


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("name", dh2urdf.list_tables())
def test_every_arm_answers_every_task_or_says_why_not(name, task):
    """Single, seeded, batch and path: an answer that reaches the task, or NoSolverError."""
    robot = dh2urdf.Robot.from_dh(name)
    q = robot.random_configuration(1)
    T = robot.fk(q)
    found = outcome(robot.ik, T, task=task)
    if isinstance(found, Dh2UrdfError):
        assert isinstance(found, dh2urdf.exceptions.NoSolverError)
        return
    batch = robot.ik_batch(np.stack([T, T]), task=task)
    near = robot.ik(T, task=task, seed=q)
    assert np.abs(near.q - q).max(axis=1).min() < 1e-4
    for some in (found, near, batch[1]):
        assert len(some) > 0
        for row in some.q:
            D = robot.table.fk(robot.chain_configuration(row)) - T
            reached = {"pose": D[:3], "position": D[:3, 3], "position+axis": D[:3, 2:]}
            assert np.abs(reached[task]).max() < 2e-9
    assert not robot.ik_path(np.stack([T, T]), task=task, start=q).unreachable
    assert robot.why_unreachable(T, task=task) == ""


def test_what_no_held_value_reaches_is_given_up_in_time():
    """Twists of 1e-7, one joint held, two to spare: an answer, not a search at every value."""
    rows = [(0.3, 0.0, 0.3, 1e-7), (0.0, 0.3, 0.0, 1e-7), (np.pi / 2, 123.4, 1e-7, 0.0)]
    rows += [(np.pi / 2, -1.35, 1.73, 1e-7), (0.3, 0.0, 0.17, 1e-7)]
    made = [DHRow(*row) for row in rows]
    made.insert(1, DHRow(np.pi / 2, 0.0, 0.63, np.pi, JointType.PRISMATIC))
    robot = dh2urdf.Robot.from_dh(DHTable(tuple(made), "standard"))
    T = robot.fk(robot.random_configuration(0))
    T[:3, 3] += 1e3
    assert not outcome(robot.ik, T, task="position+axis", locked={0: 0.0}, within_limits=False)


def test_a_pose_that_is_off_by_little_of_a_vast_arm_is_given_up_in_time():
    """A kilometre beyond an arm of 2,400 km, two joints to spare: no search at every value."""
    rows = [(0.0, 0.0, -0.5, 0.0), (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, -0.5, 0.0)]
    rows += [(0.0, 0.0, 0.0, -np.pi / 2), (0.3, -0.8185393711526021, 0.0, np.pi)]
    made = [DHRow(*row) for row in [*rows, (-np.pi / 2, 2436257.0, -0.5, 1e-12)]]
    robot = dh2urdf.Robot.from_dh(DHTable(tuple(made), "standard"))
    q = robot.random_configuration(0)
    T = robot.fk(q)
    T[:3, 3] += 1e3
    assert not outcome(robot.ik, T, task="position+axis", seed=q)


LENGTHS = st.sampled_from([0.0, 0.3, -0.5, 2436257.0, 1e-7, 1e9, 123.4]) | st.floats(-2.0, 2.0)
TWISTS = st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, 1e-7, 1e-12, 0.3])
ROW = st.tuples(st.sampled_from("RRRP"), TWISTS, LENGTHS, LENGTHS, TWISTS)
FAR = st.sampled_from([0.0, 1.0, 1e3, 1e12])


@hostile(rows=st.lists(ROW, min_size=1, max_size=6), far=FAR, task=st.sampled_from(TASKS))
def test_any_chain_is_answered_or_refused(rows, far, task):
    """Chains of any kinds, twists and lengths: no assertion, nothing foreign."""
    made = (
        DHRow(theta, d, a, alpha, JointType.PRISMATIC if kind == "P" else JointType.REVOLUTE)
        for kind, theta, d, a, alpha in rows
    )
    robot = outcome(lambda: dh2urdf.Robot.from_dh(DHTable(tuple(made), "standard")))
    if isinstance(robot, Dh2UrdfError):
        return
    q = robot.random_configuration(0)
    T = robot.fk(q)
    T[:3, 3] += far
    outcome(robot.ik, T, task=task, seed=q)
    outcome(robot.why_unreachable, T, task=task)
    outcome(robot.ik, T, task=task, locked={0: float(q[0])}, within_limits=False)
