"""The kernel that looks at target poses, against the check that is written in NumPy."""

import numpy as np
import pytest
from dh_product import dh_frames

from dh2urdf.exceptions import PoseError
from dh2urdf.kernels.numbers.poses import first_bad_pose
from dh2urdf.robots import load_table
from dh2urdf.transforms import check_pose


def poses(m, seed=0):
    """Random poses (m, 4, 4)."""
    rng = np.random.default_rng(seed)
    table = load_table("puma560")
    return np.array([dh_frames(table, q)[-1] for q in rng.uniform(-3, 3, (m, 6))])


def refused(T):
    """Whether the check in NumPy refuses a pose."""
    try:
        check_pose(T)
    except PoseError:
        return True
    return False


@pytest.mark.parametrize("m", [1, 63, 64, 65, 200])
def test_rigid_poses_pass(m):
    """No pose of a batch of any length is called bad."""
    assert first_bad_pose(poses(m)) == -1


@pytest.mark.parametrize("i", [0, 1, 63, 64, 129])
@pytest.mark.parametrize("amount", [np.nan, np.inf, -np.inf, 1e-3, -2.0])
def test_any_entry_that_is_off_makes_a_pose_bad(i, amount):
    """Each of the sixteen entries counts; of two bad poses the first is named."""
    sound = poses(130, seed=i)
    for entry in np.ndindex(4, 4):
        Ts = sound.copy()
        Ts[i][entry] += amount
        Ts[129, 3, 3] = 2.0
        expected = i if refused(Ts[i]) else 129
        assert first_bad_pose(Ts) == expected, entry


def test_reflections_and_scales_are_bad():
    """Columns of length one that are left-handed, and columns that are too long."""
    Ts = poses(3)
    Ts[1, :3, 0] *= -1.0
    assert first_bad_pose(Ts) == 1
    Ts = poses(3)
    Ts[2, :3, :3] *= 1.0 + 1e-5
    assert first_bad_pose(Ts) == 2
