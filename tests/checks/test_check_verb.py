"""`dh2urdf check` as a user meets it: words, exit status, JSON, stdin, files that are none."""

import io
import json
import math
import re
import sys
import time

import pytest
from urdf_faults import BODY, FAULTS, SOUND, arm, joint

import dh2urdf
from dh2urdf.checks import ask_consumers, check_urdf


@pytest.fixture(autouse=True)
def no_lines_of_progress(monkeypatch):
    monkeypatch.setattr("dh2urdf.cli.progress.QUIET", math.inf)


def test_own_file_passes_and_consumers_accept_it(run, tmp_path):
    """A converted table has nothing to mend; those installed accept it; status 0."""
    dh2urdf.write_urdf(dh2urdf.load_table("ur5"), tmp_path / "ur5.urdf")
    status, out, err = run("check", "ur5.urdf")
    assert (status, err) == (0, "")
    assert out.startswith("ur5.urdf: nothing to mend")
    for line in out.splitlines()[1:]:
        assert line.rstrip().endswith("accepts")
    for name in ("Pinocchio", "check_urdf", "yourdfpy", "MuJoCo"):
        assert name in out


def test_findings_name_line_element_consumers_and_cure(run, tmp_path):
    """An arm without limits and with a weightless hand is told so; status 1."""
    (tmp_path / "arm.urdf").write_text(arm(fore="", elbow=joint(limit="")))
    status, out, _ = run("check", "arm.urdf")
    assert status == 1
    assert 'arm.urdf:7: error: <joint name="elbow"> has no <limit> [limit-missing]' in out
    assert "check_urdf, Pinocchio, KDL, Gazebo, MoveIt, RViz and PyBullet refuse the file" in out
    assert "mend: write <limit" in out
    assert 'arm.urdf:5: error: <link name="fore"> moves, and has no <inertial>' in out
    assert "arm.urdf: 2 errors" in out
    assert "Joint [elbow] is of type REVOLUTE but it does not specify limits" in out


def test_no_program_is_asked_about_very_many_joints(run, tmp_path):
    """Of 1,000 joints the rules tell in seconds, and a line that nobody else was asked."""
    link = f'<link name="l{{0}}">{BODY}</link>'
    hinge = '<joint name="j{0}" type="revolute"><parent link="l{1}"/><child link="l{0}"/>'
    hinge += '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="1"/></joint>'
    text = "".join(link.format(k) + hinge.format(k, k - 1) for k in range(1, 1001))
    (tmp_path / "long.urdf").write_text(f'<robot name="long"><link name="l0"/>{text}</robot>')
    start = time.monotonic()
    status, out, err = run("check", "long.urdf")
    assert time.monotonic() - start < 10
    assert (status, err) == (0, "")
    assert out == (
        "long.urdf: nothing to mend\n"
        "    no program was asked: 1000 joints; they are asked about up to 200\n"
    )
    _, out, _ = run("check", "long.urdf", "--json")
    (file,) = json.loads(out)["files"]
    assert (file["consumers"], "1000 joints" in file["not_asked"]) == ([], True)


def test_a_program_that_hangs_is_left_in_time(run, tmp_path, monkeypatch):
    """A joint from a link to itself, on which check_urdf does not come back, ends all the same."""
    monkeypatch.setattr(ask_consumers, "PATIENCE", 3.0)
    (tmp_path / "loop.urdf").write_text(FAULTS["joins-itself"][0])
    status, out, _ = run("check", "loop.urdf")
    assert status == 1
    assert re.search(r"check_urdf +refuses +no answer within 3 s", out)


def test_advice_alone_is_no_failure(run, tmp_path):
    """A continuous joint brings advice and status 0."""
    (tmp_path / "arm.urdf").write_text(arm(elbow=joint(kind="continuous", limit="")))
    status, out, _ = run("check", "arm.urdf", "--no-run")
    assert (status, "1 advice" in out) == (0, True)


def test_a_program_reads_why_a_file_cannot_be_checked_and_so_does_its_user(run):
    """With --json, too, what cannot be read ends in status 2 and a message on stderr."""
    status, out, err = run("check", "ur5", "--json")
    (failed,) = json.loads(out)["failed"]
    assert (status, err) == (2, f"dh2urdf: {failed['error']}\n")
    assert failed["error"].startswith("ur5: there is no such file; ur5 is a table that ships")


