"""What long work says of itself on stderr where that is no terminal."""

import os
import re
import subprocess
import sys

import pytest

from dh2urdf.cli import progress


@pytest.mark.parametrize(
    ("seconds", "told"), [(1, []), (2, []), (4, [2]), (20, [2, 7, 12, 17])], ids=str
)
def test_a_log_gets_a_line_every_five_seconds_of_long_work(seconds, told, monkeypatch, capsys):
    """The first after two seconds, none of work that is short or done."""
    now = 100.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    with progress.bar("mapping", 1) as report:
        for done in range(1, seconds + 1):
            now += 1.0
            report(done, seconds)
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "".join(
        f"mapping: {second} of {seconds}, {seconds - second} s left\n" for second in told
    )


def test_work_that_goes_on_foretells_by_what_it_did_itself(monkeypatch, capsys):
    """Seven of ten are done when it first tells: one more in three seconds leaves six seconds."""
    now = 100.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    with progress.bar("mapping", 1) as report:
        for done, seconds in ((7, 1.0), (8, 3.0)):
            now += seconds
            report(done, 10)
    assert capsys.readouterr().err == "mapping: 8 of 10, 6 s left\n"


def test_a_first_report_foretells_nothing_and_a_new_total_begins_again(monkeypatch, capsys):
    """130 of 1000 after a long first part are told alone; ten finer steps have their own pace."""
    now = 100.0
    monkeypatch.setattr(progress.time, "monotonic", lambda: now)
    with progress.bar("placing", 1) as report:
        for done, total in ((130, 1000), (330, 1000), (1, 10), (2, 10)):
            now += 10.0
            report(done, total)
    lines = ["130 of 1000", "330 of 1000, 34 s left", "1 of 10", "2 of 10, 80 s left"]
    assert capsys.readouterr().err == "".join(f"placing: {line}\n" for line in lines)


def test_a_map_tells_how_far_it_is(run, monkeypatch):
    """Thousandths of one map after the other, rising; stdout holds the result alone."""
    monkeypatch.setattr(progress, "QUIET", 0.0)
    monkeypatch.setattr(progress, "EVERY", 0.0)
    monkeypatch.setattr("dh2urdf.workspace.maps.CHUNK", 100)
    argv = ["-o", "reach.svg", "--points", "21", "--orientations", "3"]
    status, out, err = run("workspace", "puma560", *argv)
    assert (status, out) == (0, "reach.svg\n")
    done = [
        int(d) for d in re.findall(r"^mapping: (\d+) of 1000(?:, \d+ s left)?$", err, re.MULTILINE)
    ]
    falls = [k for k in range(1, len(done)) if done[k] <= done[k - 1]]
    assert len(falls) == 1
    assert falls[0] >= 2
    assert len(done) - falls[0] >= 6


NOBODY = """
import sys
from dh2urdf.cli import main, progress
progress.QUIET = progress.EVERY = 0.0
main(sys.argv[1:])
"""


def test_a_log_that_nobody_reads_stops_no_work(tmp_path):
    """A line of progress into a broken pipe is lost; all tables are converted, and said to be."""
    argv = ["convert", "planar_rr", "planar_rrr", "gantry", "--out-dir", os.fspath(tmp_path)]
    reader, writer = os.pipe()
    os.close(reader)
    try:
        done = subprocess.run(
            [sys.executable, "-c", NOBODY, *argv],
            stdout=subprocess.PIPE,
            stderr=writer,
            text=True,
            check=True,
        )
    finally:
        os.close(writer)
    assert done.stdout.startswith("3 files written")
    assert len(list(tmp_path.iterdir())) == 3
