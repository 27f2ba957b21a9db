"""``dh2urdf place``: where a robot should stand for a file of poses."""

import json

import numpy as np
import pytest

import dh2urdf

JOB = """x [mm],y [mm],z [mm],roll [deg],pitch [deg],yaw [deg]
1200,1800,200,180,0,0
1400,1800,200,180,0,30
1600,1900,250,180,0,60
"""


@pytest.fixture
def job(tmp_path):
    """A file of three poses in reach of one another."""
    (tmp_path / "job.csv").write_text(JOB)


@pytest.mark.usefixtures("job")
def test_the_base_that_is_told_reaches_the_poses(run, tmp_path):
    """Text, JSON and picture; each q reaches its pose from the base by forward kinematics."""
    status, out, err = run("place", "ur5e", "job.csv", "--yaw", "0", "--deg", "-o", "map.svg")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("ur5e: base at x ")
    assert "all 3 poses reached, margin 0." in lines[1]
    assert lines[-1] == "map.svg"
    assert b"margin of the worst pose" in (tmp_path / "map.svg").read_bytes()
    status, out, _ = run("place", "ur5e", "job.csv", "--yaw", "0", "--json")
    told = json.loads(out)
    robot = dh2urdf.Robot.from_dh("ur5e")
    T = np.array(told["T_world_base"]) @ robot.fk(told["q"])
    np.testing.assert_allclose(T[:, :3, 3], [[1.2, 1.8, 0.2], [1.4, 1.8, 0.2], [1.6, 1.9, 0.25]],
                               atol=1e-8)  # fmt: skip
    assert told["margin"] == min(told["margins"]) > 0.0
    signs = {sign for line in lines[4:-1] for sign in line[10:].split()}
    assert signs <= set("0123456789.")


def test_poses_in_the_way_are_told_by_line(run, tmp_path):
    """One pose 3 m off, one 3 m high: status 1, each with its line and why."""
    (tmp_path / "job.csv").write_text(JOB + "4600,1900,250,180,0,60\n1300,1900,3000,180,0,0\n")
    status, out, err = run("place", "ur5e", "job.csv", "--yaw=0")
    assert status == 1
    assert "no base found that reaches all 5 poses" in out
    assert "3 of 5 poses from x" in out
    assert "job.csv:5: ur5e: out of reach from that base: " in err
    assert "job.csv:6: ur5e: out of reach from any base that was tried: " in err


@pytest.mark.usefixtures("job")
def test_two_robots_are_told_side_by_side(run):
    """The better one is named; a robot that reaches fewer poses is the worse."""
    status, out, _ = run("place", "ur5e", "job.csv", "--yaw=0", "--against", "ur3e")
    assert status == 0
    assert "ur3e: " in out
    assert "has margin" in out.splitlines()[-1]


@pytest.mark.usefixtures("job")
def test_bad_input_is_refused_in_one_line(run):
    """Status 2, what was wrong, and nothing written."""
    for argv, words in (
        (["--region", "1", "0", "0", "1"], "--region: lower x"),
        (["--region", "1", "2"], "4 numbers"),
        (["--height", "1", "2", "3"], "--height"),
        (["--height", "2", "1"], "lower ends first"),
        (["-o", "map.gif"], ".svg"),
        (["--against", "nowhere"], "nowhere"),
    ):
        status, out, err = run("place", "ur5e", "job.csv", *argv)
        assert (status, out) == (2, ""), argv
        assert words in err
        assert err.count("\n") == 1
