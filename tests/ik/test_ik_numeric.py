"""The numeric search: for every chain, and honest about what it does not know."""

import math

import numpy as np
import pytest
from ik_referee import random_robot

import dh2urdf
from dh2urdf.exceptions import ConfigurationError, NoSolverError, PoseError
from dh2urdf.ik.arm.solver_order import SOLVERS, imported

MIMIC = """<robot name="paired"><link name="base"/><link name="a"/><link name="b"/><link name="c"/>
<link name="tip"/>
<joint name="one" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
  <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="two" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
  <origin xyz="0.3 0 0.1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
  <mimic joint="one" multiplier="-0.5" offset="0.2"/></joint>
<joint name="three" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
  <origin xyz="0.2 0 0"/><limit lower="0" upper="0.4" effort="1" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link="c"/><child link="tip"/><origin xyz="0.1 0 0"/></joint>
</robot>"""


KINDS = [(1, ()), (2, (1,)), (3, ()), (5, (0,)), (6, (1, 4)), (7, ()), (8, (0,)), (9, (2,))]
KINDS += [(12, ())]


@pytest.mark.parametrize(("n", "sliding"), KINDS)
def test_solutions_reach_the_pose_inside_the_limits(n, sliding):
    """Nearly every reachable pose gets a solution, and every solution is one by Pinocchio."""
    robot = random_robot(n, sliding)
    rng = np.random.default_rng(1)
    solved = 0
    for _ in range(40):
        T = robot.fk(robot.random_configuration(rng))
        found = robot.ik_numeric(T)
        solved += bool(found)
        for q, residual in zip(found, found.residual, strict=True):
            assert np.abs(robot.fk(q) - T).max() <= 1e-9
            assert residual <= 1e-9
            assert np.all((q >= robot.lower) & (q <= robot.upper))
    assert solved >= 38


def test_the_result_is_honest():
    """The text of a result counts starts and says that there may be more."""
    robot = random_robot(9)
    found = robot.ik_numeric(robot.fk(np.zeros(9)), solutions=3)
    assert len(found) == 3
    assert f"3 found from {found.tried} starts; there may be more" in str(found)


def test_different_solutions_are_different():
    """Many solutions of a 6R arm are distinct, and are the complete solver's."""
    robot = dh2urdf.Robot.from_dh("fanuc_crx10ia")
    T = robot.fk([0.3, -0.4, 0.5, 1.1, -0.9, 0.7])
    complete = robot.ik(T, within_limits=False)
    found = robot.ik_numeric(T, solutions=40, starts=600, within_limits=False)
    assert len(found) == len(complete)
    assert found.tried == 600
    for q in found:
        gap = np.abs(np.arcsin(np.sin((complete.q - q) / 2)) * 2).max(axis=1)
        assert gap.min() < 1e-6


def test_a_seed_is_where_the_search_starts():
    """From the configuration itself the search stays there; results are sorted by distance."""
    robot = random_robot(8)
    q = robot.random_configuration(3)
    found = robot.ik_numeric(robot.fk(q), seed=q, solutions=4)
    assert np.abs(found[0] - q).max() < 1e-9
    assert np.all(np.diff(np.linalg.norm(found.q - q, axis=1)) >= 0.0)
    assert np.array_equal(found.nearest(q), found[0])


def test_out_of_reach_finds_nothing():
    """A pose 50 m away has no solution, and nearest says so."""
    robot = random_robot(8)
    T = np.eye(4)
    T[0, 3] = 50.0
    found = robot.ik_numeric(T, starts=5)
    assert not found
    assert found.tried == 5
    with pytest.raises(LookupError, match="no solution"):
        found.nearest(np.zeros(8))


@pytest.mark.parametrize("task", ["position", "position+axis"])
def test_tasks_leave_the_rest_of_the_pose_free(task):
    """The position is met exactly, the tool's z too where it is asked for."""
    robot = random_robot(5, (0,))
    rng = np.random.default_rng(2)
    for _ in range(20):
        T = robot.fk(robot.random_configuration(rng))
        found = robot.ik_numeric(T[:3, 3] if task == "position" else T, task=task)
        assert found
        T_found = robot.fk(found[0])
        assert np.abs(T_found[:3, 3] - T[:3, 3]).max() <= 1e-9
        if task == "position+axis":
            assert np.abs(T_found[:3, 2] - T[:3, 2]).max() <= 2e-9


def test_mimic_joints_follow(tmp_path):
    """An arm whose second joint mimics the first is solved for its two values."""
    path = tmp_path / "paired.urdf"
    path.write_text(MIMIC)
    robot = dh2urdf.Robot.from_urdf(path)
    assert (robot.n, robot.chain.n) == (2, 3)
    rng = np.random.default_rng(0)
    for _ in range(10):
        q = robot.random_configuration(rng)
        found = robot.ik_numeric(robot.fk(q))
        assert np.abs(found[0] - q).max() < 1e-6
        assert np.abs(robot.ik(robot.fk(q)).q - q).max(axis=1).min() < 1e-6


def test_equal_random_starts_give_equal_results():
    """The same call twice gives the same solutions; another generator may give others."""
    robot = random_robot(9)
    T = robot.fk(robot.random_configuration(1))
    first, second = (robot.ik_numeric(T, solutions=5) for _ in range(2))
    assert np.array_equal(first.q, second.q)
    other = robot.ik_numeric(T, solutions=5, rng=np.random.default_rng(7))
    assert not np.array_equal(first.q[1:], other.q[1:])


BAD = {
    "starts": ({"starts": 0}, "starts: expected a whole number from 1 .* got 0"),
    "solutions": ({"solutions": 1.5}, "solutions: expected a whole number from 1 .* got 1.5"),
    "seed": ({"seed": [0.0]}, r"seed: expected shape \(8,\), got \(1,\)"),
    "task": ({"task": "pos"}, "task: expected 'pose' or .*, got 'pos'"),
}


@pytest.mark.parametrize("case", BAD)
def test_wrong_arguments_are_one_clear_exception(case):
    """Each wrong argument is named with what is allowed."""
    arguments, message = BAD[case]
    with pytest.raises(ConfigurationError, match=message):
        random_robot(8).ik_numeric(np.eye(4), **arguments)


def test_many_poses_at_once_are_refused():
    """A stack of poses is not one pose."""
    with pytest.raises(PoseError, match=r"expected shape \(4, 4\)"):
        random_robot(8).ik_numeric(np.stack([np.eye(4)] * 2))


@pytest.mark.parametrize(("n", "sliding"), [(10, ()), (10, (1, 4)), (10, (5,))])
def test_ik_names_all_classes_and_offers_the_search(n, sliding):
    """Where no solver covers a chain the error lists every class and names ik_numeric."""
    with pytest.raises(NoSolverError) as error:
        random_robot(n, sliding).ik(np.eye(4))
    text = str(error.value)
    assert "ik_numeric" in text
    for family in map(imported, SOLVERS):
        assert f"{family.name} ({family.needs}): " in text


def test_limits_can_be_left_aside():
    """Without limits a pose beyond them is found, with them it is not."""
    robot = random_robot(3)
    q = np.array([2.9, 0.3, 0.4])
    T = robot.fk(q)
    assert not robot.ik_numeric(T)
    found = robot.ik_numeric(T, within_limits=False, solutions=8)
    gap = np.abs(np.arcsin(np.sin((found.q - q) / 2)) * 2).max(axis=1)
    assert gap.min() < 1e-6
    assert math.isclose(found.residual.max(), 0.0, abs_tol=1e-9)
