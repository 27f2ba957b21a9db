"""The referee's sweep: a few arms of each class, and that it sees what is missing."""

from types import SimpleNamespace

import numpy as np
import pytest
from sweep import Tally

from tests.referee.__main__ import FAULTS, compare, sweep
from tests.referee.arms import CLASSES


def faults(tally):
    """What a tally says of what must not be."""
    return [note for note in tally.notes if note.startswith(FAULTS)]


@pytest.mark.parametrize("name", [name for name in CLASSES if name != "shipped"])
def test_all_that_a_search_finds_is_among_the_solutions(name):
    """Two arms of the class, a pose each; and none of them is refused."""
    tally = sweep(name, 2, 1, 30, 10)
    assert faults(tally) == []
    assert tally.count["searched"] > 0
    assert tally.count["refused"] == 0


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", CLASSES)
def test_all_that_a_search_finds_is_among_the_solutions_of_many_arms(name):
    """A thousand arms of each class, and all that ship."""
    assert faults(sweep(name, 1000, 1, 60, 11)) == []


def test_a_solution_that_is_taken_away_is_missed():
    """The search finds it, and the count says so."""
    import dh2urdf
    from dh2urdf.conversions.write.table_chain import dh_to_chain

    table = dh2urdf.load_table("puma560")
    robot, chain = dh2urdf.Robot.from_dh(table), dh_to_chain(table)
    T = robot.fk(np.array([0.3, -0.5, 0.4, 0.7, 0.9, 0.2]))
    found = robot.ik(T, within_limits=False)
    tally = Tally("taken away")
    batch = SimpleNamespace(found=found.q[1:], masks=np.zeros(len(found) - 1, int), T=T)
    compare(tally, (table, chain), batch, found.q, np.ones(6, bool))
    assert (tally.count["searched"], tally.count["search lost"]) == (len(found), 1)
