"""The command line as a user meets it: output, exit status, messages, files left behind."""

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from dh_product import dh_frames, difference

import dh2urdf

RPR = """
name: rpr
convention: standard
units: {length: m, angle: deg}
joints:
  - {theta: theta_1, d: 0, a: 3, alpha: -90}
  - {theta: 0, d: l_2 + 2, a: 0, alpha: 90}
  - {theta: theta_3 + 90, d: 0, a: 1.5, alpha: 0}
"""


def test_convert_writes_a_verified_urdf(run, tmp_path):
    """A table in, a URDF beside it, the proof printed."""
    (tmp_path / "arm.yaml").write_text(RPR)
    status, out, err = run("convert", "arm.yaml", "-o", "arm.urdf")
    assert (status, "arm.urdf  largest difference" in out) == (0, True)
    assert "no limits in the table" in err
    assert dh2urdf.load_table(tmp_path / "arm.urdf").n == 3


@pytest.mark.parametrize("suffix", ["yaml", "yml", "toml", "json", "csv", "md"])
def test_the_same_table_is_written_again_and_another_one_is_not_lost(
    run, refused, tmp_path, suffix
):
    """``-o arm.yaml`` is the table itself, and can be repeated; others stay, unless forced."""
    target = tmp_path / f"arm.{suffix}"
    for _ in range(2):
        status, out, _ = run("convert", "stanford", "-o", target)
        assert (status, "reads back as the same table" in out) == (0, True)
    assert dh2urdf.load_table(target) == dh2urdf.load_table("stanford")
    for kept in (target.read_text(), target.read_text() + "\n", "not a table\n"):
        target.write_text(kept)
        assert "--force" in refused("convert", "planar_rr", "-o", target)
        assert target.read_text() == kept
    assert run("convert", "planar_rr", "-o", target, "--force")[0] == 0
    assert dh2urdf.load_table(target) == dh2urdf.load_table("planar_rr")


def test_a_name_that_no_urdf_can_hold_is_told_with_its_place(refused, tmp_path):
    """The message of convert and fk has file, line and column of the name."""
    (tmp_path / "arm.yaml").write_text(
        RPR.replace("{theta: theta_1", '{name: "a\\x01", theta: theta_1')
    )
    for argv in (["convert", "arm.yaml"], ["fk", "arm.yaml", "0", "0", "0"]):
        err = refused(*argv)
        place = re.search(r"arm\.yaml:(\d+):(\d+): joints\[1\]\.name", err)
        line = (tmp_path / "arm.yaml").read_text().splitlines()[int(place[1]) - 1]
        assert line[int(place[2]) - 1 :].startswith('"a')


