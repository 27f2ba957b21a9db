"""Runs of the doors: what breaks one is kept once, and told."""

from tests.fuzz import __main__ as runs
from tests.fuzz import drive
from tests.fuzz.door import Door


def fails(data, _):
    """A door that one word breaks."""
    if b"broken" in data:
        raise KeyError("broken")


def test_a_broken_input_is_kept_and_one_of_the_corpus_is_not_kept_again(monkeypatch, tmp_path):
    """What edits break goes to the corpus under a name of its own; what is there stays alone."""
    monkeypatch.setattr(drive, "CORPUS", tmp_path)
    good, bad = (Door("one", fails, seeds=(text,)) for text in (b"whole text", b"broken text"))
    monkeypatch.setitem(runs.DOORS, "one", bad)
    assert "begins with: KeyError" in runs.by_inputs("one", runs.at_random, 10, 0)[1]
    assert not list(tmp_path.rglob("found*"))
    monkeypatch.setitem(runs.DOORS, "one", good)
    monkeypatch.setattr(Door, "tokens", property(lambda _: [b"broken"]))
    count, told = runs.by_inputs("one", runs.at_random, 100, 0)
    (kept,) = tmp_path.rglob("found*")
    assert count == 0
    assert told.startswith(kept.name)
    assert b"broken" in kept.read_bytes()
