"""Formulas of inverse kinematics against the kernels, on random arms of every family."""

import ast
import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import dh2urdf
from dh2urdf.cli import main
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.dh import DHRow, DHTable, JointType, Origin
from dh2urdf.exceptions import NoSolverError
from dh2urdf.symbolic import symbolic_ik

FOLDER = Path(__file__).parents[2]
RIGHT = math.pi / 2
CLOSE = 1e-10
SINGULAR = 1e-3
"""Smallest singular value of the Jacobian below which a configuration is left out."""

POSITION_ARMS = {
    # kinds and (alpha, a) of rows 1 and 2: R is random, T a right angle, 0 none, P half a turn
    "RRR, 2 || 3": ("RRR", "RR", "0R"),
    "RRR, 2 anti-parallel to 3": ("RRR", "TR", "PR"),
    "RRR, 1 || 2": ("RRR", "0R", "RR"),
    "RRR, 1 meets 2": ("RRR", "R0", "RR"),
    "RRP, 1 meets 2": ("RRP", "R0", "RR"),
    "RRP, 1 || 2": ("RRP", "0R", "RR"),
    "RPR, across": ("RPR", "TR", "RR"),
    "RPR, along": ("RPR", "0R", "0R"),
    "RPR, cylinder": ("RPR", "0R", "TR"),
    "PRR, across": ("PRR", "TR", "RR"),
    "PRR, along": ("PRR", "0R", "0R"),
    "PRR, along and across": ("PRR", "PR", "TR"),
    "RPP": ("RPP", "RR", "RR"),
    "PRP": ("PRP", "RR", "RR"),
    "PPR": ("PPR", "RR", "RR"),
    "PPP": ("PPP", "RR", "RR"),
}


def value(letter, rng, size):
    """A parameter of a kind."""
    if letter == "R":
        return size * rng.uniform(0.4, 1.1) * rng.choice([-1, 1])
    return {"0": 0.0, "T": RIGHT * rng.choice([-1, 1]), "P": math.pi}[letter]


def table_of(kinds, shapes, rng, **fixed):
    """A table of kinds and of (alpha, a) for each row, with offsets, signs, base and tool."""
    types = {"R": JointType.REVOLUTE, "P": JointType.PRISMATIC}
    rows = []
    for i, (kind, (alpha, a)) in enumerate(zip(kinds, shapes, strict=True)):
        theta = rng.choice([0.0, RIGHT, 0.3]) if kind == "R" else value("T", rng, 1.0)
        d = fixed.get(f"d_{i + 1}", rng.uniform(-0.4, 0.4))
        row = {"theta": theta, "d": d, "a": value(a, rng, 0.5), "alpha": value(alpha, rng, 1.0)}
        limits = {} if kind == "R" else {"lower": -2.0, "upper": 2.0}
        rows.append(DHRow(**row, joint_type=types[kind], sign=int(rng.choice([-1, 1])), **limits))
    base, tool = (Origin(tuple(rng.uniform(-1, 1, 3)), tuple(rng.uniform(-1, 1, 3))) for _ in "bt")
    return DHTable(tuple(rows), "standard", "random", base=base, tool=tool)


def wrist_arm(kind, oblique, seed):
    """A position arm with a wrist."""
    rng = np.random.default_rng(seed)
    kinds, first, second = POSITION_ARMS[kind]
    twist = "R" if oblique else "T"
    third, last = ("RR", "RR") if seed % 2 else ("TR", "00")
    shapes = (first, second, third, twist + "0", twist + "0", last)
    return table_of(kinds + "RRR", shapes, rng, d_5=0.0)


