"""Worked solutions: every value is the kernel's, every formula gives its value."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from formulas import is_plain, off

import dh2urdf
from dh2urdf.lessons.case import Case
from dh2urdf.lessons.circle import real_roots
from dh2urdf.lessons.elimination import Elimination, links_of
from dh2urdf.lessons.two_parallel import Polynomial, two_parallel
from dh2urdf.lessons.way import Asked
from dh2urdf.robot.explained import question_of

ROUNDING = 1e-12
"""What the value of a step may differ from the kernel's by [rad or m]."""

REGULAR = 1e-3
"""Smallest singular value of the Jacobian, lengths in sizes of the arm, of configurations that are
compared to `ROUNDING`: nearer to a singular one both sides have rounding over that value."""


NO_CLOSED_FORM = {
    "abb_gofa5",
    "fanuc_crx10ia",
    "fanuc_crx10ia_l",
    "kinova_jaco2",
    "niryo_ned2",
    "xarm6",
}

COUPLED = {"abb_irb460", "abb_irb5400", "fanuc_r1000ia80f"}
"""Arms of which values move joints together; their lessons have tests of their own."""

SLIDING = {"cross_slide_arm"}
"""Its solver and solutions are told, its steps are not worked out."""

ARMS = tuple(sorted(set(dh2urdf.list_tables()) - NO_CLOSED_FORM - COUPLED - SLIDING))

KINDS = tuple("".join(kinds) for kinds in itertools.product("RP", repeat=3))


def smallest(robot, q, moving=slice(None)):
    """Smallest singular value of the joints that move, lengths in sizes of the arm."""
    J = robot.jacobian(q)
    J[:3] /= robot.chain.size
    return np.linalg.svd(J[:, moving], compute_uv=False)[-1]


def regular_poses(robot, count, rng):
    """Poses of random configurations that are away from singular ones."""
    while count:
        q = np.where(robot.slides, 0.5, 3.0) * rng.uniform(-1.0, 1.0, robot.n)
        if smallest(robot, q) > REGULAR:
            count -= 1
            yield robot.fk(q)


def missed(robot, T, q):
    """By how much a configuration q (n,) misses a pose, in [rad] and sizes of the arm."""
    F = robot.fk(q)
    turn = 0.5 * np.cross(F[:3, :3], T[:3, :3], axisa=0, axisb=0).sum(axis=0)
    return np.linalg.norm([*(T[:3, 3] - F[:3, 3]) / robot.chain.size, *turn])


def allowed(robot, case, q, rounding):
    """What a value may be off at a solution q (n,) of the kernels [rad or m].

    `rounding`, and where the arm is nearly singular, or the kernel's solution not as sharp as can
    be, what it misses the pose by over the smallest singular value: nobody can tell closer.
    """
    missing = rounding * REGULAR + missed(robot, case.question.T, q)
    return max(rounding, missing / smallest(robot, q, sorted(case.joints)))


def assert_agrees(robot, T, one, rounding=ROUNDING):
    """The kernel's solutions are the derivation's; the steps of one end in its values."""
    found = robot.ik(T, within_limits=False)
    held = question_of(robot, found).held or None
    if held:  # a sample of a joint to spare: all that there is at its value
        found = robot.ik(T, within_limits=False, locked=held)
    case = Case(question_of(robot, found, locked=held))
    ways = [case.values(way) for way in case.ways() if not way.stopped]
    kernel = [q[case.joints] for q in case.question.q]
    assert len(ways) == len(kernel), (robot.table.name, T)
    for q, p in zip(case.question.q, kernel, strict=True):
        gap = min(case.apart(way, p) for way in ways)
        assert gap <= allowed(robot, case, q, rounding), (robot.table.name, T, p)
    told = robot.explain_ik(found, one % len(found), locked=held)
    q = found.q[one % len(found)]
    rounding = allowed(robot, case, q, rounding)
    assert np.abs(told.q - q).max() <= rounding
    for step in told.steps:
        if step.joint is not None:
            gap = step.value - q[step.joint]
            gap -= 0.0 if robot.slides[step.joint] else math.tau * round(gap / math.tau)
            assert abs(gap) <= rounding, (robot.table.name, step.title, T)
        for equation in step.equations:
            if is_plain(equation):
                assert off(equation) <= 1e-9, (robot.table.name, step.title, equation.name)


