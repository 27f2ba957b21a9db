"""Writing verbs that are killed, that find the disk full, or may not write."""

import subprocess
import sys
from pathlib import Path

import pytest

WRITERS = Path(__file__).parents[1] / "helpers" / "writers.py"


@pytest.mark.parametrize("times", [3, pytest.param(20, marks=pytest.mark.exhaustive)])
def test_a_file_is_the_old_one_or_the_new_whatever_befalls_its_writer(times, tmp_path):
    """After kill -9 at a random moment; and one message where the disk is full or forbidden."""
    command = [sys.executable, str(WRITERS), str(tmp_path), str(times), "0"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    killed = {verb: int(count) for verb, count in map(str.split, done.stdout.splitlines())}
    assert sum(killed.values()) > 0.7 * times * len(killed) > 0
