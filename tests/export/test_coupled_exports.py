"""Arms whose joints follow others: what is exported of them, and what is refused by name."""

import pytest
from coupled_arms import COUPLED, painter, palletiser
from lxml import etree

from dh2urdf import Robot, export_solver
from dh2urdf.exceptions import NoSolverError
from dh2urdf.export.ros2 import ros2_package
from dh2urdf.export.source import exported
from dh2urdf.symbolic import symbolic_ik


def semantics(table):
    """The SRDF of a table's package."""
    files = ros2_package(table, "arm_description").files
    (text,) = (text for place, text in files.items() if place.endswith(".srdf"))
    return etree.fromstring(text.encode())


@pytest.mark.parametrize("name", COUPLED)
def test_a_solver_of_coupled_joints_is_not_written(name, tmp_path):
    """It would take the joints' own angles for q."""
    with pytest.raises(NoSolverError, match=r"coupled|follow"):
        export_solver(Robot.from_dh(COUPLED[name]()), tmp_path / "arm.h")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", COUPLED)
def test_formulas_of_coupled_joints_are_refused(name):
    """For the same reason."""
    with pytest.raises(NoSolverError, match=r"coupled|follow"):
        symbolic_ik(COUPLED[name]())


def test_followers_are_passive_in_moveit():
    """They have no motor, and no one publishes their state."""
    names = [joint.get("name") for joint in semantics(painter()).iterfind("passive_joint")]
    assert names == ["joint_6"]


def test_followers_are_at_home_where_their_leaders_put_them():
    """Joint 2 of the palletiser cannot be at zero; its follower is at minus its middle."""
    rows = list(palletiser().rows)
    table = palletiser()
    rows[1] = type(rows[1])(theta=rows[1].theta, a=rows[1].a, lower=0.5, upper=1.5)
    table = type(table)(tuple(rows), "standard", name="palletiser")
    state = semantics(table).find("group_state")
    home = {joint.get("name"): float(joint.get("value")) for joint in state}
    assert home["joint_2"] == 1.0
    assert home["joint_4"] == -1.0


def test_a_package_says_which_joints_follow_and_asks_of_four_values_a_position():
    """In README, package.xml and MoveIt's parameters."""
    files = ros2_package("abb_irb460", "arm_description").files
    for place in ("README.md", "config/kinematics.yaml"):
        assert "level_2 follows joint_2; level_3 follows joint_3." in files[place]
    for place in ("README.md", "package.xml"):
        assert "an arm of 6 joints (2 follow others)" in files[place]
    assert "position_only_ik: true" in files["config/kinematics.yaml"]


def test_a_package_says_that_its_joint_is_not_the_controllers():
    """J3 of a pendant counts from the level."""
    files = ros2_package("fanuc_r1000ia80f", "arm_description").files
    for place in ("README.md", "config/kinematics.yaml"):
        assert (
            "joint_3 of the URDF is the joint itself, at the controller's joint_3 plus 1 joint_2"
            in files[place]
        )


def test_no_one_is_told_to_leave_out_couplings_that_are_followers():
    """Only of a controller's angles is the table without them the same arm."""
    with pytest.raises(NoSolverError, match="4 values move 6 joints") as error:
        exported(Robot.from_dh("abb_irb460"), language="c")
    assert "without couplings" not in str(error.value)