@pytest.mark.parametrize("name", ARMS)
def test_values_of_the_steps_are_the_kernels(name):
    """All solutions of 4 random poses, to 1e-12, and each formula gives the value beside it."""
    robot = dh2urdf.Robot.from_dh(name)
    for k, T in enumerate(regular_poses(robot, 4, np.random.default_rng(5))):
        assert_agrees(robot, T, k)


def wrist_arm(kinds, rng):
    """A table with a spherical wrist, right-angled or skew, behind three joints of any kind."""
    rows = rng.uniform(-0.5, 0.5, (6, 4)) * [2.0, 1.0, 1.0, 4.0]
    rows[3:5, 2] = rows[4, 1] = 0.0
    rows[3:5, 3] = rng.uniform(0.6, 2.4, 2) if rng.integers(2) else (0.5 * np.pi, -0.5 * np.pi)
    return dh2urdf.DHTable.from_array(rows, "standard", joint_types=kinds + "RRR", name=kinds)


@pytest.mark.parametrize("kinds", KINDS)
def test_any_three_joints_place_the_wrist_as_the_kernels_do(kinds):
    """Random arms, turning and sliding, with right-angled and skew wrists."""
    rng = np.random.default_rng(7)
    for _ in range(3):
        robot = dh2urdf.Robot.from_dh(wrist_arm(kinds, rng))
        for k, T in enumerate(regular_poses(robot, 2, rng)):
            assert_agrees(robot, T, k, 1e-10)


LAST_TWO = {"apart": {}, "meeting": {(4, 2): 0.0}, "parallel": {(4, 3): 0.0}}
"""Entries of a table, by row and column (theta, d, a, alpha), of how axes 5 and 6 may lie."""


def arm_with(entries, rng):
    """Random turns, with entries of the table where they are given."""
    rows = rng.uniform(-0.5, 0.5, (6, 4)) * [2.0, 1.0, 1.0, 4.0]
    for place, value in entries.items():
        rows[place] = value
    return dh2urdf.Robot.from_dh(dh2urdf.DHTable.from_array(rows, "standard"))


@pytest.mark.parametrize("last", LAST_TWO)
def test_axes_1_2_3_parallel_leave_two_equations_in_joints_4_and_5(last):
    """Random arms whose axes 5 and 6 are anyhow, meet, or are parallel."""
    rng = np.random.default_rng(14)
    for _ in range(3):
        robot = arm_with({(0, 3): 0.0, (1, 3): 0.0} | LAST_TWO[last], rng)
        assert robot.solver.name == "three parallel axes"
        for k, T in enumerate(regular_poses(robot, 3, rng)):
            assert_agrees(robot, T, k, 1e-10)


def test_axes_4_5_6_parallel_are_1_2_3_seen_from_the_tool():
    """Random arms, turned round."""
    rng = np.random.default_rng(15)
    for first in ({}, {(0, 2): 0.0}, {(0, 3): 0.0}):
        robot = arm_with({(3, 3): 0.0, (4, 3): 0.0} | first, rng)
        assert robot.solver.name == "three parallel axes, from the tool"
        for k, T in enumerate(regular_poses(robot, 3, rng)):
            assert_agrees(robot, T, k, 1e-10)


