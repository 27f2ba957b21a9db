"""Writing verbs that are killed, that find the disk full, or may not write."""

import random
import subprocess
import sys
from pathlib import Path

import pytest
from writers import VERBS, killed_at_work

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


@pytest.mark.parametrize("took", [0.01, 0.1, 10.0])
def test_kills_come_while_a_verb_is_at_work_whatever_its_first_run_took(took):
    """Where others had the processor then, later moments are sooner, and still anywhere."""
    moments = []

    def one(seconds):
        at_work = seconds < 0.1
        moments.extend([seconds] * at_work)
        return at_work

    assert killed_at_work(one, took, 20, random.Random(0)) == len(moments) == 20
    assert min(moments) < 0.3 * min(took, 0.1)
    assert max(moments) > 0.7 * min(took, 0.1)


@pytest.mark.exhaustive
@pytest.mark.parametrize("verb", [*VERBS, "map"])
def test_a_writer_may_be_killed_twenty_times(verb, tmp_path):
    """The same of one verb, 240 times in all, each time while it is at work."""
    assert tried(tmp_path, 20, verb) == 20
