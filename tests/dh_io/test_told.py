"""What a file does not say is told from outside; what it says is never overruled."""

import json

import numpy as np
import pytest

import dh2urdf
from dh2urdf.cli import main
from dh2urdf.dh_io import told
from dh2urdf.exceptions import TableError, TableFileError

SILENT = "theta,d,a,alpha\n0,89.159,0,90\n0,0,-425,0\n0,0,-392.25,0\n"
SAYING = f"# convention: standard\n# units: mm, deg\n{SILENT}"


def outcome(*words):
    """Exit status of a command line."""
    with pytest.raises(SystemExit) as done:
        main([str(word) for word in words])
    return done.value.code


@pytest.fixture
def silent(tmp_path):
    """A table as a spreadsheet writes it: no convention, no units."""
    path = tmp_path / "arm.csv"
    path.write_text(SILENT)
    return path


@pytest.mark.parametrize("units", ["mm,deg", "deg mm", ("mm", "deg"), ["millimetres", "°"]])
@pytest.mark.parametrize("convention", ["standard", "Paul", dh2urdf.DHConvention.STANDARD])
def test_a_silent_file_is_read_as_it_was_told(silent, tmp_path, convention, units):
    """The table is the one of a file that says so itself."""
    saying = tmp_path / "saying" / "arm.csv"
    saying.parent.mkdir()
    saying.write_text(SAYING)
    assert dh2urdf.load_table(silent, convention, units) == dh2urdf.load_table(saying)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize(
    "verb",
    [
        ["fk", "0", "1", "2", "--json"],
        ["show"],
        ["convert", "-o", "-"],
        ["figure", "-o", "arm.svg"],
    ],
)
def test_every_verb_takes_what_a_file_does_not_say(
    silent, verb, convention, capsys, tmp_path, monkeypatch
):
    """Without it the exit status is 2, with it 0; the two conventions give two arms."""
    monkeypatch.chdir(tmp_path)
    assert outcome(verb[0], silent, *verb[1:]) == 2
    assert "--convention" in (capsys.readouterr().err)
    words = ["--convention", convention, "--units", "mm,deg"]
    assert outcome(verb[0], silent, *verb[1:], *words) == 0
    if verb[0] == "fk":
        shown = json.loads(capsys.readouterr().out)["T_base_tip"]
        arm = dh2urdf.load_table(silent, convention, "mm,deg")
        np.testing.assert_allclose(shown, arm.fk([0, 1, 2]), atol=1e-15)


@pytest.mark.parametrize(
    ("head", "words", "says"),
    [
        ("# convention: standard\n", {"convention": "modified"}, "found 'standard', but told"),
        ("# units: m, deg\n", {"units": "mm,deg"}, "units.length: found 'm', but told mm"),
        ("# units: mm, rad\n", {"units": "mm,deg"}, "units.angle: found 'rad', but told deg"),
    ],
)
def test_what_a_file_says_is_not_overruled(silent, head, words, says):
    """A contradiction is a fault at the cell of the file."""
    silent.write_text(head + SILENT)
    given = {"convention": "standard", "units": "mm,deg"} | words
    with pytest.raises(TableFileError, match=says) as caught:
        dh2urdf.load_table(silent, **given)
    assert "arm.csv:1:" in str(caught.value)


def test_headings_and_what_was_told_complete_each_other(silent):
    """Angles by the headings, lengths as told."""
    heads = "theta (deg),d,a,alpha (deg)"
    silent.write_text(SILENT.replace("theta,d,a,alpha", heads))
    table = dh2urdf.load_table(silent, "standard", "mm")
    assert table.rows[0].d == 0.089159
    assert table.rows[0].alpha == np.pi / 2


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ({"convention": "dh"}, "convention: found 'dh'; allowed: standard, modified"),
        ({"convention": 3}, "convention: found 3"),
        ({"units": "furlong,deg"}, "units: found 'furlong,deg'; expected a length"),
        ({"units": "mm,cm"}, "units: found 'mm,cm'"),
        ({"units": 3}, "units: found 3"),
        ({"units": [3]}, r"units: found \[3\]"),
    ],
)
def test_what_is_told_is_checked(words, says):
    """No convention, no unit, or two of one kind."""
    with pytest.raises(TableError, match=says):
        told(**words)


@pytest.mark.parametrize(
    ("format", "text", "example"),
    [
        ("csv", "theta,d,a,alpha\n0,l2,0,0\n", ["# convention: standard", "# units: mm, deg"]),
        ("markdown", "|theta|d|a|alpha|\n|-|-|-|-|\n|0|l2|0|0|\n", ["convention: standard,"]),
        ("yaml", "joints: [{theta: 0, d: l2, a: 0, alpha: 0}]\n", ["{length: mm, angle: deg}"]),
        ("toml", "joints = [{theta = 0, d = 1, a = 'l2', alpha = 0}]\n", ['convention = "stand']),
        ("json", '{"joints": [{"theta": 0, "d": 0, "a": "l2"}]}', ['"units": {"length": "mm"']),
    ],
)
def test_hints_are_in_the_format_of_the_file(format, text, example, tmp_path):
    """What a hint says to write, a file of that format may hold."""
    with pytest.raises(TableFileError) as caught:
        dh2urdf.dh_io.parse_table(text, format, f"arm.{format}")
    assert all(words in str(caught.value) for words in example)