@pytest.mark.parametrize("last", LAST_TWO)
def test_axes_2_3_4_parallel_leave_two_equations_in_joints_1_and_5(last):
    """Random arms whose axes 5 and 6 are anyhow, meet, or are parallel; also from the tool."""
    rng = np.random.default_rng(16)
    entries = {(1, 3): 0.0, (2, 3): 0.0} | LAST_TWO[last]
    from_tool = {(2, 3): 0.0, (3, 3): 0.0} | {(0, j): v for (_, j), v in LAST_TWO[last].items()}
    for robot in (arm_with(which, rng) for which in (entries, entries, from_tool)):
        assert robot.solver.name.startswith("three parallel axes")
        for k, T in enumerate(regular_poses(robot, 3, rng)):
            assert_agrees(robot, T, k, 1e-10)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5])
def test_short_chains_of_any_kind_have_the_null_vectors_of_their_loop(n):
    """Random arms of every kind that move in n directions; poses of theirs, and others."""
    rng = np.random.default_rng(17)
    for kinds in map("".join, itertools.product("RP", repeat=n)):
        if kinds.count("P") > 2 + (n == 3):
            continue
        rows = rng.uniform(-0.5, 0.5, (n, 4)) * [2.0, 1.0, 1.0, 4.0]
        table = dh2urdf.DHTable.from_array(rows, "standard", joint_types=kinds, name=kinds)
        robot = dh2urdf.Robot.from_dh(turned(table) if rng.integers(2) else table)
        for k, T in enumerate(regular_poses(robot, 2, rng)):
            assert_agrees(robot, T, k, 1e-10)
            told = robot.explain_ik(T @ dh2urdf.Origin((0.01, 0.02, 0.03), (0.1, 0.2, 0.3)).matrix)
            assert told.q is None
            assert any(words in told.text for words in ("ends", "end without")), kinds


def test_five_joints_are_explained_by_their_quartic():
    """The real roots of the determinant have the hidden joint of every solution."""
    rng = np.random.default_rng(18)
    for kinds in ("RRRRR", "RRPRR", "PRRRP"):
        rows = rng.uniform(-0.5, 0.5, (5, 4)) * [2.0, 1.0, 1.0, 4.0]
        robot = dh2urdf.Robot.from_dh(
            dh2urdf.DHTable.from_array(rows, "standard", joint_types=kinds)
        )
        told = robot.explain_ik(next(regular_poses(robot, 1, rng)))
        step = next(step for step in told.steps if step.curve)
        assert min(abs(root - step.value) for root in step.curve.roots) <= 1e-6
        assert "degree 4" in step.words


def test_each_of_two_solutions_at_one_root_is_explained():
    """Five joints with right angles, two null vectors at a root: each solution by its values."""
    rows = np.zeros((5, 4))
    rows[:, 1:3] = [0.2, 0.25], [0.3, 0.0], [0.3, 0.3], [0.3, 0.3], [0.0, 0.0]
    rows[:, 3] = 0.5 * np.pi * np.array([1.0, -1.0, 0.0, 0.0, 1.0])
    table = dh2urdf.DHTable.from_array(rows, "standard", joint_types="PRRRR")
    robot = dh2urdf.Robot.from_dh(table)
    found = robot.ik(robot.fk([0.6, 0.7, -0.5, -0.6, -0.9]), within_limits=False)
    assert len(found) == 2
    for k, q in enumerate(found.q):
        assert np.abs(robot.explain_ik(found, k).q - q).max() <= 1e-10


@pytest.mark.parametrize("kind", ["R", "P"])
def test_one_joint_moves_a_point_on_a_circle_or_a_line(kind):
    """Both tasks of an arm of one joint, on a leaning base with a tool; a point off the way."""
    rng = np.random.default_rng(19)
    for form in FORMS.values():
        rows = rng.uniform(-0.5, 0.5, (1, 4)) * [2.0, 1.0, 1.0, 4.0]
        table = dh2urdf.DHTable.from_array(rows, "standard", joint_types=kind)
        robot = dh2urdf.Robot.from_dh(form(table))
        for q in rng.uniform(-1.0, 1.0, (5, 1)):
            T = robot.fk(q)
            for task in ("pose", "position"):
                told = robot.explain_ik(T, task=task)
                assert np.abs(told.q - q).max() <= 1e-10
                assert all(off(e) <= 1e-9 for s in told.steps for e in s.equations if is_plain(e))
            T[:3, 3] += [0.01, 0.02, 0.03]
            told = robot.explain_ik(T, task="position")
            assert told.q is None
            assert "m away" in told.steps[-1].words