def test_a_link_called_a_line_end_is_printed_in_one_line(run, tmp_path):
    """fk, extract and check show the name as it is written."""
    (tmp_path / "arm.urdf").write_text(
        '<robot name="r"><link name="base"/><link name="&#10;"/><joint name="j" type="revolute">'
        '<parent link="base"/><child link="&#10;"/><axis xyz="0 0 1"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    assert run("fk", "arm.urdf", "0")[1].startswith("\\n in base:\n")
    assert "base to \\n: largest FK difference" in run("extract", "arm.urdf")[1]
    assert '<link name="\\n">' in run("check", "arm.urdf")[1]


def test_convert_to_stdout_prints_only_the_urdf(run):
    """With -o - stdout is the file, everything else is on stderr."""
    status, out, err = run("convert", "ur5", "-o", "-")
    assert status == 0
    assert out.startswith("<?xml")
    assert out.rstrip().endswith("</robot>")
    assert "largest difference" in err


def test_one_bad_table_does_not_stop_the_rest(run, tmp_path):
    """Of three tables two are written; the third is named; status 2."""
    (tmp_path / "bad.yaml").write_text(RPR.replace("convention: standard", ""))
    (tmp_path / "good.yaml").write_text(RPR)
    status, out, err = run("convert", "good.yaml", "bad.yaml", "ur5", "--out-dir", "out")
    assert status == 2
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["good.urdf", "ur5.urdf"]
    assert "bad.yaml" in err
    assert "convention" in err
    assert "1 of 3 tables were not converted" in err
    assert "2 files written" in out


def test_a_program_reads_which_tables_were_bad_and_so_does_its_user(run, tmp_path):
    """With --json, too, a bad table among several ends in status 2 and a message on stderr."""
    status, out, err = run("convert", "ur5", "0", "--out-dir", "urdf", "--json")
    answer = json.loads(out)
    (failed,) = answer["failed"]
    assert (status, failed["source"], len(answer["files"])) == (2, "0", 1)
    assert f"dh2urdf: {failed['error']}" in err


def test_two_sources_of_one_name_do_not_overwrite_each_other(run, tmp_path):
    """The second of two tables that would write one file is refused."""
    (tmp_path / "ur5.yaml").write_text(RPR)
    status, _, err = run("convert", "ur5", "ur5.yaml", "--out-dir", "out")
    assert status == 2
    assert "already written from ur5" in err


def test_fk_agrees_with_the_dh_product(run):
    """fk in degrees and as JSON equals the DH product."""
    status, out, _ = run(
        "fk", "denso_vs6556", "0", "-90", "20deg", "-1e-3rad", "0", "0", "--deg", "--json"
    )
    found = json.loads(out)
    table = dh2urdf.load_table("denso_vs6556")
    q = np.array([0, -np.pi / 2, np.radians(20), -1e-3, 0, 0])
    assert status == 0
    assert found["schema"] == 1
    assert difference(found["q"], q) < 1e-16
    assert difference(found["T_base_tip"], dh_frames(table, q)[-1]) < 1e-14


def test_fk_takes_values_as_an_option(run):
    """--q=0,-pi/2,... and bare numbers after --q are read alike."""
    a = run("fk", "planar_rrr", "--q=0,-pi/2,90deg", "--json")[1]
    b = run("fk", "planar_rrr", "0", "-1.5707963267948966", "1.5707963267948966", "--json")[1]
    assert json.loads(a)["q"] == json.loads(b)["q"]


def test_show_prints_table_transforms_and_product(run):
    """show holds the table, each H_i^{i-1}, the product and the solver."""
    status, out, _ = run("show", "planar_rr", "--q=90deg,0", "--symbolic")
    assert status == 0
    parts = "planar_rr: 2 joints", "H_1^0 =", "H_2^1 =", "H_2^0 =", "c12", "inverse kinematics"
    assert all(part in out for part in parts)
    assert json.loads(run("show", "ur5", "--json")[1])["convention"] == "standard"
    assert r"\begin{tabular}" in run("show", "ur5", "--format", "latex")[1]


def test_list_names_every_table(run):
    """list shows all names, and as JSON their joints and sources."""
    out = run("list")[1]
    assert all(name in out for name in dh2urdf.list_tables())
    found = json.loads(run("list", "--json")[1])["tables"]
    assert [t["name"] for t in found] == list(dh2urdf.list_tables())


BROKEN = {
    "empty": "",
    "no convention": RPR.replace("convention: standard\n", ""),
    "no units": RPR.replace("units: {length: m, angle: deg}\n", ""),
    "unknown key": RPR.replace("d: 0, a: 3", "d: 0, aa: 3"),
    "text in a cell": RPR.replace("a: 3", "a: three"),
    "NaN": RPR.replace("a: 3", "a: .nan"),
    "infinity": RPR.replace("a: 3", "a: .inf"),
    "code": RPR.replace("a: 3", "a: __import__('os').getcwd()"),
    "tower of powers": RPR.replace("a: 3", "a: 9**9**9**9"),
    "object tag": RPR.replace("a: 3", "a: !!python/object/apply:os.getcwd []"),
    "bomb": "a: &a [x,x,x,x,x,x,x,x,x]\n"
    + "\n".join(
        f"{b}: &{b} [{','.join(['*' + a] * 9)}]"
        for a, b in zip("abcdefgh", "bcdefghi", strict=True)
    ),
    "brackets": "[" * 5000,
    "lower above upper": RPR.replace("a: 3,", "a: 3, lower: 10, upper: -10,"),
    "mass zero": RPR.replace("a: 3,", "a: 3, mass: 0,"),
    "mass negative": RPR.replace("a: 3,", "a: 3, mass: -2,"),
    "sign 2": RPR.replace("a: 3,", "a: 3, sign: 2,"),
    "two joints of a name": RPR.replace("{theta", "{name: j, theta"),
    "duplicate key": RPR.replace("a: 3,", "a: 3, a: 4,"),
    "no joints": RPR.partition("joints:")[0] + "joints: []\n",
    "joints missing": RPR.partition("joints:")[0],
    "unknown unit": RPR.replace("length: m,", "length: parsec,"),
    "not a mapping": "- 1\n- 2\n",
    "broken YAML": RPR + "  - {theta: 0\n",
    "two steps of one row": RPR + "  - {type: fixed, xyz: [1, 2, 3], d: 1}\n",
    "unreachable frame": RPR.replace("a: 1.5, alpha: 0", "a: 0, alpha: 0, xyz: [0, 1.5, 0]"),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_broken_tables_leave_everything_as_it_was(refused, kind, tmp_path):
    """Status 2, one message that names the file, no traceback, the older output untouched."""
    (tmp_path / "arm.yaml").write_text(BROKEN[kind])
    (tmp_path / "arm.urdf").write_text("<dh2urdf/> older")
    err = refused("convert", "arm.yaml", "-o", "arm.urdf")
    assert err.startswith("dh2urdf: arm.yaml")
    assert (tmp_path / "arm.urdf").read_text() == "<dh2urdf/> older"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["arm.urdf", "arm.yaml"]


def test_other_broken_inputs(refused, tmp_path):
    """Binary data, a folder, a missing file, an r column, a robot without links."""
    (tmp_path / "binary.yaml").write_bytes(bytes(range(256)))
    (tmp_path / "folder.yaml").mkdir()
    (tmp_path / "r.csv").write_text(
        "# convention: standard\n# units: m, rad\ntheta,d,r,alpha\n0,0,1,0\n"
    )
    (tmp_path / "plain.urdf").write_text("<robot name='x'/>")
    for name, words in {
        "binary.yaml": ["text"],
        "folder.yaml": ["folder"],
        "missing.yaml": ["no such file"],
        "r.csv": ["a", "d"],
        "plain.urdf": ["no links"],
    }.items():
        err = refused("convert", name, "-o", "x.urdf")
        assert all(word in err for word in words), err
        assert not (tmp_path / "x.urdf").exists()


@pytest.mark.parametrize(
    ("argv", "says"),
    [
        ("extract UR-5", "dh2urdf convert ur5 writes its URDF"),
        ("list here", "list: more values than it takes: 'here'"),
        ("convert ur5 -o ur5.pdf", "dh2urdf figure ARM -o FILE does"),
    ],
)
def test_what_another_verb_or_format_does_is_named(refused, argv, says):
    """Who asks the wrong verb, or for one thing too many, is told what to write."""
    assert says in refused(*argv.split())


def test_a_single_file_is_not_called_files(run, tmp_path):
    """Of two tables one is bad: one file was written."""
    (tmp_path / "bad.yaml").write_text("name: x")
    assert run("convert", "bad.yaml", "ur5", "--out-dir", "out")[1].startswith("1 file written")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_no_permission_is_a_message(refused, tmp_path):
    """A folder without write permission gives one message."""
    (tmp_path / "locked").mkdir(mode=0o500)
    assert "permission" in refused("convert", "ur5", "-o", "locked/x.urdf")


def test_full_disk_loses_nothing(refused):
    """On a full disk the message says so, and the older file stays whole."""
    if subprocess.run(["mountpoint", "-q", "/dev/shm"], check=False).returncode:
        pytest.skip("no small file system at hand")
    folder = Path("/dev/shm/dh2urdf-tiny")
    folder.mkdir(exist_ok=True)
    mount = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", folder], capture_output=True, check=False
    )
    if mount.returncode:
        folder.rmdir()
        pytest.skip("mounting a tmpfs takes root")
    try:
        (folder / "ur5.urdf").write_text("<dh2urdf/> older")
        assert "full" in refused("convert", "ur5", "-o", folder / "ur5.urdf")
        assert [p.name for p in folder.iterdir()] == ["ur5.urdf"]
        assert (folder / "ur5.urdf").read_text() == "<dh2urdf/> older"
    finally:
        subprocess.run(["umount", folder], check=True)
        folder.rmdir()


def test_many_poses_come_from_stdin(run, monkeypatch):
    """`ik ur5 --csv -` reads poses from stdin and answers with one line a solution."""
    monkeypatch.setattr("sys.stdin", io.StringIO("0.4,0.2,0.4,0,3.14,0\n"))
    status, out, _ = run("ik", "ur5", "--csv", "-")
    assert status == 0
    assert len(out.splitlines()) > 2


def test_closed_pipe_ends_quietly():
    """`dh2urdf list | head -1` prints one line and no traceback."""
    command = f"{sys.executable} -m dh2urdf list | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("name")
    assert done.stderr == ""
