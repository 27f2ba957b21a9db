"""A Python file answers what the robot does, where there is nothing but the standard library."""

import importlib
import json
import math
import re
import subprocess
import sys
import textwrap

import numpy as np
import pytest

from dh2urdf import Robot, export_solver
from dh2urdf.cli import main
from tests.export.source.compiled import configurations

MAIN = """
import json, sys
import arm
assert "numpy" not in sys.modules
given, told = json.load(sys.stdin), []
for q, T in given["poses"]:
    held = [q[given["held"]]] if given["held"] is not None else []
    for within_limits in (True, False):
        told.append(arm.ik(T, *held, within_limits=within_limits))
    near = arm.ik_near(T, *held, q)
    told.append([arm.fk(q), arm.jacobian(q), near.q])
json.dump(told, sys.stdout)
"""

ARMS = {
    "puma560": None,
    "ur5": None,
    "planar_rr": None,
    "rpr_new_frame": None,
    "franka_fer": 6,
    "xarm6": None,
}


@pytest.mark.parametrize("name", ARMS)
def test_it_answers_what_the_robot_does_without_numpy(name, tmp_path):
    """Every number is that of ``Robot.ik``, singular poses included, by ``math`` alone."""
    robot, held = Robot.from_dh(name), ARMS[name]
    export_solver(robot, tmp_path / "arm.py", held=held)
    some = 3 if name == "xarm6" else 21  # interpreted, a search takes a second
    q = configurations(robot, np.random.default_rng(1), some)
    poses = [(x.tolist(), robot.fk(x).tolist()) for x in q]
    (tmp_path / "main.py").write_text(MAIN)
    done = subprocess.run(
        [sys.executable, "-S", "main.py"],
        input=json.dumps({"poses": poses, "held": held}),
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    told = iter(json.loads(done.stdout))
    for x in q:
        T, locked = robot.fk(x), None if held is None else {held: float(x[held])}
        for limits in (True, False):
            found, residual, branch, free, complete = next(told)
            whole = robot.ik(T, within_limits=limits, locked=locked)
            if complete:
                assert np.array_equal(np.reshape(found, (-1, robot.n)), whole.q)
                assert np.array_equal(residual, whole.residual)
                assert np.array_equal(branch, whole.codes[0])
                assert np.array_equal(free, whole.codes[1])
        pose, jacobian, near = next(told)
        assert np.array_equal(pose, T)
        assert np.array_equal(jacobian, robot.jacobian(x))
        if len(near):
            gaps = np.linalg.norm(np.array(near) - x, axis=1)
            assert (np.diff(gaps) >= 0.0).all()


def test_what_is_no_pose_is_refused(tmp_path):
    """A matrix that is no rotation, and one of another size, raise ``ValueError``."""
    export_solver(Robot.from_dh("planar_rr"), tmp_path / "arm.py")
    given: dict = {}
    exec((tmp_path / "arm.py").read_text(), given)
    with pytest.raises(ValueError, match="no pose"):
        given["ik"]([[2.0 * (i == j) for j in range(4)] for i in range(4)])
    with pytest.raises(ValueError, match="could not convert"):
        given["ik"]("x")
    with pytest.raises(ValueError, match="expected 16 numbers, got 9"):
        given["ik"]([[1.0, 0.0, 0.0]] * 3)


def test_the_example_of_the_head_runs(tmp_path, capsys):
    """It prints the solutions of a pose, held joint or not."""
    for name, held in (("puma560", None), ("franka_fer", 6)):
        made = export_solver(Robot.from_dh(name), tmp_path / f"{name}.py", held=held)
        example = re.search(r"^    found = .*\n(?:    .*\n)+", made.text, re.M)[0]
        given: dict = {"held": 0.3}
        exec(made.text, given)
        given["T"] = given["fk"]([0.1, 0.2, -0.3, 0.4, 0.5, 0.6, 0.3][: given["JOINTS"]])
        exec(textwrap.dedent(example), given)
        assert capsys.readouterr().out.count("[") >= 1


def test_it_compiles_as_any_python(tmp_path):
    """No warning of the compiler, in any of the languages that are written."""
    for name in ("puma560", "xarm6"):
        made = export_solver(Robot.from_dh(name), tmp_path / f"{name}.py")
        compile(made.text, name, "exec")
        assert made.language == "python"
        assert "import math\n" in made.text
        assert "numpy" not in made.text.lower().partition('"""\n')[2]


def test_a_c_program_does_not_test_a_python_file(tmp_path, capsys):
    """``--tests`` is refused beside Python, with one message."""
    with pytest.raises(SystemExit) as ended:
        main(["export", "planar_rr", "-o", str(tmp_path / "rr.py"), "--tests", "rr_test.c"])
    assert ended.value.code == 2
    assert "does nothing for Python" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_seed_that_is_none_and_a_held_value_beyond_its_limits_are_refused(tmp_path, monkeypatch):
    """With the value, where it is the held one's with the limits."""
    export_solver(Robot.from_dh("kuka_iiwa14"), tmp_path / "odd_iiwa.py", held=2)
    monkeypatch.syspath_prepend(tmp_path)
    arm = importlib.import_module("odd_iiwa")
    q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]
    T = arm.fk(q)
    assert arm.ik_near(T, 0.3, q).q
    for odd in (math.nan, math.inf, 1e9):
        with pytest.raises(ValueError, match="seed"):
            arm.ik_near(T, 0.3, [odd, *q[1:]])
        with pytest.raises(ValueError, match=r"held: .* is outside the limits"):
            arm.ik(T, odd, within_limits=False)
    with pytest.raises(ValueError, match=r"held: 9\.0 is outside the limits -2\.96"):
        arm.ik(T, 9.0)
    assert arm.ik(T, 0.3 + 2.0 * math.pi, within_limits=False).q
