"""A C file answers what the robot does, whatever compiles it."""

import json
import re
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dh2urdf import DHRow, DHTable, JointType, Robot, export_solver
from dh2urdf.cli import main
from dh2urdf.exceptions import ArgumentError, NameNotFoundError, NoSolverError
from dh2urdf.export.source import exported
from dh2urdf.export.source.head import LICENCE
from dh2urdf.robots import list_tables
from tests.export.source.compiled import COMPILERS, Arm, configurations, edges

FAMILIES = """
puma560 ur5 planar_rr omron_cobra600 px100 rpr_new_frame xarm5 stanford xarm6 cross_slide_arm
"""
"""An arm of each kind of kernels."""

LEFT = {
    "franka_fer": 0.88,
    "franka_fr3": 0.88,
    "kinova_gen3": 0.95,
    "kuka_iiwa14": 0.92,
    "kuka_iiwa7": 0.92,
    "xarm7": 0.9,
}
"""Arms whose files leave poses to ``Robot.ik``, two in three of these singular or beside such, and
what share they do not leave: seven joints of which one is held. All others find all solutions at
every pose."""

EVERY_DAY = 150

HELD = {"franka_fer": 6, "kuka_iiwa14": 2}
"""Joints that are held of arms with one to spare."""

SMALL = 16384
"""Bytes of the stack that an arm's functions take at most."""

SAME = ("-O2", "-ffp-contract=off")


def daily(names, few):
    """Names of a test's arms, of which the daily suite has a few and the marked one all."""
    assert few <= set(names)
    return [pytest.param(n, marks=() if n in few else pytest.mark.exhaustive) for n in names]


def assert_same(found, batch):
    """The solutions of a file are those of the robot, bit for bit, where it says they are all."""
    for i, one in enumerate(found):
        count, whole = int(one["count"]), batch.solutions(i)
        if one["complete"]:
            assert count == len(whole), i
            assert np.array_equal(one["q"][:count], whole.q), i
            assert np.array_equal(one["residual"][:count], whole.residual), i
            branch, free = whole.codes
            assert np.array_equal(one["branch"][:count], branch), i
            assert np.array_equal(one["free"][:count], free), i
        assert (one["residual"][:count] <= 1e-9).all(), i


def compare(arm, q, whole=1.0):
    """Compare a compiled arm with its robot at configurations, of which so many are in no doubt.

    The share of these comes back.
    """
    robot, held = arm.robot, arm.held
    Ts, found = robot.fk(q), arm.run(q)
    assert np.array_equal(found["T"][:50], [robot.fk(x) for x in q[:50]])
    assert np.array_equal(found["J"][:50], [robot.jacobian(x) for x in q[:50]])
    locked = {} if held is None else {"locked": {held: q[:, held]}}
    for key, limits in (("inside", True), ("any", False)):
        assert_same(found[key], robot.ik_batch(Ts, within_limits=limits, **locked))
        rows = np.repeat(np.arange(len(Ts)), found[key]["count"])
        first = np.arange(found[key]["q"].shape[1]) < found[key]["count"][:, None]
        assert np.abs(robot.fk(found[key]["q"][first]) - Ts[rows]).max(initial=0.0) < 2e-9
        assert np.mean(found[key]["complete"]) >= whole
    return float(np.mean(found["inside"]["complete"]))


