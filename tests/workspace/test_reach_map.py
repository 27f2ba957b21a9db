"""Maps of the reach: values against each pose solved alone, and what is refused."""

import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError, PoseError
from dh2urdf.transforms import pose
from dh2urdf.workspace import cone, reach_map

CORNER = ((0.2, 0.6), (-0.2, 0.2), (0.1, 0.5))


def alone(robot, point, turns, within_limits):
    """Of each orientation: number of solutions, and the best of each measure by NumPy."""
    for R in turns:
        q = robot.ik(pose(R, point), within_limits=within_limits).q
        sigma = [np.linalg.svd(robot.jacobian(each), compute_uv=False) for each in q]
        room = np.minimum(q - robot.lower, robot.upper - q).min(axis=1, initial=np.inf)
        best = (max((f(s) for s in sigma), default=np.nan) for f in (np.prod, np.min))
        yield len(q), *best, room.max() if len(q) else np.nan


@pytest.mark.parametrize("name", ["denso_vs6556", "ur5e", "stanford"])
@pytest.mark.parametrize("within_limits", [True, False])
def test_a_voxel_holds_what_its_centre_reaches(name, within_limits):
    """Counts and measures are those of all solutions of the poses at the voxels' centres."""
    robot = Robot.from_dh(name)
    found = reach_map(robot, step=0.2, orientations=9, region=CORNER, each=True,
                      within_limits=within_limits)  # fmt: skip
    turns = found.rotation.values[:, 0]
    for i, j, k in np.ndindex(found.share.shape):
        voxel = found.isel(x=i, y=j, z=k)
        point = [float(voxel[axis]) for axis in "xyz"]
        count, *best = np.array(list(alone(robot, point, turns, within_limits))).T
        np.testing.assert_array_equal(voxel.solutions_each, count)
        assert np.isclose(voxel.share, (count > 0).mean(), rtol=1e-6)
        assert np.isclose(voxel.solutions_mean, count.mean(), rtol=1e-6)
        assert voxel.solutions_max == count.max()
        for name_, values in zip(("manipulability", "singular_value", "limit_margin"), best,
                                 strict=True):  # fmt: skip
            np.testing.assert_allclose(voxel[f"{name_}_each"], values, rtol=2e-6, atol=2e-7)
            if (count > 0).any():
                assert np.isclose(voxel[name_], np.nanmax(values), rtol=2e-6, atol=2e-7)
            else:
                assert np.isnan(voxel[name_])


def test_the_map_of_all_an_arm_reaches_is_bounded_by_unreached_voxels():
    """Without a region the grid holds the whole reach: its outermost voxels are empty."""
    share = reach_map(Robot.from_dh("denso_vs6556"), step=0.2, orientations=30).share.values
    assert share.max() > 0.5
    inner = share[1:-1, 1:-1, 1:-1]
    assert share.astype(bool).sum() == inner.astype(bool).sum()


def test_a_direction_counts_when_one_of_its_spins_is_reached():
    """With spins, a direction is reached where one of its rotations is; all stand in the cone."""
    robot, turns = Robot.from_dh("denso_vs6556"), cone(12, within=0.5, spins=4)
    assert (turns[..., 2, 2] <= -np.cos(0.5)).all()
    given = {"step": 0.2, "region": CORNER}
    any_spin = reach_map(robot, orientations=turns, **given)
    every = reach_map(robot, orientations=turns.reshape(-1, 3, 3), each=True, **given)
    reached = every.solutions_each.values.reshape(2, 2, 2, 12, 4) > 0
    np.testing.assert_allclose(any_spin.share, reached.any(axis=-1).mean(axis=-1), rtol=1e-6)


@pytest.mark.parametrize("bad", [
    ({"step": 0.0}, "step: expected a number"),
    ({"step": 1e-6}, "voxels of 1e-06 m"),
    ({"orientations": 0}, "orientations: expected a whole number"),
    ({"orientations": np.eye(3)}, "orientations: expected a whole number, or rotations"),
    ({"region": ((0, 1), (0, 1))}, "region: expected three pairs"),
    ({"region": ((0, 1), (0, 1), (1, 0))}, "region: each pair begins with the lower end"),
    ({"within_limits": 1}, "within_limits: expected True or False"),
])  # fmt: skip
def test_what_cannot_be_mapped_is_refused_by_name(bad):
    """One message names the argument, what was found and what is allowed."""
    given, message = bad
    with pytest.raises(ArgumentError, match=message):
        reach_map(Robot.from_dh("ur5e"), **given)


def test_orientations_have_to_be_rotations():
    """A matrix that is no rotation is refused with its index."""
    with pytest.raises(PoseError, match=r"orientations\[1, 0\]"):
        reach_map(Robot.from_dh("ur5e"), orientations=[np.eye(3), 2 * np.eye(3)])
