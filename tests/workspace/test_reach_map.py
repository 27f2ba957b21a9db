"""Maps of the reach: values against each pose solved alone, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from dh2urdf import Origin, Robot
from dh2urdf.exceptions import ArgumentError, PoseError
from dh2urdf.transforms import pose
from dh2urdf.workspace import cone, reach_map, task_of
from dh2urdf.workspace.reach.units import measure_units

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
    ({"region": ((0, 1), (0, 1), (1, 0))}, "region: each pair .* end, got z from 1 to 0"),
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


@pytest.mark.parametrize(("name", "within_limits", "joints"), [
    ("gantry_wrist", False, "joint_1, joint_2, joint_3"),
    ("stanford", False, "joint_3"),
    ("endless", True, "joint_3"),
])  # fmt: skip
def test_slides_without_an_end_ask_for_a_region(name, within_limits, joints):
    """A map is not cut off where the arm would go on; with a region the same arm is mapped."""
    robot = Robot.from_dh("stanford" if name == "endless" else name)
    if name == "endless":
        rows = [replace(r, lower=None, upper=None) for r in robot.table.rows]
        robot = Robot.from_dh(replace(robot.table, rows=tuple(rows)))
    with pytest.raises(ArgumentError, match=f"region: {joints} slides without an end"):
        reach_map(robot, step=0.3, within_limits=within_limits)
    box = ((3.0, 3.4), (0.0, 0.4), (0.0, 0.4))
    far = reach_map(robot, step=0.2, orientations=20, region=box, within_limits=within_limits)
    assert float(far.share.max()) > 0.0


def test_orientations_are_not_given_to_an_arm_mapped_by_position():
    """An arm of two joints takes no rotations, and is not refined out of its plane."""
    robot = Robot.from_dh("planar_rr")
    with pytest.raises(ArgumentError, match="orientations: planar_rr is mapped by position only"):
        reach_map(robot, step=0.2, orientations=cone(5))
    with pytest.raises(
        ArgumentError, match="refine: a planar arm reaches nothing beside its plane"
    ):
        reach_map(robot, step=0.2, refine=1)


@pytest.mark.parametrize(("name", "manipulability", "singular", "margin"), [
    ("ur5e", "m3", "1", "rad"),
    ("stanford", "m2", "1", "rad or m"),
    ("gantry", "1", "1", "m"),
    ("planar_rr", "m2", "m", "rad"),
    ("planar_rrr", "m2", "1", "rad"),
])  # fmt: skip
def test_units_of_measures_are_those_of_the_arm(name, manipulability, singular, margin):
    """By joints that turn or slide and by the task; where both are meant, the words say so."""
    robot = Robot.from_dh(name)
    found = reach_map(robot, step=0.5, orientations=4)
    assert found.manipulability.units == manipulability
    assert found.singular_value.units == singular
    assert found.limit_margin.units == margin
    assert ("slides in m" in found.limit_margin.long_name) == (margin == "rad or m")


@pytest.mark.parametrize(("name", "rows"), [
    ("ur5e", 6), ("stanford", 6), ("planar_rr", 3), ("gantry", 3), ("planar_rrr", (0, 1, 5)),
])  # fmt: skip
def test_manipulability_has_the_unit_that_it_scales_with(name, rows):
    """Of an arm twice as large it is 2, 4 or 8 times that of the arm, as its unit says."""
    robot = Robot.from_dh(name)
    rows = list(range(rows)) if isinstance(rows, int) else list(rows)
    large = [replace(r, a=2 * r.a, d=2 * r.d, lower=None, upper=None) for r in robot.table.rows]
    twice = Robot.from_dh(replace(robot.table, rows=tuple(large), base=Origin(), tool=Origin()))
    same = [replace(r, lower=None, upper=None) for r in robot.table.rows]
    once = Robot.from_dh(replace(robot.table, rows=tuple(same), base=Origin(), tool=Origin()))
    q = np.linspace(0.3, 0.9, robot.n)
    one, two = (np.prod(np.linalg.svd(arm.jacobian(x)[rows], compute_uv=False))
                for arm, x in ((once, q), (twice, np.where(robot.slides, 2 * q, q))))  # fmt: skip
    unit = measure_units(robot.chain.joint_types, task_of(robot).name)["manipulability"]
    assert np.isclose(two / one, 2.0 ** {"1": 0, "m": 1, "m2": 2, "m3": 3}[unit], rtol=1e-9)


def test_variables_say_what_they_are():
    """Those of each orientation by their own words; the task, limits and step stand alone."""
    found = reach_map(Robot.from_dh("ur5e"), step=0.5, orientations=4, each=True)
    assert found.solutions_each.long_name == "solutions of each orientation"
    assert found.limit_margin_each.long_name.endswith(", of each orientation")
    said = [found.attrs[key] for key in ("task", "joint_limits", "step", "complete")]
    assert said == ["pose", "kept", 0.5, 1]