@pytest.mark.parametrize("name", [*FAMILIES.split(), *HELD])
def test_the_solutions_are_those_of_the_robot(name, tmp_path):
    """Without contraction every number is that of ``Robot.ik``, edge poses included."""
    arm, rng = Arm(Robot.from_dh(name), tmp_path, HELD.get(name)), np.random.default_rng(1)
    arm.compile(*SAME)
    compare(arm, configurations(arm.robot, rng, EVERY_DAY), LEFT.get(name, 1.0))
    compare(arm, edges(arm.robot, rng, EVERY_DAY // 3), 0.0 if name in LEFT else 1.0)


@pytest.mark.parametrize(
    ("name", "held", "whole"), [("xarm7", 0, 0.9), ("ur5", 0, 0.4), ("franka_fer", 0, 0.9)]
)
def test_what_is_told_with_a_joint_held_at_an_end_are_solutions(name, held, whole, tmp_path):
    """Also at poses in doubt, of which the rest of the arm counts its solutions below zero."""
    arm, rng = Arm(Robot.from_dh(name), tmp_path, held), np.random.default_rng(1)
    arm.compile(*SAME)
    compare(arm, edges(arm.robot, rng, EVERY_DAY), whole)


def other_arms():
    """Arms that are nearly of a family, of none, and of one seen from the tool."""
    rng = np.random.default_rng(0)
    rows = Robot.from_dh("ur10e").table.rows
    noise = 2e-4 * rng.standard_normal((6, 3))
    near, far = (
        tuple(
            replace(r, a=r.a + x, d=r.d + y, alpha=r.alpha + z)
            for r, (x, y, z) in zip(rows, size * noise, strict=True)
        )
        for size in (1.0, 10.0)
    )
    none = rng.uniform((-1, 0.1, -0.4, -1.4), (1, 0.4, 0.4, 1.4), (6, 4))
    general = DHTable.from_array(none, convention="standard")
    slide = replace(general.rows[2], joint_type="prismatic", lower=-0.5, upper=0.5)
    turned = [(0.0, r.d, r.a, r.alpha) for r in Robot.from_dh("puma560").table.rows[::-1]]
    behind = Robot.from_dh("stanford").table.rows
    skew = [
        (0, d, a, alpha) for d, a, alpha in rng.uniform((0.1, 0.1, 0.5), (0.4, 0.4, 1.3), (6, 3))
    ]
    skew[3:] = (0, 0.3, 0, -1.2), (0, 0, 0, 1.3), (0, 0.1, 0, 0)
    leaning = [(0, 0.3, 0.05, 1.3), (0, 0.02, 0.4, 0), (0, 0.01, 0.35, 0), (0, 0.1, 0.03, 1.2)]
    leaning += [(0, 0.1, 0.02, -1.1), (0, 0.08, 0, 0)]
    return {
        "nearly three parallel axes": DHTable(near, "standard"),
        "nearly three parallel axes, not so near": DHTable(far, "standard"),
        "general 6R": general,
        "general RRPRRR": DHTable((*general.rows[:2], slide, *general.rows[3:]), "standard"),
        "spherical shoulder": DHTable.from_array(turned, convention="modified"),
        "spherical shoulder, a slide behind it": DHTable(behind[::-1], "modified"),
        "spherical wrist, skew axes": DHTable.from_array(skew, convention="standard"),
        "three parallel axes, others lean": DHTable.from_array(leaning, convention="standard"),
    }


OTHERS = other_arms()


@pytest.mark.parametrize(
    "solver", daily(OTHERS, {"nearly three parallel axes", "general 6R", "spherical shoulder"})
)
def test_arms_of_other_families_answer_as_the_robot_does(solver, tmp_path):
    """Calibrated, general and mirrored arms: the same bits."""
    arm = Arm(Robot.from_dh(OTHERS[solver]), tmp_path)
    assert arm.made.solver == solver.partition(",")[0]
    arm.compile(*SAME)
    rng = np.random.default_rng(6)
    compare(arm, rng.uniform(-3.0, 3.0, (80, 6)))
    compare(arm, edges(arm.robot, rng, 60))


KINDS = dict.fromkeys([*FAMILIES.split(), *HELD])
KINDS |= {"general 6R": OTHERS["general 6R"]}
"""Arms of each kind of kernels, and the tables of those that do not ship."""

SOME = daily(KINDS, {"ur5", "planar_rr", "rpr_new_frame", "stanford", "franka_fer", "general 6R"})
"""The kinds; those that are left out of the daily suite are compiled there by other tests."""

SHIPPED = [name for name in list_tables() if not Robot.from_dh(name).is_coupled]
"""Arms that ship, but for those whose joints follow others, which are refused."""


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_all_arms_that_ship_answer_as_the_robot_does(name, tmp_path):
    """The same on 10,000 poses of every arm that ships, a third of them such edges.

    A line for each arm, which ``-s`` shows, says at how many solutions are all.
    """
    arm, rng, start = whole_arm(name, tmp_path), np.random.default_rng(2), time.monotonic()
    arm.compile(*SAME)
    some = compare(arm, configurations(arm.robot, rng, 6_700), LEFT.get(name, 1.0))
    edge = compare(arm, edges(arm.robot, rng, 3_300), 0.0 if name in LEFT else 1.0)
    shares = f"complete at {100.0 * some:.1f} % of 6700 and {100.0 * edge:.1f} % of 3300 edges"
    print(f"{name}: as the robot, {shares}; {time.monotonic() - start:.0f} s")


@pytest.mark.exhaustive
@pytest.mark.parametrize("compiler", ["g++", "clang", "clang++"])
@pytest.mark.parametrize("name", SHIPPED)
def test_compilers_have_nothing_to_say_of_any_arm(name, compiler, tmp_path):
    """C99 and C++17, as gcc in the test above."""
    whole_arm(name, tmp_path).compile("-O1", compiler=compiler)


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("name", ["puma560", "rpr_new_frame"])
def test_compilers_have_nothing_to_say(name, compiler, tmp_path):
    """C99 and C++17 of gcc and clang find nothing with all warnings."""
    if shutil.which(COMPILERS[compiler][0]) is None:
        pytest.skip(f"no {compiler}; .ci/run installs it")
    arm = Arm(Robot.from_dh(name), tmp_path)
    arm.compile("-O2", compiler=compiler)


def test_a_single_joint_is_compiled_without_a_warning(tmp_path):
    """The smallest arms of either kind, optimised."""
    for kind in (JointType.REVOLUTE, JointType.PRISMATIC):
        table = DHTable((DHRow(a=0.3, alpha=0.4, joint_type=kind),), "standard")
        Arm(Robot.from_dh(table), tmp_path).compile("-O2")


def test_options_that_reorder_sums_are_refused(tmp_path):
    """With them forward kinematics would be wrong, and the inverse would agree with it."""
    arm = Arm(Robot.from_dh("puma560"), tmp_path)
    with pytest.raises(AssertionError, match="compile without -ffast-math"):
        arm.compile("-O2", "-ffast-math")


def whole_arm(name, folder):
    """The file of an arm that ships or is one of the kinds, the joint held that it has to spare."""
    robot = Robot.from_dh(KINDS.get(name) or name)
    return Arm(robot, folder, robot.solver.joint if robot.n == 7 else None)


def sanitize(name, folder, m, level="-O0"):
    """Run an arm at m configurations, watched by the sanitizers."""
    arm, rng = whole_arm(name, folder), np.random.default_rng(3)
    arm.compile(level, "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    arm.run(configurations(arm.robot, rng, m - m // 3))
    arm.run(edges(arm.robot, rng, m // 3))


@pytest.mark.parametrize("name", KINDS)
def test_sanitizers_find_nothing(name, tmp_path):
    """No address out of bounds and nothing undefined, at singular poses either."""
    sanitize(name, tmp_path, EVERY_DAY)


@pytest.mark.parametrize("name", ["puma560", "cross_slide_arm"])
def test_nothing_is_read_that_was_not_written(name, tmp_path):
    """Memory that nobody filled decides nothing, at singular poses either."""
    if shutil.which("clang") is None:
        pytest.skip("no clang; .ci/run installs it")
    arm, rng = whole_arm(name, tmp_path), np.random.default_rng(3)
    arm.compile("-O1", "-fsanitize=memory", compiler="clang")
    arm.run(configurations(arm.robot, rng, EVERY_DAY // 3))
    arm.run(edges(arm.robot, rng, EVERY_DAY // 3))


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_sanitizers_find_nothing_on_ten_thousand_poses(name, tmp_path):
    """The same on 10,000 poses of every arm that ships, a line for each, which ``-s`` shows."""
    start = time.monotonic()
    sanitize(name, tmp_path, 10_000, "-O1")
    print(f"{name}: sanitizers silent at 10000 poses; {time.monotonic() - start:.0f} s")


@pytest.mark.parametrize("name", SOME)
def test_contraction_changes_the_last_digits_only(name, tmp_path):
    """Compiled for a processor that fuses products with sums, regular solutions move by 1e-12."""
    arm = whole_arm(name, tmp_path)
    arm.compile("-O1", "-march=native", "-ffp-contract=fast")
    robot, held = arm.robot, arm.held
    low, high = robot.bounded(1.0, np.pi)
    q = np.random.default_rng(4).uniform(low, high, (EVERY_DAY, robot.n))
    locked = {} if held is None else {"locked": {held: q[:, held]}}
    found = arm.run(q)["any"]
    batch = robot.ik_batch(robot.fk(q), within_limits=False, **locked)
    assert np.array_equal(found["count"], batch.count)
    gaps = found["q"][:, :, None] - batch.q[:, None]  # whose order may be another
    turned = np.remainder(gaps + np.pi, 2.0 * np.pi) - np.pi
    far = np.abs(np.where(robot.slides, gaps, turned)).max(axis=3)
    for some, solutions, count in zip(far, batch.q, batch.count, strict=True):
        J = np.delete(robot.jacobian(solutions[:count]), [] if held is None else held, axis=2)
        regular = np.linalg.svd(J, compute_uv=False)[:, J.shape[2] - 1] > 0.05
        assert (some[:count, :count].min(axis=0)[regular] <= 1e-12).all()


def test_a_seed_sorts_and_turns_as_the_robot_does(tmp_path):
    """``ik_near`` gives what a seed gives to ``Robot.ik``, the seed first."""
    robot = Robot.from_dh("ur5")
    arm = Arm(robot, tmp_path)
    arm.compile(*SAME)
    q = np.random.default_rng(5).uniform(-6.0, 6.0, (100, 6))
    for one, x, T in zip(arm.run(q)["near"], q, robot.fk(q), strict=True):
        whole = robot.ik(T, seed=x)
        assert np.array_equal(one["q"][: one["count"]], whole.q)
        assert np.array_equal(one["residual"][: one["count"]], whole.residual)


def test_what_is_no_pose_has_no_solutions(tmp_path):
    """NaN and a matrix that is no rotation are refused; what is far away is a pose."""
    arm = Arm(Robot.from_dh("puma560"), tmp_path)
    arm.compile("-O1")
    Ts = np.stack([np.full((4, 4), np.nan), 2.0 * np.eye(4), *[np.eye(4)] * 3])
    Ts[2:, 0, 3] = 1e150, 1e300, np.inf
    found = arm.run(np.zeros((5, 6)), Ts)["any"]
    assert (found["count"] == 0).all()
    assert found["complete"].tolist() == [False, False, True, True, False]
    assert [len(arm.robot.ik(T)) for T in Ts[2:4]] == [0, 0]


@pytest.mark.parametrize("name", SOME)
def test_the_stack_that_is_stated_suffices(name, tmp_path):
    """The frames that gcc makes, not optimised, add up to no more."""
    arm = whole_arm(name, tmp_path)
    arm.compile("-O0", "-fstack-usage")
    [listing] = tmp_path.glob("*.su")
    lines = [re.split(r"[:\t]", line) for line in listing.read_text().splitlines()]
    frames = {line[3]: int(line[4]) for line in lines}
    bodies = dict(
        re.findall(r"^static [^;{=]*?\b(\w+)\([^;{]*\)\n\{\n(.*?)^\}", arm.made.text, re.S | re.M)
    )

    def most(name):
        inner = set(re.findall(r"\w+(?=\()", bodies[name])) & bodies.keys()
        own = frames.get(name, 0)  # none of what is a part of its callers
        return own + 16 + max(map(most, inner), default=0)

    assert most("arm_ik_near") <= arm.made.stack <= SMALL


PAINTED = """
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include "{header}"
#define ROOM 1048576

static double T[16];
static arm_solutions found;
#if ARM_HAS_WORKSPACE
static arm_workspace work;
#endif

static void *nothing(void *given) {{ return given; }}

static void *solve(void *given)
{{
    double seed[ARM_JOINTS] = {{0}};
#if ARM_HAS_WORKSPACE
    arm_ik_near(T, seed, true, &work, &found);
#else
    arm_ik_near(T, seed, true, &found);
#endif
    return given;
}}

static long used(void *(*call)(void *), unsigned char *memory)
{{
    pthread_attr_t how;
    pthread_t one;
    long k = 0;
    memset(memory, 0xA5, ROOM);
    pthread_attr_init(&how);
    pthread_attr_setstack(&how, memory, ROOM);
    pthread_create(&one, &how, call, NULL);
    pthread_join(one, NULL);
    while (memory[k] == 0xA5) k++;
    return ROOM - k;
}}

int main(void)
{{
    unsigned char *memory = aligned_alloc(4096, ROOM);
    long rest = used(nothing, memory), most = 0, now;
#if ARM_HAS_WORKSPACE
    arm_prepare(&work);
#endif
    for (int k = 0; k < 100; k++) {{
        double q[ARM_JOINTS];
        for (int i = 0; i < ARM_JOINTS; i++) {{
            q[i] = k % 2 ? (rand() % 5 - 2) * 1.5707963267948966 : rand() % 6283 / 1000.0 - 3.14;
        }}
        arm_fk(q, T);
        now = used(solve, memory) - rest;
        most = now > most ? now : most;
    }}
    printf("%ld", most);
    return 0;
}}
"""


@pytest.mark.parametrize("compiler", [c for c in ("gcc", "clang") if shutil.which(c)])
@pytest.mark.parametrize(
    "name", daily(["puma560", "ur5", "xarm5", "fanuc_crx10ia"], {"puma560", "xarm5"})
)
def test_compilers_that_inline_need_no_more_stack_than_is_stated(name, compiler, tmp_path):
    """What is written of a painted stack, at -O3, singular poses included."""
    made = export_solver(Robot.from_dh(name), tmp_path / "arm.h", prefix="arm")
    source, program = tmp_path / "painted.c", tmp_path / "painted"
    source.write_text(PAINTED.format(header=tmp_path / "arm.h"))
    flags = "-std=gnu11", "-O3", "-Wl,-z,now", "-pthread", "-o", program, source, "-lm"
    subprocess.run([compiler, *map(str, flags)], check=True)
    most = int(subprocess.run([program], capture_output=True, check=True, text=True).stdout)
    assert 1000 < most < 0.9 * made.stack


ODD = """
#include <stdio.h>
#include <math.h>
#include "{header}"

int main(void)
{{
    const double q[ARM_JOINTS] = {{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}};
    double T[16], seed[ARM_JOINTS] = {{0}};
    arm_solutions found;
    arm_fk(q, T);
    for (int i = 0; i < 4; i++) {{
        const double odd[4] = {{NAN, INFINITY, -1e9, 0.0}};
        seed[2] = odd[i];
        printf("%d ", arm_ik_near(T, {held}seed, true, &found));
    }}
    {more}
    return 0;
}}
"""


@pytest.mark.parametrize(("name", "held"), [("puma560", None), ("kuka_iiwa14", 2)])
def test_seeds_that_are_none_and_held_values_beyond_their_limits_are_refused(name, held, tmp_path):
    """So is a pose that is none, of which nothing is complete."""
    made = export_solver(Robot.from_dh(name), tmp_path / "arm.h", prefix="arm", held=held)
    assert made
    more = 'printf("%d ", found.count > 0); T[0] = NAN; printf("%d ", arm_ik(T, true, &found));'
    more += 'printf("%d", found.complete);'
    if held is not None:
        more = "".join(
            f'printf("%d ", arm_ik(T, {value}, {limits}, &found) < 0);'
            for value, limits in (("9.0", "true"), ("NAN", "false"), ("0.3", "true"))
        )
    source, program = tmp_path / "odd.c", tmp_path / "odd"
    given = "" if held is None else "0.3, "
    source.write_text(ODD.format(header=tmp_path / "arm.h", held=given, more=more))
    subprocess.run(["gcc", "-std=gnu11", "-o", program, source, "-lm"], check=True)
    said = subprocess.run([program], capture_output=True, check=True, text=True).stdout.split()
    assert said[:3] == ["-1"] * 3
    assert int(said[3]) > 0
    assert said[4:] == (["1", "-1", "0"] if held is None else ["1", "1", "0"])


@pytest.fixture(scope="module")
def everything_imported():
    """What the first file that a process writes waits for."""
    exported(Robot.from_dh("planar_rr"), language="c")


@pytest.mark.usefixtures("everything_imported")
@pytest.mark.parametrize("name", list_tables())
def test_every_arm_that_ships_is_exported_at_once_and_works_in_little_stack(name):
    """Writing takes less than two seconds of the processor, what is written 16 KB of stack.

    Arms with joints that follow are refused.
    """
    robot, seconds = Robot.from_dh(name), []
    if robot.is_coupled:
        with pytest.raises(NoSolverError, match=r"follow|coupled joints"):
            exported(robot, language="c")
        return
    while len(seconds) < 2 and min(seconds, default=9.0) >= 2.0:  # on a busy core twice
        start = time.process_time()
        made = exported(robot, language="c", held=robot.solver.joint if robot.n == 7 else None)
        seconds.append(time.process_time() - start)
    assert min(seconds) < 2.0
    assert made.stack <= SMALL


EXAMPLE = """
#include <stdio.h>

#include "arm.h"

int main(void)
{{
    double q[ARM_JOINTS] = {{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}}, T[16];
    const double held = q[ARM_JOINTS - 1];
    (void)held;
    arm_fk(q, T);
{}    return 0;
}}
"""


@pytest.mark.parametrize("name", ["ur5", "xarm6", "franka_fer"])
def test_the_example_of_the_head_runs(name, tmp_path):
    """It prints solutions of the pose; the stack stands there in bytes, and no line is long."""
    arm = Arm(Robot.from_dh(name), tmp_path, HELD.get(name))
    head = arm.made.text.partition("*/")[0]
    example = re.search(r"^ \*     arm_solutions found;\n(?: \*     .*\n)+", head, re.M)[0]
    (tmp_path / "main.c").write_text(EXAMPLE.format(re.sub("^ \\*", "", example, flags=re.M)))
    arm.compile()
    done = subprocess.run(["./main"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.count("residual") >= 1
    assert f"{arm.made.stack} bytes of the stack" in head
    assert max(map(len, head.splitlines())) <= 110


def test_the_head_says_what_it_is():
    """Units, joints, bits, table, version and hashes stand there, and the licence whole."""
    text = exported(Robot.from_dh("ur5"), language="c").text
    for word in ("metres", "elbow up", "shoulder_pan", "SHA-256", "DH table ur5", "UR5_STACK"):
        assert word in text.partition("#include")[0], word
    whole = Path(__file__).parents[3].joinpath("LICENSE").read_text()
    assert LICENCE.split() == ["SPDX-License-Identifier:", "BSD-3-Clause", *whole.split()[3:]]


REFUSED = {
    "suffix": ({"path": "arm.txt"}, ArgumentError, "the suffix tells"),
    "rust": ({"language": "rust"}, ArgumentError, "Rust is not written"),
    "suffix of Rust": ({"path": "arm.rs"}, ArgumentError, "Rust is not written; a C file can"),
    "language": ({"language": "ada"}, ArgumentError, "expected 'c' or 'c\\+\\+' or 'python'"),
    "prefix": ({"prefix": "1x"}, ArgumentError, "a name of C"),
    "joint": ({"held": "nothing"}, NameNotFoundError, "no joint named"),
    "index": ({"held": 7}, ArgumentError, "from 0 to 5"),
    "no index": ({"held": -1}, ArgumentError, "from 0 to 5, got -1"),
    "force": ({"force": 1}, ArgumentError, "True or False"),
    "word of Python": ({"path": "class.py"}, ArgumentError, "no module of the name 'class'"),
    "no word": ({"path": "ur-5.py"}, ArgumentError, "no module of the name 'ur-5'"),
    "module": ({"path": "math.py"}, ArgumentError, "the place of Python's own module math"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_makes_no_sense_is_refused(case, tmp_path):
    """One message names what was found and what is allowed, and nothing is written."""
    given, error, message = REFUSED[case]
    options = {"path": "arm.h", **given}
    target = tmp_path / options.pop("path")
    with pytest.raises(error, match=message):
        export_solver(Robot.from_dh("ur5"), target, **options)
    assert not target.exists()


def test_what_is_no_path_or_joint_is_refused(tmp_path, capsys):
    """Nothing in place of a path, and a number below that of the first joint."""
    with pytest.raises(ArgumentError, match="path: expected a path, got None"):
        export_solver(Robot.from_dh("ur5"), None)
    with pytest.raises(SystemExit) as ended:
        main(["export", "ur5", "-o", str(tmp_path / "ur5.h"), "--held", "-1"])
    assert ended.value.code == 2
    assert "held: expected a whole number from 0 to 5, got -1" in capsys.readouterr().err


def test_an_arm_of_one_joint_is_exported(tmp_path):
    """Fewer joints than directions that singular families are looked for in."""
    table = DHTable.from_array([(0.1, 0.3, 0.2, -1.0)], convention="standard")
    made = export_solver(Robot.from_dh(table), tmp_path / "one.h")
    assert (made.solver, made.prefix) == ("short chain", "robot")


def test_the_head_says_no_more_than_there_is():
    """A joint that turns on and on has no limits there, a solver that names no branch no bits."""
    for table, limits in (("stanford", 0), (KINDS["general 6R"], 6)):
        text = exported(Robot.from_dh(table), language="c").text.partition("#include")[0]
        assert text.count(", without limits") == limits
        assert not re.search(r"\binf\b|bit 0", text)
        assert "its branch, -1 as they have none;" in text


def test_where_nothing_can_be_written_nothing_is_worked_out(tmp_path):
    """Neither the source without the folder of its test, nor one in place of a folder."""
    for file, tests in (("arm.h", "none/arm_test.c"), ("arm.h", "."), ("none/arm.h", "a.c")):
        command = [sys.executable, "-m", "dh2urdf", "export", "ur5", "-o", file, "--tests", tests]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert "cannot write: " in done.stderr
        assert not list(tmp_path.iterdir())


def test_a_joint_to_spare_has_to_be_held():
    """An arm of seven joints says which joint to hold."""
    with pytest.raises(NoSolverError, match="hold one, such as"):
        exported(Robot.from_dh("kuka_iiwa14"), language="c")
    with pytest.raises(NoSolverError, match="with that joint held, what is left is a short chain"):
        exported(Robot.from_dh("ur5"), language="c", held=2)


def test_the_verb_writes_the_file(tmp_path):
    """``dh2urdf export`` writes what ``export_solver`` does, and says how much stack it takes."""
    command = [sys.executable, "-m", "dh2urdf", "export", "planar_rr", "-o", "rr.h", "--json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    told = json.loads(done.stdout)
    text = (tmp_path / "rr.h").read_text()
    assert text == exported(Robot.from_dh("planar_rr"), language="c").text
    assert f"#define PLANAR_RR_STACK {told['stack']}\n" in text