def check(table, seed=0, poses=12):
    """Every regular solution of the kernel is a branch of the formulas; returns how many."""
    robot = dh2urdf.Robot.from_dh(table)
    solve, rng, count = robot.symbolic_ik().function, np.random.default_rng(seed), 0
    for _ in range(poses):
        T = robot.fk(rng.uniform(*robot.bounded(1.0, math.pi)))
        branches = np.array(solve(T.tolist())).reshape(-1, robot.n)
        for q in robot.ik(T, within_limits=False).q:
            if np.linalg.svd(robot.jacobian(q), compute_uv=False)[-1] < SINGULAR and robot.n == 6:
                continue
            gaps = branches - q
            turns = ~robot.slides
            gaps[:, turns] = np.remainder(gaps[:, turns] + math.pi, 2 * math.pi) - math.pi
            assert np.abs(gaps).max(axis=1).min(initial=np.inf) < CLOSE, (table, q)
            count += 1
    assert count > 0
    return count


SEEDS = [
    pytest.param(range(2), id=""),
    pytest.param(range(2, 30), id="many", marks=pytest.mark.exhaustive),
]


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("oblique", [False, True])
@pytest.mark.parametrize("kind", POSITION_ARMS)
def test_every_solution_of_a_spherical_wrist_is_a_branch(kind, oblique, seeds):
    """Random lengths, twists, offsets, signs, base and tool; square wrists and oblique ones."""
    for seed in seeds:
        check(wrist_arm(kind, oblique, seed))


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("twists", ["00", "0P", "P0", "PP"])
def test_every_solution_of_three_parallel_axes_is_a_branch(twists, seeds):
    """Axes 2, 3, 4 parallel in either direction, axis 5 across or oblique."""
    for seed in seeds:
        rng = np.random.default_rng(seed)
        t = "TR"[seed % 2]
        shapes = (t + "R", twists[0] + "R", twists[1] + "R", t + "R", t + "0", t + "R")
        check(table_of("RRRRRR", shapes, rng))


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("twists", ["00", "0P", "PP"])
@pytest.mark.parametrize("joints", [4, 5])
def test_every_solution_of_four_or_five_joints_is_a_branch(joints, twists, seeds):
    """A turntable, three parallel axes, and a last joint across them or none."""
    for seed in seeds:
        t = "TR"[seed % 2]
        shapes = (t + "R", twists[0] + "R", twists[1] + "R", t + "R", "RR")[:joints]
        check(table_of("R" * joints, shapes, np.random.default_rng(seed)))


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("twists", ["00", "0P", "P0", "PP"])
def test_every_solution_of_three_parallel_axes_at_the_base_is_a_branch(twists, seeds):
    """Axes 1, 2, 3 parallel in either direction, axes 4 and 5 across or oblique, and mirrored."""
    for seed in seeds:
        t = "TR"[seed % 2]
        shapes = (twists[0] + "R", twists[1] + "R", t + "R", t + "R", t + "0", t + "R")
        table = table_of("RRRRRR", shapes, np.random.default_rng(seed))
        check(table)
        chain = dh2urdf.Robot.from_dh(table).chain.reversed()
        check(chain_to_dh(chain, compact=False).table, poses=4)


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("kind", ["RRR, 2 || 3", "RRP, 1 meets 2", "PPR", "three parallel"])
def test_every_solution_of_a_mirrored_arm_is_a_branch(kind, seeds):
    """A shoulder whose axes meet; axes 3, 4, 5 that are parallel: arms seen from the tool."""
    for seed in seeds:
        if kind == "three parallel":
            rng = np.random.default_rng(seed)
            table = table_of("RRRRRR", ("TR", "0R", "0R", "TR", "T0", "0R"), rng)
        else:
            table = wrist_arm(kind, False, seed)
        turned = chain_to_dh(dh2urdf.Robot.from_dh(table).chain.reversed(), compact=False).table
        assert "from the tool" in dh2urdf.Robot.from_dh(turned).symbolic_ik().family
        check(turned)


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("kinds", ["RRR", "RRPR", "RRRP", "PRRR", "RPRR", "RPR"])
@pytest.mark.parametrize("flip", ["0", "P"])
def test_every_solution_of_a_planar_arm_is_a_branch(kinds, flip, seeds):
    """Planar RRR, the four SCARA arms, and the notes' RPR with its slide across."""
    for seed in seeds:
        rng = np.random.default_rng(seed)
        if kinds == "RPR":
            table = table_of(kinds, ["TR", "TR", "0R"], rng)
            first, slide, last = table.rows
            across = replace(slide, theta=0.0, alpha=-first.alpha)
            table = replace(table, rows=(first, across, last))
        else:
            table = table_of(kinds, ["0R", flip + "R", "0R", "0R"][: len(kinds)], rng)
        check(table)


