"""Configurations exactly at limits: where a family only touches them, and beside a double root.

The cross slide's first two joints are at their upper ends, 1.5 m and 0.4 m.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from ik_referee import gaps

import dh2urdf

H = math.pi / 2

CORNER = np.array([1.5, 0.4, H, H, H, math.pi])
"""A member of a family of joints 1, 2, 3 and 6, which has no other one inside the limits."""


@pytest.fixture(scope="module")
def robot():
    return dh2urdf.Robot.from_dh("cross_slide_arm")


@pytest.mark.parametrize("locked", [{}, *({i: CORNER[i]} for i in range(6))])
@pytest.mark.parametrize("seeded", [False, True])
def test_the_one_member_of_a_family_at_a_corner_of_the_limits_is_found(robot, locked, seeded):
    """The curve of solutions comes to the limits there, and is outside to either side."""
    T = robot.fk(CORNER)
    found = robot.ik(T, seed=CORNER if seeded else None, locked=locked or None)
    assert gaps(robot.chain, found.q, CORNER).min() < 1e-9
    assert robot.why_unreachable(T) == ""


@pytest.mark.parametrize("away", [1e-6, 1e-3])
def test_a_family_that_ends_before_the_limits_has_no_member_in_them(robot, away):
    """The corner a little farther in, the curve passes it by outside."""
    T = robot.fk(CORNER + away * np.array([1, 1, 0, 0, 0, 0]))
    assert len(robot.ik(T)) == 0
    assert len(robot.ik(T, within_limits=False)) == 1
    assert "all 1 solutions are outside the joint limits" in robot.why_unreachable(T)


def test_why_a_pose_is_not_reached_looks_at_all_members_of_a_family(robot):
    """One of them is inside the limits, whichever represents the family."""
    T = robot.fk([1.4, 0.3, H, H, H, math.pi])
    assert len(robot.ik(T)) == 1
    assert robot.why_unreachable(T) == ""


@pytest.mark.parametrize("joint", range(6))
def test_a_double_root_on_two_limits_is_found_with_any_joint_held(robot, joint):
    """Off by a nanometre there, which the pose hardly tells, it is put onto them by all joints."""
    q = np.array([1.5, 0.4, H, 0.0, 0.0, 0.0])
    found = robot.ik(robot.fk(q), locked={joint: q[joint]})
    assert gaps(robot.chain, found.q, q).min() < 1e-7
    assert (found.q <= robot.upper).all()


SINGULAR_CORNERS = [
    *(("kinova_jaco2", end) for end in ("lower", "upper")),
    *(("fanuc_crx10ia", end) for end in ("lower", "upper")),
    ("xarm6", (2.0 * math.pi, 0.0, 0.0, -math.pi, math.pi, math.pi)),
]
"""Singular configurations on limits, of which the roots are off by the root of rounding."""


@pytest.mark.parametrize(("name", "end"), SINGULAR_CORNERS)
@pytest.mark.parametrize("ask", [{}, {"turns": "all"}], ids=["nearest", "all"])
def test_a_singular_seed_on_limits_is_the_first_answer(name, end, ask):
    """No joint is a full turn away because its root is over the limit by 1e-7."""
    arm = dh2urdf.Robot.from_dh(name)
    q = np.array(getattr(arm, end) if isinstance(end, str) else end)
    for _ in range(2):  # by Python first, then in one call
        found = arm.ik(arm.fk(q), seed=q, **ask)
        assert np.abs(found.q[0] - q).max() < 1e-6
        assert (found.q >= arm.lower).all()
        assert (found.q <= arm.upper).all()
        assert (found.verify() <= 1e-9).all()


@pytest.mark.parametrize("name", ["kinova_jaco2", "fanuc_crx10ia"])
def test_all_turns_of_a_singular_solution_on_limits_have_those_on_the_limits(name):
    """Without a seed, too: what rounding took over a limit is put onto it."""
    arm = dh2urdf.Robot.from_dh(name)
    for q in (arm.lower, arm.upper):
        found = arm.ik(arm.fk(q), turns="all").q
        assert np.abs(found - q).max(axis=1).min() < 1e-6


@pytest.mark.parametrize("name", ["puma560", "ur5", "franka_fer", "stanford", "abb_irb4600_track"])
def test_without_limits_full_turns_are_those_nearest_to_the_seed(name):
    """Be they inside the limits or not: of one pose, of a batch, of families, of a path."""
    arm = dh2urdf.Robot.from_dh(name)
    turning = ~arm.slides
    for q in (0.3 + 0.1 * np.arange(arm.n), np.where(np.arange(arm.n) == 4, 0.0, 0.7)):
        far = q + 2.0 * math.pi * np.where(np.arange(arm.n) % 2, 1.0, -1.0) * turning
        T = arm.fk(far)
        for _ in range(2):
            found = arm.ik(T, seed=far, within_limits=False)
            assert np.abs(found.q[0] - far).max() < 1e-6
        one = arm.ik_batch(T[None], within_limits=False).nearest(far, within_limits=False)
        assert np.abs(one.q[0, 0] - far).max() < 1e-6


def test_a_path_without_limits_goes_on_where_it_leaves_them():
    """No joint jumps by a full turn to be inside."""
    arm = dh2urdf.Robot.from_dh("puma560")
    way = np.array([0.3, 0.4, 0.2, 0.5, 0.6, 0.7]) + np.linspace(0.0, 6.0, 60)[:, None] * [
        *(1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    ]
    found = arm.ik_path(arm.fk(way), start=way[0], within_limits=False)
    assert found.breaks == ()
    assert np.abs(found.q - way).max() < 1e-6


SINGULAR_HELD = [
    ("abb_irb4600_track", 5, (7.7901182782100795, 0.0, 0.0, "upper", -H, "upper", -math.pi)),
    ("kuka_iiwa14", 3, (-H, "upper", 0.0, "lower", H, H, -H / 2)),
    (
        "mycobot_280",
        None,
        ("upper", -4.6e-6, 1.267e-5, "upper", -1.5708000239728597, -0.38887369492496154),
    ),
]
"""Configurations on limits where more than two solutions meet, or a family turns back: with the
joint that is held."""


@pytest.mark.parametrize(("name", "joint", "values"), SINGULAR_HELD)
@pytest.mark.parametrize("seeded", [False, True])
def test_solutions_that_meet_on_limits_are_found_there(name, joint, values, seeded):
    """Their roots are off by 1e-5 or 1e-4; one of six joints that move is put where it is known."""
    arm = dh2urdf.Robot.from_dh(name)
    q = np.array([getattr(arm, x)[i] if isinstance(x, str) else x for i, x in enumerate(values)])
    T, locked = arm.fk(q), {} if joint is None else {joint: q[joint]}
    found = arm.ik(T, seed=q if seeded else None, locked=locked)
    assert gaps(arm.chain, found.q, q).min() < 1e-6
    assert (found.verify() <= 1e-9).all()
    batch = arm.ik_batch(T[None], locked={i: np.array([x]) for i, x in locked.items()})
    assert gaps(arm.chain, batch.q[0, : batch.count[0]], q).min() < 1e-6
    assert arm.why_unreachable(T, locked=locked) == ""


def test_a_regular_solution_beyond_a_limit_is_not_put_onto_it():
    """A micrometre or less beyond, the others make up for it; farther, the pose is not reached."""
    table = dh2urdf.load_table("puma560")
    q = 0.3 * np.arange(1, 7)
    for over in (1e-5, 1e-4, 5e-4):
        rows = list(table.rows)
        rows[3] = replace(rows[3], lower=q[3] - 0.5, upper=q[3] - over)
        arm = dh2urdf.Robot.from_dh(replace(table, rows=tuple(rows)))
        found = arm.ik(arm.fk(q), within_limits=False)
        assert gaps(arm.chain, found.q, q).min() < 1e-9
        found = arm.ik(arm.fk(q))
        assert gaps(arm.chain, found.q, q).min(initial=9.0) > 0.1
