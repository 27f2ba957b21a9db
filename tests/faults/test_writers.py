"""Writing verbs that are killed, that find the disk full, or may not write."""

import subprocess
import sys
from pathlib import Path

import pytest
from writers import VERBS

WRITERS = Path(__file__).parents[1] / "helpers" / "writers.py"


def tried(folder, times, *verbs):
    """How often verbs were killed at work, in so many tries each."""
    command = [sys.executable, str(WRITERS), str(folder), str(times), "0", *verbs]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    return sum(int(line.split()[1]) for line in done.stdout.splitlines())


def test_a_file_is_the_old_one_or_the_new_whatever_befalls_its_writer(tmp_path):
    """After kill -9 at a random moment; and one message where the disk is full or forbidden.

    A map that is killed ends, begun again, as one that never was.
    """
    assert tried(tmp_path, 1) == len(VERBS) + 1


@pytest.mark.exhaustive
@pytest.mark.parametrize("verb", [*VERBS, "map"])
def test_a_writer_may_be_killed_twenty_times(verb, tmp_path):
    """The same of one verb, 240 times in all, each time while it is at work."""
    assert tried(tmp_path, 20, verb) == 20