@pytest.mark.parametrize("kinds", ["RPPRPR", "PRPRPR", "RPRPRP", "RPPPRR", "PRPRP", "RPPPR"])
def test_three_slides_come_apart_from_the_turns(kinds):
    """Random arms of five and six joints, three of them sliding."""
    rng = np.random.default_rng(13)
    for _ in range(2):
        rows = rng.uniform(-0.5, 0.5, (len(kinds), 4)) * [2.0, 1.0, 1.0, 4.0]
        table = dh2urdf.DHTable.from_array(rows, "standard", joint_types=kinds)
        robot = dh2urdf.Robot.from_dh(table)
        assert robot.solver.name == "three slides"
        for k, T in enumerate(regular_poses(robot, 2, rng)):
            assert_agrees(robot, T, k, 1e-10)


def assert_roots(robot, f, q, joint):
    """Every solution q (k, n) has its joint among the real roots of a polynomial."""
    roots = real_roots(f, 8)
    assert len(roots) <= 16
    for value in q[:, joint]:
        away = [abs(math.remainder(root - value, math.tau)) for root in roots]
        assert min(away) <= 1e-8, (robot.table.name, joint, value)


@pytest.mark.parametrize("name", sorted(NO_CLOSED_FORM))
def test_polynomials_of_arms_without_a_closed_form_have_all_solutions_as_roots(name):
    """The polynomial of axis pairs, in joint 1, and the determinant of five joints eliminated."""
    robot = dh2urdf.Robot.from_dh(name)
    for T in regular_poses(robot, 3, np.random.default_rng(8)):
        found = robot.ik(T, within_limits=False)
        case = Case(question_of(robot, found))
        assert case.lesson is two_parallel
        asked = Asked(case.arm, case.pose(), case.guide)
        assert_roots(robot, Polynomial(asked), found.q, 0)
        each = [Elimination(links_of(asked.arm.rows, asked.H), shift) for shift in range(6)]
        best = min(each, key=lambda one: one.noise)
        assert best.noise < 1e-12
        assert_roots(robot, best, found.q, best.joint)


def test_any_six_turns_are_explained_by_their_determinant():
    """Random arms: the hidden joint's value, its real roots, and the check."""
    rng = np.random.default_rng(9)
    for _ in range(3):
        rows = rng.uniform(-0.5, 0.5, (6, 4)) * [2.0, 1.0, 1.0, 5.0]
        robot = dh2urdf.Robot.from_dh(dh2urdf.DHTable.from_array(rows, "standard"))
        T = next(regular_poses(robot, 1, rng))
        found = robot.ik(T, within_limits=False)
        told = robot.explain_ik(found, len(found) - 1)
        step = next(step for step in told.steps if step.curve)
        roots = {round(root, 6) for root in step.curve.roots}
        assert {round(math.remainder(v, math.tau), 6) for v in found.q[:, step.joint]} <= roots
        assert step.value == pytest.approx(found.q[-1, step.joint], abs=1e-8)
        assert "degree 16" in step.words
        assert "^" in step.curve.text


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_values_of_the_steps_are_the_kernels_for_a_thousand_poses(name):
    """All solutions of 1,000 random poses, to 1e-12."""
    robot = dh2urdf.Robot.from_dh(name)
    for k, T in enumerate(regular_poses(robot, 1000, np.random.default_rng(6))):
        assert_agrees(robot, T, k)


