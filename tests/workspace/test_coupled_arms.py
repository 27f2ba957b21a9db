"""Arms of which values move joints together: what is worked out of boxes of joints is refused."""

import numpy as np
import pytest

from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.exceptions import ArgumentError
from dh2urdf.workspace import extreme_reach, place, reach_section
from dh2urdf.workspace.planar import planar_arm
from dh2urdf.workspace.reach import reach_map

ROWS = tuple(DHRow(a=0.3, alpha=1.0, d=0.1, lower=-1.0, upper=1.0) for _ in range(6))
ARM = Robot.from_dh(DHTable(ROWS, "standard", couplings={"joint_3": {"joint_2": 1.0}}))
ASKED = {
    "how far": lambda: extreme_reach(ARM),
    "section": lambda: reach_section(ARM),
    "map": lambda: reach_map(ARM, step=0.5),
    "base": lambda: place(ARM, ARM.fk(np.zeros((1, 6)))),
}


@pytest.mark.parametrize("what", ASKED)
def test_reach_of_joints_that_move_together_is_refused(what):
    """The limits of coupled joints are no box, so that the answers would be of another arm."""
    with pytest.raises(ArgumentError, match="has joints that move together"):
        ASKED[what]()


def test_a_coupled_arm_in_a_plane_is_not_drawn_as_two_free_joints():
    """Its elbow's limits are not those of its second value."""
    rows = (DHRow(a=1.0), DHRow(a=0.5))
    coupled = DHTable(rows, "standard", couplings={"joint_2": {"joint_1": 1.0}})
    assert planar_arm(Robot.from_dh(DHTable(rows, "standard"))) is not None
    assert planar_arm(Robot.from_dh(coupled)) is None
