"""The target as text, and the table as a lesson, without a browser."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dh2urdf import DHRow, DHTable, Robot, load_table
from dh2urdf.drawing.lesson import motions, walked
from dh2urdf.exceptions import PoseError
from dh2urdf.transforms import pose, rpy_to_matrix, trans
from dh2urdf.viewer.options import UNITS
from dh2urdf.viewer.tabs.pose_field import FORMS, pose_text, read_pose

START = np.radians([20.0, -105.0, 83.0, -51.0, -71.0, 22.0])
SI = UNITS["m, rad"]


@given(st.integers(0, 2**32 - 1), st.sampled_from(FORMS), st.sampled_from(list(UNITS.values())))
def test_pose_copied_out_reads_back(seed, form, units):
    """In every form and unit, to ten nanometres and as many nanoradians."""
    rng = np.random.default_rng(seed)
    T = pin.SE3(pin.exp3(rng.normal(size=3) * 2), rng.uniform(-2, 2, 3)).homogeneous
    back, far = read_pose(pose_text(T, form, units), units, np.eye(4))
    np.testing.assert_allclose(back, T, atol=2e-8)
    assert far < 3e-8


@pytest.mark.parametrize(
    "text",
    [
        "array([[0., -1, 0, 0.4],\n [1., 0, 0, -0.2],\n [0., 0, 1, 0.3],\n [0, 0, 0, 1]])",
        "{{0,-1,0,0.4},{1,0,0,-0.2},{0,0,1,0.3},{0,0,0,1}}",
        "[0 -1 0 0.4; 1 0 0 -0.2; 0 0 1 0.3; 0 0 0 1]",
        "0 −1 0 0.4  1 0 0 −0.2  0 0 1 0.3",
        "xyz: 0.4, -0.2, 0.3; rpy: 0, 0, pi/2",
        "xyz 400mm -20cm 0.3 rpy 0 0 90deg",
        "0.4 -0.2 0.3 0 0 0.7071067811865476 0.7071067811865476",
    ],
)
def test_poses_are_pasted_as_programs_print_them(text):
    """NumPy, Mathematica, MATLAB, plain rows, and expressions with units all read the same."""
    T, _ = read_pose(text, SI, np.eye(4))
    np.testing.assert_allclose(
        T, pose(rpy_to_matrix([0, 0, np.pi / 2]), [0.4, -0.2, 0.3]), atol=1e-9
    )


def test_three_numbers_keep_the_rotation_and_rounded_matrices_are_said():
    """xyz alone moves the target; three decimals are taken by their nearest rotation."""
    T = pose(rpy_to_matrix([0.1, 0.2, 0.3]), [1.0, 2.0, 3.0])
    moved, far = read_pose("0 0 1", SI, T)
    np.testing.assert_array_equal(moved[:3, :3], T[:3, :3])
    assert moved[:3, 3].tolist() == [0, 0, 1]
    assert far == 0
    rows = "\n".join(" ".join(f"{v:.3f}" for v in row) for row in T)
    near, far = read_pose(rows, SI, T)
    np.testing.assert_allclose(near, T, atol=2e-3)
    assert 1e-5 < far < 1e-3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "got 0"),
        ("1 2 3 4", "got 4"),
        ("1 2 apple", "number 3 [m]: 'apple'"),
        ("0 0 0 0 0 0 0", "quaternion must have length 1"),
        ("1 0 0 0  0 1 0 0  0 0 -1 0", "the matrix"),
        ("2 0 0 0  0 2 0 0  0 0 2 0", "the matrix"),
        ("1 0 0 0  0 1 0 0  0 0 1 0  0 0 1 1", "last row"),
        ("1 2 nan", "number 3 [m]"),
        ("1e400 0 0", "number 1 [m]"),
    ],
)
def test_what_is_no_pose_is_said(text, words):
    """Each fault names the number, or what is wrong with the whole."""
    with pytest.raises(PoseError) as raised:
        read_pose(text, SI, np.eye(4))
    assert words in str(raised.value)


@pytest.fixture
def view():
    """A UR5e, stopped after the test."""
    with Robot.from_dh("ur5e").view(START, port=0) as shown:
        yield shown


def test_typed_pose_is_the_target(view):
    """The arm goes there, the target is on; a fault leaves both and is an alert."""
    field, T = view._ik.field, view.robot.fk(START) @ trans(0.03, 0.0, -0.02)
    field.field.value = pose_text(T, FORMS[2], view._options.units)
    field._set(None)
    assert view._ik.active.value
    np.testing.assert_allclose(view.robot.fk(view.q), T, atol=2e-8)
    assert len(view._ik.answer.q) == 8
    q = view.q
    field.field.value = "1 2"
    field._set(None)
    assert 'role="alert"' in field.note.content
    np.testing.assert_array_equal(view.q, q)
    field.field.value = "9 9 9"
    field._set(None)
    assert "Out of reach" in view._ik.status.content
    np.testing.assert_array_equal(view.q, q)


def test_field_follows_the_arm_in_the_form_and_units_chosen(view):
    """What is copied out is where the target is, switched on or not."""
    view._options.choice.value = "mm, °"
    view._switch_units()
    view.q = START + 0.1
    T, _ = read_pose(view._ik.field.field.value, view._options.units, np.eye(4))
    np.testing.assert_allclose(T, view.robot.fk(view.q), atol=2e-8)


@pytest.mark.parametrize("name", ["ur5e", "franka_fer", "rpr_new_frame"])
def test_lesson_walks_through_every_motion_and_back(name):
    """On from before the first row to the last motion of the last, and the same way back."""
    table = load_table(name)
    at, way = (0, None), []
    while (after := walked(table, *at, 1)) != at:
        way.append(at := after)
    expected = [(i, k) for i in range(1, table.n + 1) for k in range(len(motions(table, i)) + 1)]
    assert way == expected
    back = [at]
    while (before := walked(table, *at, -1)) != at:
        back.append(at := before)
    assert back == expected[::-1]
    assert walked(table, 2, None, 1) == (2, 0)


def test_lesson_draws_what_was_made_so_far(view):
    """Motion 2 of row 4: the turn and the step are drawn, the later frame is half-way."""
    tab = view._table
    event = type("Event", (), {"client": None})
    tab.choose(4)
    tab.walk.value = "Next ›"
    for _ in range(3):
        tab._walked(event)
    assert (tab.row, tab.step) == (4, 2)
    assert "Row 4, motion 2 of 4: move along z₃ by d₄ = 0.1333 m." in tab.words.content
    scene = view._row_scene
    assert scene.done == {"theta", "d"}
    T = view.robot.table.frames(START)[3]
    for motion in motions(view.robot.table, 4, START[3])[:2]:
        T = T @ motion.T
    np.testing.assert_allclose(scene.ends[1].position, T[:3, 3], atol=1e-9)
    tab.walk.value = "All at once"
    tab._walked(event)
    assert "Case 3" in tab.words.content
    end = view.robot.table.frames(START)[4]
    np.testing.assert_allclose(view._row_scene.ends[1].position, end[:3, 3], atol=1e-9)


def test_lesson_of_a_frame_far_away_stays_on_the_arm():
    """A row whose frame stands a hundred metres away is drawn whole, on the arm, at every step."""
    far = (DHRow(a=0.4, d=100.0, alpha=1e-3), DHRow(a=0.3, d=-100.0))
    table = DHTable((DHRow(d=0.3, alpha=np.pi / 2), *far), "standard", "far")
    with Robot.from_dh(table).view(port=0) as shown:
        shown._table.row, shown._table.step = 2, 1
        shown._explain(2)
        for end in shown._row_scene.ends:
            assert np.linalg.norm(end.position) < 3.0
        assert "Row 2, motion 1 of 4" in shown._table.words.content
