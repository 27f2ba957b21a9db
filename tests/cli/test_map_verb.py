"""``dh2urdf map``: what it says of a map, and what it refuses."""

import json
import re
import subprocess
import sys
import time

import pytest

from dh2urdf.cli import progress

pytest.importorskip("zarr")

SMALL = ["--step", "0.4", "--orientations", "20"]


def test_a_plane_has_an_area_and_one_orientation(run):
    """Of a planar arm m^2, its task, and a word that orientations do nothing."""
    code, out, _ = run("map", "planar_rr", "-o", "a.zarr", "--step", "0.1", "--orientations", "20")
    assert code == 0
    assert "34 x 34 x 1 voxels of 0.1 m, 1 orientation, task position: 1156 poses" in out
    assert "reached: 8.8 m^2" in out
    assert "one orientation was tried, --orientations does nothing" in out
    code, out, _ = run("map", "planar_rr", "-o", "a.zarr", "--step", "0.1", "--json")
    told = json.loads(out)
    assert (told["task"], told["volume"], told["orientations"]) == ("position", None, 1)
    assert told["area"] == pytest.approx(8.8)
    code, out, _ = run("map", "ur5e", "-o", "b.zarr", *SMALL)
    assert "20 orientations, task pose" in out
    assert "m^3" in out
    assert "does nothing" not in out


@pytest.mark.parametrize("where", [["--region", *"565656"], ["--step", "5"]])
def test_a_map_of_nothing_says_where_the_arm_is(run, where):
    """Beyond the arm, or with voxels that are too large, the ball of its reach is told."""
    code, out, _ = run("map", "ur5e", "-o", "a.zarr", *where)
    assert code == 0
    assert "no voxel's centre is reached: the tip stays within 1.15 m of (0, 0, 0.163)" in out


@pytest.mark.parametrize(("given", "message"), [
    (["ur5e", "--refine", "2", "--each"], "--each: .* without --refine"),
    (["ur5e", "--region", "1", "0", "0", "1", "0", "1"], "--region: .*, got x from 1 to 0"),
    (["gantry_wrist", "--no-limits"], "--region: joint_1, joint_2, joint_3 slides without an end"),
    (["planar_rr", "--towards", "0,0,-1"], "--towards: the joints of planar_rr do not let"),
    (["ur5e", "--within", "20deg"], "--within does nothing without --towards"),
    (["ur5e", "--spins", "3"], "--spins does nothing without --towards"),
    (["planar_rr", "--refine", "1"], "--refine: a planar arm"),
])  # fmt: skip
def test_options_are_named_as_they_are_typed(run, tmp_path, given, message):
    """Refused with one message, exit 2, and nothing written."""
    code, out, err = run("map", *given, "-o", "a.zarr")
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert re.search(message, err)
    assert not (tmp_path / "a.zarr").exists()


@pytest.mark.parametrize("address", ["foo", "tcp://127.0.0.1:9"])
def test_a_scheduler_that_is_none_is_one_line(tmp_path, address):
    """Told within seconds, with nothing after it when the process ends."""
    argv = [sys.executable, "-m", "dh2urdf", "map", "ur5e", "-o", "a.zarr", "--scheduler", address]
    start = time.monotonic()
    done = subprocess.run(argv, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith(f"dh2urdf: {address}: no Dask scheduler answers there")
    assert done.stderr.count("\n") == 1
    assert time.monotonic() - start < 15.0


def test_time_left_counts_the_work_of_this_run(monkeypatch, capsys):
    """Of 100 blocks, 90 done before: after two in ten seconds eight take forty more."""
    clock = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: clock[0])
    with progress.bar("mapping", 1) as report:
        for done in (91, 92):
            clock[0] += 5.0
            report(done, 100)
    assert "mapping: 92 of 100, 40 s left" in capsys.readouterr().err


def test_nothing_is_written_of_an_arm_without_a_solver(run, tmp_path):
    """Exit 2, and no folder of a map that cannot be."""
    table = tmp_path / "scissor.yaml"
    zeros = "theta: 0, d: 0, alpha: 0"
    table.write_text(f"""name: scissor
convention: standard
units: {{length: mm, angle: deg}}
joints:
  - {{name: j1, a: 100, {zeros}, lower: -90, upper: 90}}
  - {{name: s, a: 0, {zeros}, type: prismatic, mimic: {{joint: j1, multiplier: 1 mm/deg}}}}
  - {{name: j2, a: 100, {zeros}}}
""")
    code, _, err = run("map", str(table), "-o", str(tmp_path / "z.zarr"), "--step", "0.1")
    assert code == 2
    assert "has no closed form" in err
    assert not (tmp_path / "z.zarr").exists()
