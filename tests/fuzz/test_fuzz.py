"""Every door, whatever comes in: an answer or one message, and nothing else."""

import pytest

from tests.fuzz.doors import DOORS
from tests.fuzz.drive import at_random, attempt

KEPT = [(name, path) for name, door in DOORS.items() for path in door.kept]


@pytest.mark.parametrize(("name", "path"), KEPT, ids=[f"{n}-{p.name}" for n, p in KEPT])
def test_an_input_of_the_corpus_is_answered_or_refused(name, path):
    """What was once found, and what edits begin with, breaks no door."""
    attempt(DOORS[name], path.read_bytes())


@pytest.mark.parametrize("name", DOORS)
def test_a_door_answers_or_says_what_is_wrong(name):
    """No other exception, no warning, hang, memory, file, connection, process or code from data."""
    assert at_random(DOORS[name], DOORS[name].usual, 0) == DOORS[name].usual


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(1, 21))
@pytest.mark.parametrize("name", DOORS)
def test_a_door_holds_for_a_hundred_thousand_inputs(name, seed):
    """The same in twenty parts, each with a seed of its own."""
    assert at_random(DOORS[name], 5000, seed) == 5000