def test_json_holds_all_that_is_said(run, tmp_path):
    """One object: findings with severity and effects, consumers with verdict and words."""
    (tmp_path / "arm.urdf").write_text(arm(base=BODY))
    status, out, _ = run("check", "arm.urdf", "--json")
    data = json.loads(out)
    assert (status, data["schema"], data["verb"], data["failed"]) == (1, 1, "check", [])
    (file,) = data["files"]
    (finding,) = file["findings"]
    assert (finding["rule"], finding["severity"], finding["line"]) == ("root-inertia", "warning", 3)
    assert finding["effects"][0]["consumers"] == ["KDL"]
    assert {c["verdict"] for c in file["consumers"]} == {"accepts"}


def test_unreadable_files_do_not_stop_the_rest(run, tmp_path):
    """Of three files one is missing, one is text: both are named, the third is checked; 2."""
    (tmp_path / "arm.urdf").write_text(SOUND)
    (tmp_path / "text.urdf").write_text("not a robot")
    status, out, err = run("check", "nowhere.urdf", "text.urdf", "arm.urdf", "--no-run")
    assert status == 2
    assert "arm.urdf: nothing to mend" in out
    named = [line.split(":")[1].strip() for line in err.splitlines()]
    assert named == ["nowhere.urdf", "text.urdf"]
    assert "Traceback" not in err


def test_stdin_is_read(run, refused, monkeypatch):
    """A hyphen stands for stdin; other words with a hyphen are options that do not exist."""
    stdin = io.TextIOWrapper(io.BytesIO(arm(base=BODY).encode()))
    monkeypatch.setattr(sys, "stdin", stdin)
    status, out, _ = run("check", "-", "--no-run")
    assert (status, out.startswith("<stdin>:3: warning")) == (1, True)
    assert "unknown option --nonsense" in refused("check", "--nonsense")


def test_convert_reads_stdin_too(run, monkeypatch):
    """`convert -` turns YAML on stdin into a URDF on stdout."""
    table = "convention: standard\nunits: {length: m, angle: deg}\n"
    table += "joints: [{theta: 0, d: 0, a: 1, alpha: 0}]\n"
    monkeypatch.setattr(sys, "stdin", io.StringIO(table))
    status, out, _ = run("convert", "-")
    assert (status, out.startswith("<?xml")) == (0, True)


CERTAIN = {
    "robot-name": 1, "version": 1, "repeated-element": 2, "axis-not-unit": 2, "negative-zero": 1,
    "rounded-angle": 3, "geometry-empty": 2, "material-name": 1,
}  # fmt: skip
"""Rules whose findings take no guess to mend, and the files of each."""


@pytest.mark.parametrize("rule", CERTAIN)
def test_fix_mends_what_takes_no_guess(run, tmp_path, rule):
    """The finding is gone, no other comes, the change is told, and comments stay."""
    assert len(FAULTS[rule]) == CERTAIN[rule]
    for text in FAULTS[rule]:
        (tmp_path / "arm.urdf").write_text(text.replace("</robot>", "<!-- mine -->\n</robot>"))
        before = {f.rule for f in check_urdf("arm.urdf")}
        status, out, _ = run("check", "arm.urdf", "--fix", "mended.urdf", "--force")
        assert (status, rule in before) == (0, True)
        assert {f.rule for f in check_urdf("mended.urdf")} == before - {rule}
        assert re.match(r"arm\.urdf:\d+: <", out)
        assert ", 1 mended, and read back" in out
        assert "<!-- mine -->" in (tmp_path / "mended.urdf").read_text()


def test_fix_says_what_is_left_and_may_write_over_the_file_itself(run, refused, tmp_path):
    """A weightless hand stays and is told; the file itself is replaced with --force alone."""
    path = tmp_path / "arm.urdf"
    path.write_text(arm(fore="", elbow=joint(rpy="1.5708 0 0")))
    assert "--force" in refused("check", "arm.urdf", "--fix", "arm.urdf")
    status, out, _ = run("check", "arm.urdf", "--fix", "arm.urdf", "--force")
    assert status == 0
    assert 'rpy="1.5708 0 0" written as 1.5707963267948966 0 0' in out
    assert "left to mend:" in out
    assert "moves, and has no <inertial>" in out
    assert "[massless]" in out
    assert 'rpy="1.5707963267948966 0 0"' in path.read_text()
    data = json.loads(run("check", "arm.urdf", "--fix", "arm.urdf", "--json")[1])
    assert (data["mends"], [f["rule"] for f in data["left"]]) == ([], ["massless"])