def turned(table):
    """The same arm on a leaning base, with a tool, joints that turn the other way, other zeros."""
    rows = [
        replace(row, sign=-row.sign, theta=row.theta + 0.1 * i)
        if i % 2 and row.joint_type is dh2urdf.JointType.REVOLUTE
        else row
        for i, row in enumerate(table.rows)
    ]
    base = dh2urdf.Origin((0.1, -0.2, 0.3), (0.2, 0.1, -0.4))
    tool = dh2urdf.Origin((0.02, 0.03, 0.05), (0.3, -0.2, 0.1))
    return replace(table, rows=tuple(rows), base=base, tool=tool)


FORMS = {
    "as it ships": lambda table: table,
    "modified": lambda table: dh2urdf.to_convention(table, "modified"),
    "turned": turned,
    "turned and modified": lambda table: dh2urdf.to_convention(turned(table), "modified"),
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(
    "name", ["denso_vs6556", "ur5", "stanford", "px150", "denso_hsr065", "planar_rrr", "franka_fer"]
)
def test_base_tool_signs_and_convention_change_no_value(name, form):
    """Both conventions, mirrored joints, offsets, base and tool: values are the kernel's."""
    robot = dh2urdf.Robot.from_dh(FORMS[form](dh2urdf.load_table(name)))
    for k, T in enumerate(regular_poses(robot, 2, np.random.default_rng(10))):
        assert_agrees(robot, T, k)


def test_robot_of_a_file_is_explained_in_frames_of_its_axes(tmp_path):
    """A URDF has no table: the steps show the frames that they use, and meet the kernel."""
    dh2urdf.write_urdf("ur5", tmp_path / "arm.urdf")
    robot = dh2urdf.Robot.from_urdf(tmp_path / "arm.urdf", tip="tool0")
    T = robot.fk([0.3, -1.2, 1.0, -0.4, 0.8, 0.1])
    told = robot.explain_ik(T)
    assert told.steps[0].title == "The frames"
    assert "standard DH" in told.steps[0].words
    assert np.abs(told.q - robot.ik(T).q[0]).max() <= ROUNDING


def test_tasks_and_held_joints_are_explained():
    """Position alone, position and axis, a joint held or to spare: a smaller arm is left."""
    rng = np.random.default_rng(11)
    cases = [
        ("planar_rr", {"task": "position"}),
        ("cylindrical", {"task": "position"}),
        ("px150", {"task": "position+axis"}),
        ("kuka_iiwa14", {"locked": {"joint_a3": 0.4}}),
        ("franka_fer", {"locked": {6: -0.5}}),
    ]
    for name, asked in cases:
        robot = dh2urdf.Robot.from_dh(name)
        q = np.where(robot.slides, 0.4, rng.uniform(-1.0, 1.0, robot.n))
        for key, value in asked.get("locked", {}).items():
            q[robot.joint_names.index(key) if isinstance(key, str) else key] = value
        T = robot.fk(q)
        found = robot.ik(T, within_limits=False, **asked)
        for k in range(len(found)):
            told = robot.explain_ik(found, k, **asked)
            assert np.abs(told.q - found.q[k]).max() <= 1e-10, (name, asked)
            assert told.solution == k


def test_every_pose_of_a_grid_is_explained_to_its_end():
    """Right angles and their halves, where solutions meet and joints are free, on every arm."""
    rng = np.random.default_rng(12)
    for name in sorted(set(dh2urdf.list_tables()) - COUPLED - SLIDING):
        robot = dh2urdf.Robot.from_dh(name)
        for step in (0.25 * np.pi, 0.5 * np.pi):
            q = np.where(robot.slides, 0.3, step * rng.integers(-2, 3, robot.n))
            T = robot.fk(q)
            told = robot.explain_ik(T, within_limits=False)
            assert told.q is not None, (name, q)
            assert np.abs(robot.fk(told.q) - T).max() < 1e-9, (name, q)