@pytest.mark.parametrize("name", dh2urdf.list_tables())
def test_shipped_arms_have_formulas_or_a_reason(name):
    """Every shipped arm with a closed form has formulas; the others are told what is covered."""
    robot = dh2urdf.Robot.from_dh(name)
    if robot.is_coupled:
        with pytest.raises(NoSolverError, match="follow"):
            robot.symbolic_ik()
        return
    closed = {"spherical wrist", "three parallel axes", "planar arm"}
    if str(robot.solver) in closed or robot.n < 6:
        check(robot.table, poses=5)
    else:
        with pytest.raises(NoSolverError, match="formulas cover: spherical wrists"):
            robot.symbolic_ik()


def run(*arguments):
    """The status of a call of the command line."""
    with pytest.raises(SystemExit) as status:
        main(arguments)
    return status.value.code


def test_formulas_of_the_planar_arm_are_the_notes():
    """Section 8.2: theta_2 from the cosine, theta_1 as the difference of two arctangents."""
    lines = [line.strip() for line in symbolic_ik("planar_rr").text.splitlines()]
    for line in (
        "D_2 = (p_x^2 + p_y^2 \N{MINUS SIGN} a_1^2 \N{MINUS SIGN} a_2^2)/(2·a_1·a_2)",
        "θ_1 = atan2(p_y, p_x) \N{MINUS SIGN} atan2(a_2·s_2, a_1 + a_2·c_2)",
    ):
        assert line in lines


def test_formulas_of_the_denso_arm_are_those_of_decoupling():
    """Section 8.3, equation (5): x_c = o_x - r_13 d_6, and so on."""
    text = symbolic_ik("denso_vs6556").text
    for i, axis in enumerate("xyz", 1):
        assert f"{axis}_c = p_{axis} \N{MINUS SIGN} d_6·r_{i}3" in text


def test_python_needs_nothing_but_math(tmp_path):
    """The function runs in a Python without packages, its one import is that of math."""
    found = symbolic_ik("ur5")
    imports = [n for n in ast.walk(ast.parse(found.python)) if isinstance(n, ast.ImportFrom)]
    assert [n.module for n in imports] == ["math"]
    (tmp_path / "arm.py").write_text(found.python, encoding="utf-8")
    T = dh2urdf.Robot.from_dh("ur5").fk([0.3, -1.0, 1.2, -0.4, 0.9, 0.2]).tolist()
    call = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import arm; print(arm.ik({T}))"
    command = [sys.executable, "-I", "-S", "-c", call]
    answer = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout
    assert json.loads(answer) == found.function(T)


def test_letters_of_the_python_may_be_given_other_values():
    """Lengths are arguments whose defaults are the table's: one function for a family of arms."""
    solve = symbolic_ik("planar_rr").function
    T = dh2urdf.Robot.from_dh(DHTable.from_array([[0, 0, 0.5, 0], [0, 0, 0.4, 0]], "standard")).fk(
        [0.3, 0.8]
    )
    assert [0.3, 0.8] in np.round(solve(T.tolist(), a_1=0.5, a_2=0.4), 12).tolist()


@pytest.mark.parametrize("name", ["puma560", "stanford", "ur5", "gantry_wrist", "rpr_new_frame"])
def test_poses_with_a_free_joint_have_branches_or_none(name):
    """At the zero configuration and with the wrist centre on axis 1 nothing is divided by zero."""
    solve = symbolic_ik(name).function
    robot = dh2urdf.Robot.from_dh(name)
    for T in (robot.fk(np.clip(0.0, robot.lower, robot.upper)), np.eye(4)):
        for q in solve(T.tolist()):
            assert np.isfinite(q).all()


