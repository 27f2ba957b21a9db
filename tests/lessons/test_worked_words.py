"""What worked solutions say in words is so."""

import math
from dataclasses import replace

import numpy as np
import pytest

import dh2urdf
from dh2urdf.lessons.arm import arm_of
from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.eliminated import led_by
from dh2urdf.lessons.way import Asked, Way


def test_the_last_step_says_how_many_solutions_there_are():
    """Their number, whether they are within the limits, which are not, and which is explained."""
    robot = dh2urdf.Robot.from_dh("denso_vs6556")
    T = robot.fk([0.3, 0.5, 1.0, 0.4, 0.7, 0.2])
    inside, every = robot.ik(T), robot.ik(T, within_limits=False)
    assert 1 < len(inside) < len(every)
    words = robot.explain_ik(T).steps[-1].words
    assert words.startswith(f"`ik` finds {len(inside)} solutions within the joint limits; ")
    assert "outside the limits" not in words
    words = robot.explain_ik(every, 1).steps[-1].words
    counted = f"`ik` finds {len(every)} solutions, those outside the joint limits counted; "
    assert words.startswith(counted)
    assert words.count("outside the limits") == len(every) - len(inside)
    assert [line[:2] for line in words.splitlines() if line.endswith("  <- this one")] == ["2:"]
    assert "whole turns" not in words
    turns = robot.explain_ik(robot.ik(T, turns="all")).steps[-1].words
    assert "other choices on the way, or whole turns, to the others" in turns
    narrow = robot.ik(T, seed=every.q[1], seed_tolerance=1e-3, within_limits=False)
    assert "finds 1 solution" in robot.explain_ik(narrow).steps[-1].words


def test_orientation_behind_three_slides_is_said_to_be_constant():
    """R_3^0 is known from the joints that turn; behind slides alone it is always the same."""
    quarter = math.pi / 2
    alphas = [-quarter, -quarter, 0.0, quarter, -quarter, 0.0]
    rows = [[-quarter * (i == 1), 0.0, 0.0, alpha] for i, alpha in enumerate(alphas)]
    table = dh2urdf.DHTable.from_array(rows, convention="standard", joint_types="PPPRRR")
    gantry = dh2urdf.Robot.from_dh(table)
    told = gantry.explain_ik(gantry.fk([0.5, 0.3, 0.2, 0.1, 0.2, 0.3]), within_limits=False)
    said = next(s.words for s in told.steps if s.title == "What is left of the orientation")
    assert said.startswith("R_3^0 is the same for all slides")
    stanford = dh2urdf.Robot.from_dh("stanford")
    told = stanford.explain_ik(stanford.fk([0.5, 0.3, 0.2, 0.1, 0.2, 0.3]), within_limits=False)
    said = next(s.words for s in told.steps if s.title == "What is left of the orientation")
    assert said.startswith("R_3^0 is known from theta_1, theta_2, so R")


STANDS = {
    "upright": dh2urdf.Origin(),
    "hanging": dh2urdf.Origin((0.0, 0.0, 1.0), (math.pi, 0.0, 0.0)),
    "on a wall": dh2urdf.Origin((0.0, 0.0, 1.0), (0.0, math.pi / 2, 0.0)),
}


def pairs_of_elbows(found):
    """Places of solutions that differ in the elbow alone: (up, down)."""
    at = {branch: k for k, branch in enumerate(found.branch)}
    for branch, k in at.items():
        other = at.get(branch.replace("elbow up", "elbow down"), k)
        if other != k:
            yield k, other


@pytest.mark.parametrize("stand", STANDS)
@pytest.mark.parametrize("name", ["denso_vs6556", "ur5", "mycobot_280", "planar_rr"])
def test_an_elbow_called_up_that_is_the_lower_one_is_said_to_be_so(name, stand):
    """Names are of an arm that leans forward: leaning back, the step says which elbow it is."""
    robot = dh2urdf.Robot.from_dh(replace(dh2urdf.load_table(name), base=STANDS[stand]))
    task = "position" if name == "planar_rr" else "pose"
    last = 1 if name == "planar_rr" else 2  # the frame that the elbow carries
    rng, seen = np.random.default_rng(14), set()
    for _ in range(20):
        T = robot.fk(rng.uniform(-2.5, 2.5, robot.n))
        found = robot.ik(T, task=task, within_limits=False)
        for up, down in pairs_of_elbows(found):
            z_up, z_down = (robot.frames(found.q[k])[last][2, 3] for k in (up, down))
            for k, upper in ((up, z_up > z_down), (down, z_down > z_up)):
                told = robot.explain_ik(found, k, task=task)
                words = next(s.words for s in told.steps if s.choice == "elbow")
                side = "upper" if upper else "lower"
                usual = upper == (k == up) or abs(z_up - z_down) < 1e-9
                assert ("of the two" in words) is not usual
                assert usual or f"the elbow is the {side} of the two" in words
                seen.add(usual)
    level = name == "planar_rr" and stand != "on a wall"
    assert seen == ({True} if level else {True, False})


def test_double_roots_that_rounding_loses_are_not_denied():
    """A polynomial of which rounding leaves no real root is not said to have none."""
    arm = arm_of(dh2urdf.Robot.from_dh("abb_gofa5").chain, None)
    asked = Asked(arm, np.eye(4), np.full(6, 0.5))
    way = led_by(asked, Way(), 0, "A polynomial. ", Curve("q_1", np.ones(72), ()))
    assert way.steps[-1].words.startswith("A polynomial. Its real roots meet in pairs here")
    assert "the joint itself is at 0.5 rad" in way.steps[-1].words
    assert way.variables[0] == arm.variable(0, 0.5)
    stopped = led_by(replace(asked, guide=None), Way(), 0, "", Curve("q_1", np.ones(72), ()))
    assert stopped.stopped
    assert stopped.steps[-1].words == "It has no real roots: here the solution ends."


def test_squares_in_sentences_are_formulas():
    """x^2 in Markdown is between dollar signs, as the letters with an index are."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    told = robot.explain_ik(robot.fk([0.3, 0.8]), task="position")
    assert "$x^2$ + $y^2$ = $\\ell_{1}^{2}$" in told.markdown


def test_value_that_a_held_solver_was_tried_at_is_told_as_an_example():
    """Held at 0.3 rad, what stands in the solver's own words about another value is an example."""
    denso = dh2urdf.Robot.from_dh("denso_vs6556")
    told = denso.explain_ik(denso.fk(np.full(6, 0.3)), locked={1: 0.3})
    assert "joint_2 at 0.3 rad" in told.steps[0].words
    words = next(s.words for s in told.steps if s.title == "The solver").splitlines()
    example = words.index("a solver is made for each value, such as this one")
    assert [k for k, line in enumerate(words) if line.startswith("held: ")] == [example + 1]


def test_no_steps_are_said_to_lead_where_there_are_none():
    """An arm that only its solver's words explain: solutions are counted, none is marked."""
    denso = dh2urdf.Robot.from_dh("denso_vs6556")
    told = denso.explain_ik(denso.fk(np.full(6, 0.3)), locked={1: 0.3})
    assert told.q is None
    words = told.steps[-1].words
    assert words.splitlines()[0].endswith(" with what is held within the joint limits.")
    assert "this one" not in words
    assert "above" not in words
