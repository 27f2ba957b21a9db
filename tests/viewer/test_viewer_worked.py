"""The worked solution beside the arm: what a step says and draws follows the arm."""

import math

import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.viewer.step_scene import letter

Q = np.array([0.4, -0.9, 0.5, 0.3, -0.6, 0.2])


@pytest.fixture
def view():
    """The notes' arm."""
    with Robot.from_dh("denso_vs6556").view(Q, port=0) as shown:
        yield shown


def choose(view, title):
    """Choose the step whose title begins so, as a visitor would."""
    view._worked.step = 1
    view._step()
    options = list(view._worked.choice.options)
    view._worked.step = next(k for k, o in enumerate(options) if o.partition(". ")[2] == title)
    view._step()
    return {mark.label: mark for mark in view._step_scene.marks}


def test_step_draws_the_triangle_between_shoulder_elbow_and_wrist_centre(view):
    """Sides as long as the letters say, corners where the arm has them at its own q."""
    marks = choose(view, "theta_3: the elbow")
    frames = view.robot.frames(Q)
    corners = frames[1][:3, 3], frames[2][:3, 3], frames[4][:3, 3]
    for label, (a, b) in {"a_2": (0, 1), "l_3": (1, 2), "r_c": (0, 2)}.items():
        assert np.allclose(marks[label].points, [corners[a], corners[b]], atol=1e-12)
    sides = [math.dist(*marks[label].points) for label in ("a_2", "l_3")]
    assert sides == pytest.approx([0.27, math.hypot(0.09, 0.295)])
    assert "= 0.5 rad (28.6479 deg)" in view._worked.words.content


@pytest.mark.parametrize("joint", range(6))
def test_arc_of_a_joint_runs_from_one_x_axis_to_the_next(view, joint):
    """About z_{i-1} from x_{i-1} to x_i, at the joint's own place."""
    titles = [step.title for step in view.robot.explain_ik(view.robot.fk(Q), seed=Q).steps]
    title = next(t for t in titles if t.startswith(f"theta_{joint + 1}"))
    arc = choose(view, title)[f"theta_{joint + 1}"]
    before, after = view.robot.frames(Q)[joint : joint + 2]
    rays = arc.points[[1, -1]] - arc.points[0]
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    assert np.allclose(rays, [before[:3, 0], after[:3, 0]], atol=1e-12)


def test_numbers_follow_the_arm_and_a_row_puts_the_step_away(view):
    """Another q, other numbers; an explained row draws alone."""
    choose(view, "theta_3: the elbow")
    said, drawn = view._worked.words.content, view._step_scene.marks
    view.q = Q + 0.1
    assert view._worked.words.content != said
    assert view._step_scene.marks is not drawn
    view._table.choose(2)
    view._explain(2)
    assert view._worked.step == 0
    assert view._step_scene.marks == ()
    choose(view, "The wrist centre")
    assert view._table.row == 0


def test_arm_seen_from_its_tool_is_drawn_where_it_stands():
    """The marks of a reversed chain lie in the arm's own base: the wrist centre on its axis."""
    robot = Robot.from_dh("franka_fer")
    q = np.array([0.1, -0.4, 0.2, -1.9, 0.1, 1.6, 0.5])
    steps = robot.explain_ik(robot.fk(q), seed=q).steps
    step = next(each for each in steps if each.title == "The wrist centre")
    centre = next(mark for mark in step.marks if mark.label == "o_c").points[0]
    shoulder = robot.frames(q)[2][:3, 3]  # axes 1, 2 and 3 meet there
    assert np.allclose(centre, shoulder, atol=1e-9)


def test_letters_are_those_of_the_picture():
    """theta_1 is θ₁, a_2 is a₂; o_c stays."""
    assert [letter(name) for name in ("theta_1", "a_2", "r", "o_c")] == ["θ₁", "a₂", "r", "o_c"]