@pytest.mark.parametrize("name", ["puma560", "denso_vs6556", "stanford", "abb_irb120"])
def test_every_branch_reaches_a_pose_with_axes_4_and_6_in_one_line(name):
    """With joint 5 at zero joint 4 is free: a branch has one value of it and reaches the pose."""
    robot = dh2urdf.Robot.from_dh(name)
    T = robot.fk([0.3, -0.5, 0.7, 0.4, 0.0, 0.2])
    errors = [np.abs(robot.fk(q) - T).max() for q in symbolic_ik(name).function(T.tolist())]
    assert len(errors) == 8
    assert max(errors) < 1e-12


@pytest.mark.parametrize("name", ["px100", "px150", "vx250"])
def test_few_joints_with_their_point_on_axis_1_take_joint_1_from_the_orientation(name):
    """An arm of four or five joints stands upright: each solution of the robot is a branch."""
    robot = dh2urdf.Robot.from_dh(name)
    solve, upright, rng = symbolic_ik(name).function, 0, np.random.default_rng(0)
    for _ in range(60):
        T = robot.fk(rng.choice([-RIGHT, 0.0, RIGHT, math.pi], robot.n))
        errors = [np.abs(robot.fk(q) - T).max() for q in solve(T.tolist())]
        assert min(errors) < CLOSE
        upright += np.hypot(*T[:2, 3]) < CLOSE
    assert upright > 0


def test_latex_is_balanced():
    """Every align* that begins ends, and braces pair up."""
    latex = symbolic_ik("puma560").latex
    assert latex.count(r"\begin{align*}") == latex.count(r"\end{align*}") > 0
    assert latex.count("{") == latex.count("}")


def test_a_robot_of_a_urdf_has_formulas_in_the_letters_of_the_table_found():
    """Without a table, frame assignment gives one; its solutions are the robot's."""
    urdf = FOLDER / "urdf" / "puma560.urdf"
    robot = dh2urdf.Robot.from_urdf(urdf)
    found = robot.symbolic_ik()
    T = robot.fk([0.3, -1.0, 1.2, -0.4, 0.9, 0.2])
    errors = [np.abs(found.table.fk(q) - T).max() for q in found.function(T.tolist())]
    assert len(errors) == 8
    assert max(errors) < CLOSE


def test_a_fixed_step_between_joints_is_refused_or_assigned():
    """The four letters of a row say nothing of a step by inspection."""
    step = DHRow(joint_type=JointType.FIXED, origin=Origin((0.1, 0.0, 0.0)))
    rows = dh2urdf.load_table("planar_rr").rows
    table = DHTable((rows[0], step, rows[1]), "standard")
    with pytest.raises(NoSolverError, match="fixed steps between"):
        symbolic_ik(table)
    assert dh2urdf.Robot.from_dh(table).symbolic_ik().family == "planar arm"


@pytest.mark.parametrize("form", ["text", "markdown", "latex", "python"])
def test_the_verb_prints_what_the_robot_says(form, capsys):
    """``dh2urdf ik ARM --symbolic --format FORM`` needs no pose and has status 0."""
    assert run("ik", "planar_rrr", "--symbolic", "--format", form) == 0
    said = getattr(symbolic_ik("planar_rrr"), form)
    assert capsys.readouterr().out == said.rstrip() + "\n"


@pytest.mark.parametrize("more", ["--task position", "--turns all", "--no-within-limits"])
def test_the_verb_refuses_what_formulas_do_not_heed(more, capsys):
    """Formulas are for the pose and leave limits aside: options on these are not passed over."""
    assert run("ik", "ur5", "--symbolic", *more.split()) == 2
    assert f"--symbolic stands alone: {more} does nothing" in capsys.readouterr().err


def test_the_verb_refuses_a_pose_and_names_what_is_covered(capsys):
    """A pose beside --symbolic, and an arm without formulas, are one message and status 2."""
    assert run("ik", "ur5", "--symbolic", "--xyz=0.1,0.2,0.3") == 2
    assert "--symbolic stands alone: --xyz" in capsys.readouterr().err
    assert run("ik", "xarm6", "--symbolic") == 2
    assert "formulas cover: spherical wrists" in capsys.readouterr().err
