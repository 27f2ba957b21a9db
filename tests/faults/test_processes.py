"""Many processes and long runs: one robot in all of them, caches, homes, clocks, memory."""

import multiprocessing
import os
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

from dh2urdf import Robot

SCRIPT = "import sys; from dh2urdf.cli import main; main(sys.argv[1:])"


def solved(robot, T):
    """The bits of all solutions."""
    return robot.ik(T).q.tobytes()


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_a_robot_answers_the_same_in_another_process(method):
    """However that process was begun, and after the robot was used here."""
    robot = Robot.from_dh("puma560")
    T = robot.fk(0.3 * robot.lower + 0.7 * robot.upper)
    here = solved(robot, T)
    with warnings.catch_warnings(action="ignore", category=DeprecationWarning):  # of fork, in 3.12
        pool = multiprocessing.get_context(method).Pool(2)
    with pool:
        assert pool.starmap(solved, [(robot, T)] * 4) == [here] * 4


def begun(*words, **settings):
    """A command line in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", SCRIPT, *words],
        env={**os.environ, **settings},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(process):
    """What a process said, which has to have succeeded."""
    said = process.communicate()[1]
    assert process.returncode == 0, said
    return said


def test_ten_processes_that_start_at_once_write_one_whole_file(tmp_path, monkeypatch):
    """All succeed, and the file is what one of them writes; there is nothing that they share."""
    monkeypatch.chdir(tmp_path)
    ended(begun("convert", "planar_rr", "-o", "alone.urdf"))
    for process in [begun("convert", "planar_rr", "-o", "a.urdf", "--force") for _ in range(10)]:
        ended(process)
    assert Path("a.urdf").read_bytes() == Path("alone.urdf").read_bytes()
    assert sorted(os.listdir()) == ["a.urdf", "alone.urdf"]


@pytest.mark.parametrize("kind", ["read-only", "damaged"])
def test_figures_are_drawn_whatever_the_home_holds(kind, tmp_path, monkeypatch):
    """The one cache there is, Matplotlib's list of fonts, may be damaged or out of reach."""
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    home = Path("/proc/self") if kind == "read-only" else tmp_path / "home"
    if kind == "damaged":
        import matplotlib.font_manager as fonts

        cache = home / ".cache" / "matplotlib"
        cache.mkdir(parents=True)
        (cache / f"fontlist-v{fonts.FontManager.__version__}.json").write_text('{"_version": "0"')
    names = {"HOME": str(home), "XDG_CACHE_HOME": "", "XDG_CONFIG_HOME": "", "MPLCONFIGDIR": ""}
    assert "Traceback" not in ended(begun("figure", "planar_rr", "-o", "a.svg", **names))
    assert Path("a.svg").stat().st_size > 1000


def test_nothing_is_kept_in_the_home(tmp_path, monkeypatch):
    """Commands that draw nothing leave an empty home empty."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "home").mkdir()
    for words in (("fk", "planar_rr", "0", "1"), ("convert", "planar_rr", "-o", "a.urdf")):
        ended(begun(*words, HOME=str(tmp_path / "home"), XDG_CACHE_HOME="", XDG_CONFIG_HOME=""))
    assert list((tmp_path / "home").rglob("*")) == []


def test_a_clock_that_is_set_back_changes_nothing(monkeypatch, run):
    """Answers, and the time that progress tells, come from clocks that nobody sets."""
    day = iter(range(10**9, 0, -86_400))
    before = run("convert", "planar_rr", "-o", "a.urdf", "--json")
    monkeypatch.setattr(time, "time", lambda: float(next(day)))
    assert run("convert", "planar_rr", "-o", "a.urdf", "--json") == before
    assert run("map", "planar_rr", "-o", "m.zarr", "--step", "0.5")[0] == 0


@pytest.mark.parametrize("poses", [400_000, pytest.param(10**7, marks=pytest.mark.exhaustive)])
def test_memory_does_not_grow_with_the_poses_solved(poses):
    """Batches one after the other need what the first of them needs, within 20 MB."""
    robot = Robot.from_dh("puma560")
    Ts = robot.fk(np.random.default_rng(0).uniform(robot.lower, robot.upper, (50_000, 6)))
    sizes = []
    for _ in range(poses // len(Ts)):
        robot.ik_batch(Ts)
        sizes.append(resident())
    grown = max(sizes[1:]) - sizes[1]
    print(f"{poses} poses: {sizes[-1] / 1e6:.1f} MB, {grown / 1e6:.1f} MB more than at first")
    assert grown < 20_000_000


def resident():
    """Memory of this process that is in use [bytes]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")
