"""``dh2urdf ik --explain`` as a student meets it."""

import json

import pytest

POSE = ["--xyz", "0.4", "0", "0.3", "--rpy", "0", "180", "0", "--deg"]


def test_explanation_is_text_that_ends_in_the_solution(run):
    """Steps are numbered, the numbers are put in, and the last lines name the solutions."""
    status, out, err = run("ik", "denso_vs6556", *POSE, "--explain")
    assert (status, err) == (0, "")
    assert out.startswith("Inverse kinematics of denso_vs6556: spherical wrist\n===")
    assert "3. The wrist centre\n-------------------\n" in out
    assert "    o_c = o - d_6 R e_3\n        = (0.4, 0, 0.3) - 0.08 · (0, 0, -1)\n" in out
    assert "`ik` calls this choice: elbow up." in " ".join(out.split())
    assert "shoulder left, elbow up, wrist no flip  <- this one" in out


def test_solution_is_counted_as_in_the_table(run):
    """--solution 2 leads to the second row that ik prints."""
    rows = json.loads(run("ik", "denso_vs6556", *POSE, "--json")[1])["solutions"]
    out = run("ik", "denso_vs6556", *POSE, "--explain", "--solution", "2", "--json")[1]
    told = json.loads(out)["explanation"]
    assert told["solution"] == 1
    assert told["branch"] == rows[1]["branch"]
    assert told["q"] == pytest.approx(rows[1]["q"], abs=1e-12)


@pytest.mark.parametrize(
    ("form", "line"),
    [
        ("md", r"o_{c} &= o - d_{6} \, R \, e_{3} \\"),
        ("markdown", r"### 4. $\theta_{1}$: which way the arm faces"),
        ("latex", r"\section*{Inverse kinematics of denso\_vs6556: spherical wrist}"),
        ("latex", r"&= \sqrt{0.325^{2} + \left(-0.045\right)^{2}} \\"),
    ],
)
def test_formulas_are_written_for_markdown_and_latex(run, form, line):
    """The same steps, with the formulas as mathematics."""
    _, out, _ = run("ik", "denso_vs6556", *POSE, "--explain", "--format", form)
    assert line in out.splitlines()


def test_latex_is_plain_ascii(run):
    """Every LaTeX takes it, the table of an arm in the modified convention, too."""
    pose = ["--xyz=0.4,0,0.3", "--rpy=0,pi,0"]
    for name in ("puma560_modified", "xarm6", "stanford"):
        _, out, _ = run("ik", name, *pose, "--explain", "--no-within-limits", "--format", "latex")
        assert out.isascii(), [c for c in out if not c.isascii()]
        assert out.count(r"\begin{") == out.count(r"\end{")
        assert out.count(r"\left(") == out.count(r"\right)")


def test_pose_out_of_reach_is_explained_up_to_the_step_that_fails(run):
    """Exit 1, and the last step says by how much in metres."""
    status, out, err = run("ik", "denso_vs6556", "--xyz=0.8,0,0.335", "--rpy=0,0,0", "--explain")
    assert status == 1
    assert "0.150977 m too far" in " ".join(out.split())
    assert "The check" not in out
    assert "no solution" in err


def test_solution_outside_the_limits_is_explained(run):
    """Where the limits leave none, the steps lead to one outside them; the status stays 1."""
    pose = ["--xyz=0.137,-0.23,-0.159", "--rpy=0.24,1.26,-0.67"]
    status, out, err = run("ik", "denso_vs6556", *pose, "--explain")
    assert status == 1
    assert "outside the joint limits" in err
    assert "It is outside the limits of joint_" in " ".join(out.split())
    assert "The check" in out


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["--explain", "--solution", "99"], "--solution: no solution 99, there are 2"),
        (["--explain", "--solution", "0"], "--solution: expected a whole number from 1"),
        (["--solution", "1"], "--solution does nothing without --explain"),
        (["--format", "md"], "--format does nothing without --explain"),
        (["--explain", "--format", "python"], "--format python does nothing without --symbolic"),
        (["--explain", "--words", "kuka"], "--explain stands alone: --words does nothing"),
    ],
)
def test_bad_use_is_one_message(run, argv, message):
    """Exit 2, what was found and what is allowed."""
    status, out, err = run("ik", "denso_vs6556", *POSE, *argv)
    assert (status, out) == (2, "")
    assert message in err


def test_arm_without_a_derivation_says_what_its_solver_does(run):
    """Seven joints swept: what is held is said, and what solves the rest."""
    _, out, _ = run("ik", "franka_fer", "--xyz=0.4,0,0.3", "--rpy=0,pi,0", "--explain")
    assert "fer_joint7 at " in out
    assert "Turned round" in out
