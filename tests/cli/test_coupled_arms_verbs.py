"""Verbs on arms whose values are fewer than their joints, or others: nothing counts the joints."""

import csv
import io

import numpy as np
import pytest

from dh2urdf import Robot

ARMS = "abb_irb460", "abb_irb5400", "fanuc_r1000ia80f"


def poses(robot, path):
    """A file of the poses of three configurations near the middle of the limits; these."""
    q = 0.5 * (robot.lower + robot.upper) + np.array([[0.1], [0.15], [0.2]])
    names = [f"t{i}{j}" for i in range(3) for j in range(4)]
    rows = [",".join(map(repr, T[:3].ravel().tolist())) for T in robot.fk(q)]
    path.write_text("\n".join([",".join(names), *rows]) + "\n")
    return q


@pytest.mark.parametrize("arm", ARMS)
def test_the_best_solution_of_each_pose_is_nearest_to_the_middle_of_the_values(arm, tmp_path, run):
    robot = Robot.from_dh(arm)
    q = poses(robot, tmp_path / "poses.csv")
    code, out, _ = run("ik", arm, "--csv", str(tmp_path / "poses.csv"), "--best")
    assert code == 0
    rows = list(csv.DictReader(io.StringIO(out)))
    found = np.array([[float(row[name]) for name in robot.joint_names] for row in rows])
    assert np.abs(found - q).max() < 1e-6


@pytest.mark.parametrize("arm", ARMS)
def test_solutions_too_far_from_a_seed_are_told_by_the_value_that_is(arm, run):
    robot = Robot.from_dh(arm)
    q = 0.5 * (robot.lower + robot.upper) + 0.1
    words = [f"--matrix={','.join(map(repr, robot.fk(q).ravel().tolist()))}"]
    words += [f"--seed={','.join(map(str, q + 0.3))}", "--seed-tolerance", "0.01"]
    code, out, err = run("ik", arm, *words)
    assert code == 1
    assert (
        "farther from the seed than --seed-tolerance allows, the nearest by 0.29 rad" in out + err
    )


@pytest.mark.parametrize("arm", ARMS[:2])
def test_a_way_to_a_direction_names_the_joint_that_is_held(arm, run):
    robot = Robot.from_dh(arm)
    T = robot.fk(0.5 * (robot.lower + robot.upper) + 0.1)
    words = f"--matrix={','.join(map(repr, T.ravel().tolist()))}", "--task", "position+axis"
    code, out, _ = run("ik", arm, *words, "--explain")
    assert code == 0
    assert f"so some are held: {robot.joint_names[-1]} at 0 rad" in out


@pytest.mark.parametrize("arm", ARMS[:2])
def test_a_way_without_steps_names_its_solver_in_lines_that_fit(arm, run):
    robot = Robot.from_dh(arm)
    T = robot.fk(0.5 * (robot.lower + robot.upper) + 0.1)
    words = f"--matrix={','.join(map(repr, T.ravel().tolist()))}", "--explain"
    code, out, _ = run("ik", arm, *words)
    assert code == 0
    assert max(map(len, out.splitlines())) <= 100
