"""``export -o FILE --tests FILE``: a C program that knows whether the source is right there."""

import re
import shutil
import subprocess

import pytest

from dh2urdf import Robot
from dh2urdf.export.self_test import POSES, self_test_text, write_self_test
from dh2urdf.export.source import export_solver, exported

ARMS = {"stanford": None, "xarm6": None, "kuka_iiwa14": "joint_a3"}
"""Arms of several kinds, and the joint that is held."""

C99 = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]

pytestmark = pytest.mark.skipif(not shutil.which("gcc"), reason="no gcc")


def built(folder, arm, held=None, mended=str):
    """The program of an arm, its header changed by ``mended``: status and what it prints."""
    robot = Robot.from_dh(arm)
    header = folder / "arm.h"
    made = export_solver(robot, header, held=held)
    header.write_text(mended(made.text))
    write_self_test(robot, made, header, folder / "arm_test.c", held=held)
    command = ["gcc", *C99, "arm_test.c", "-o", "arm_test", "-lm"]
    compiled = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert compiled.returncode == 0, compiled.stderr[:4000]
    done = subprocess.run(["./arm_test"], cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


@pytest.mark.parametrize("arm", ARMS)
def test_what_was_exported_passes_its_own_test(tmp_path, arm):
    """All poses and one out of reach; each arm has solutions to compare."""
    status, said = built(tmp_path, arm, ARMS[arm])
    assert status == 0, said
    poses, compared, solutions, faults = map(int, re.findall(r"\d+", said))
    assert (poses, faults) == (POSES + 1, 0)
    assert compared > 0.8 * POSES
    assert solutions > POSES


def test_a_wrong_solver_fails_its_test(tmp_path):
    """A link that is 0.1 mm longer than it was is found, at every pose."""
    status, said = built(tmp_path, "ur5e", mended=lambda text: text.replace("0.0996", "0.0997"))
    assert status == 1
    assert said.count("misses") + said.count("expected") > POSES


def test_singular_poses_are_not_counted():
    """At zero an UR is singular: rounding may tell how many solutions there are."""
    robot = Robot.from_dh("ur5e")
    text = self_test_text(robot, exported(robot, language="c"), "a.h")
    counts = re.search(r"counts\[POSES\] = \{([^}]*)\}", text)
    numbers = [int(v) for v in counts[1].split(",")]
    assert numbers[-2:] == [-1, 0]
    assert sum(n > 0 for n in numbers) > POSES // 2


def test_verb_writes_both_and_keeps_what_it_did_not_write(run, refused, tmp_path):
    """The header is included from the test's folder; a file of somebody else's stays."""
    (tmp_path / "t").mkdir()
    status, out, _ = run("export", "planar_rr", "-o", "rr.h", "--tests", "t/rr_test.c")
    assert (status, out.count("\n")) == (0, 2)
    assert '#include "../rr.h"' in (tmp_path / "t/rr_test.c").read_text()
    (tmp_path / "mine.c").write_text("int main(void) { return 0; }")
    assert "mine.c" in refused("export", "planar_rr", "-o", "rr.h", "--tests", "mine.c")
    assert "--tests does nothing without --output" in refused("export", "ur5", "--tests", "a.c")
    same = refused("export", "ur5", "-o", "t/../ur.h", "--tests", "ur.h")
    assert "--tests: ur.h is the file of -o" in same
    assert "stands alone" in refused("export", "ur5", "-o", "-", "--tests", "a.c")
