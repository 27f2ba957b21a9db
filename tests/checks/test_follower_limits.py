"""What ``check`` says of followers: that their limits and those of their leaders fit together."""

import re

import pinocchio as pin
import pytest
import urdf_faults
from coupled_arms import painter

from dh2urdf import urdf_text
from dh2urdf.checks import check_urdf


def message(limits, multiplier, path):
    """What the rule says of a painter's follower with limits; joint 5 has 1 to 2 rad."""
    text = urdf_text(painter())
    for joint, (low, high) in {"joint_5": (1.0, 2.0), "joint_6": limits}.items():
        given = rf'(<joint name="{joint}".*?)lower="[^"]*" upper="[^"]*"'
        text = re.sub(given, rf'\1lower="{low}" upper="{high}"', text, count=1, flags=re.DOTALL)
    text = re.sub(r'multiplier="[^"]*"', f'multiplier="{multiplier}"', text)
    path.write_text(text)
    (found,) = [f for f in check_urdf(path) if f.rule == "mimic"]
    return found.message


@pytest.mark.parametrize(
    ("limits", "multiplier", "words"),
    [
        ((-0.5, 0.0), -1.0, "its limits leave that 0 to 0.5, outside 1 to 2"),
        ((-1.5, 0.0), -1.0, ""),
        ((-1.5, 0.0), 2.0, "its limits leave that -0.75 to 0, outside 1 to 2"),
        ((2.5, 3.0), 2.0, ""),
    ],
)
def test_limits_that_leave_a_leader_nothing_are_told(limits, multiplier, words, tmp_path):
    said = message(limits, multiplier, tmp_path / "arm.urdf")
    assert "follows 'joint_5'" in said
    assert words in said
    assert bool(words) == ("but its limits" in said)


def test_a_follower_of_a_follower_is_one_that_pinocchio_refuses_to_move(written):
    """With mimic=True; yourdfpy complains, and check says so of both."""
    wrist = urdf_faults.joint("wrist", parent="fore", child="hand", extra='<mimic joint="elbow"/>')
    text = urdf_faults.arm(
        elbow=urdf_faults.joint(extra='<mimic joint="shoulder"/>'),
        extra=f'<link name="hand">{urdf_faults.BODY}</link>{wrist}',
    )
    path = written("arm.urdf", text)
    with pytest.raises(ValueError, match="wrong argument size"):
        pin.buildModelFromUrdf(str(path), mimic=True)
    (found,) = [f for f in check_urdf(path) if "which follows another" in f.message]
    assert any("refuses" in str(effect) for effect in found.effects)
