"""Calibrated arms, whose nearly parallel axes have their common normals hundreds of metres away."""

from dataclasses import replace

import numpy as np
import pytest
from strategies import FACTORY

import dh2urdf
from dh2urdf import DHTable, Robot
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.drawing.arm import arm_points, drawn_arm
from dh2urdf.drawing.row import row_picture, row_words
from dh2urdf.drawing.surfaces import TableDrawing
from dh2urdf.figures import figure
from dh2urdf.transforms import pose, rotation
from dh2urdf.viewer.stage import set_stage


def calibrated(name, seed, convention="standard"):
    """A shipped arm as a factory finds it: every axis tilted by up to a milliradian and moved.

    The table has four parameters a row and no fixed step, as a maker's calibration file.
    """
    rng, chain = np.random.default_rng(seed), dh_to_chain(dh2urdf.load_table(name))
    links = chain.links.copy()
    for k in range(1, chain.n):
        tilt = rotation(rng.normal(size=3), 1e-3 * rng.uniform(0.5, 1.0))
        links[k] = links[k] @ pose(tilt, 2e-4 * rng.uniform(-1.0, 1.0, 3))
    found = chain_to_dh(replace(chain, links=links), convention, compact=False, name=name)
    return found.table


ARMS = (
    *(("ur5e", seed, "standard") for seed in (1, 2)),
    *(("ur10e", 3, "standard"), ("ur3e", 4, "modified"), ("ur5e", 5, "modified")),
    *(("kuka_kr6_r700", 6, "standard"), ("planar_rrr", 7, "standard")),
)


@pytest.fixture(params=ARMS, ids=lambda arm: "-".join(map(str, arm)))
def far(request):
    """A nominal arm and a calibrated one with frames at least fifty metres away."""
    table = calibrated(*request.param)
    assert max(abs(row.d) for row in table.joints) > 50.0
    return dh2urdf.load_table(request.param[0]), table


def test_frames_are_drawn_where_the_nominal_arm_has_its_own(far):
    """Moved frames stay on their axes and rigid to their links, and within the arm."""
    nominal, table = far
    arm = drawn_arm(table)
    assert arm.size < 1.1 * drawn_arm(nominal).size
    moved = arm.shifts != 0.0
    assert moved.sum() >= 1
    for q in np.random.default_rng(0).uniform(-3, 3, (5, table.n)):
        true, shown = table.frames(q), arm.frames(q)
        np.testing.assert_array_equal(true[~moved], shown[~moved])
        np.testing.assert_array_equal(true[:, :3, :3], shown[:, :3, :3])
        off = shown[:, :3, 3] - true[:, :3, 3]
        assert np.abs(np.cross(off, true[:, :3, 2])).max() < 1e-9
        np.testing.assert_allclose(np.linalg.norm(off, axis=1), np.abs(arm.shifts), atol=1e-9)
        assert np.linalg.norm(shown[:, :3, 3], axis=1).max() < 1.02 * nominal.length


def test_rows_say_what_is_drawn_elsewhere(far):
    """Measures join the frames as drawn, are marked where moved, and keep the table's values."""
    nominal, table = far
    arm, q = drawn_arm(table), np.full(table.n, 0.4)
    shown = arm.frames(q)
    for i, row in enumerate(table.joints, 1):
        picture = row_picture(arm, q, i)
        touched = bool(arm.shifts[i - 1 : i + 1].any())
        assert picture.d.moved == touched
        assert picture.d.value == row.d
        assert picture.a.value == row.a
        np.testing.assert_array_equal(picture.T_prev, shown[i - 1])
        np.testing.assert_array_equal(picture.T_next, shown[i])
        segments = np.concatenate([picture.d.segment, picture.a.segment])
        assert np.linalg.norm(segments, axis=1).max() < 1.3 * nominal.length
        for measure in (picture.d, picture.a):
            if not measure.moved:
                length = np.linalg.norm(np.diff(measure.segment, axis=0))
                assert length == pytest.approx(abs(measure.value), abs=1e-9)
        assert ("moved along z" in row_words(table, picture)) == touched


@pytest.mark.parametrize("far", [ARMS[0], ARMS[3]], indirect=True)
@pytest.mark.parametrize("style", ["bodies", "schematic"])
def test_the_arm_fills_its_figure(far, style):
    """Bodies or schematic are drawn as large as the nominal arm's; a note names the frames."""
    nominal, table = far
    drawn = figure(Robot.from_dh(table), style=style)
    plain = figure(Robot.from_dh(nominal), style=style)
    assert ink(drawn) > 0.6 * ink(plain)
    texts = [text.get_text() for text in drawn.axes[0].texts]
    assert any("moved along" in text for text in texts)
    assert any(r"^{\prime}" in text for text in texts)
    biggest = max(range(table.n), key=lambda i: abs(table.joints[i].d))
    shown = f"{abs(table.joints[biggest].d):.4g} m"
    assert any(text.startswith(f"$d_{{{biggest + 1}}}$") and shown in text for text in texts)
    assert not any(r"^{\prime}" in text.get_text() for text in plain.axes[0].texts)


def ink(picture):
    """Area of the sheet that bodies, links and joints cover [pt^2], overlaps counted twice."""
    return sum(np.prod(np.ptp(patch.get_xy(), axis=0)) for patch in polygons(picture))


def polygons(picture):
    return [patch for patch in picture.axes[0].patches if hasattr(patch, "get_xy")]


def test_the_eye_of_the_view_stands_by_the_arm():
    """The browser's camera is as far from a calibrated arm as from the nominal one."""
    distances = []
    for table in (dh2urdf.load_table("ur5e"), calibrated("ur5e", 1), FACTORY):
        robot, arm = Robot.from_dh(table), drawn_arm(table)
        _, distance = set_stage(Anything(), robot, arm, TableDrawing(arm), np.zeros(6))
        distances.append(distance)
    assert distances[1] == pytest.approx(distances[0], rel=0.05)
    assert distances[2] < 10.0


class Anything:
    """A server that takes what it is given."""

    def __getattr__(self, *_, **__):
        return Anything()

    __call__ = __getattr__


def test_points_of_a_calibrated_arm_are_near_it():
    """What the workspace draws as the arm is within its reach."""
    robot = Robot.from_dh(FACTORY)
    Q = np.random.default_rng(1).uniform(-3, 3, (20, 6))
    assert np.linalg.norm(arm_points(robot, Q), axis=2).max() < 1.5 * robot.chain.size


def test_an_ordinary_table_moves_no_frame():
    """Frames of every shipped table are drawn where they are."""
    for name in dh2urdf.list_tables():
        assert not drawn_arm(dh2urdf.load_table(name)).shifts.any()


def test_parallel_axes_with_frames_far_out_are_drawn_too():
    """Exactly parallel axes whose d cancel, 245 m out and back, as a sheet may have them."""
    table = dh2urdf.load_table("ur5e")
    d = (0.0, -245.0, 245.0, 0.0, 0.0, 0.0)
    rows = [replace(row, d=row.d + far) for row, far in zip(table.joints, d, strict=True)]
    arm = drawn_arm(DHTable(tuple(rows), table.convention, "far"))
    q = np.array([0.3, -1.0, 1.2, 0.1, 0.5, 0.7])
    near = drawn_arm(table)
    np.testing.assert_allclose(arm.frames(q), near.frames(q), atol=1e-9)
    assert np.flatnonzero(arm.shifts).tolist() == [2]
