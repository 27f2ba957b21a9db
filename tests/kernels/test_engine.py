"""Which form of the kernels runs, and what is said about it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

ANSWER = """
from dh2urdf import engine
from tests.translate import golden
assert list(golden.lines("planar_rr", 3)) == golden.kept()["planar_rr"][:3]
print(engine._COMPILED and engine._COMPILED.LEVEL)
"""
"""Answers of planar_rr are the golden ones; the level of the extension, or None."""

WITHOUT = "import sys; sys.modules['dh2urdf._kernels'] = None\n"

OTHER = """
import sys, types
built = types.SimpleNamespace(__file__="{file}", SOURCES="those of last week", LEVEL="any")
sys.modules["dh2urdf._kernels"] = built
"""

COMMAND = "python -m dh2urdf.translate.build"


@pytest.fixture
def stale(tmp_path):
    """A program that finds an extension of other sources, older than ours."""
    (tmp_path / "built.so").touch()
    os.utime(tmp_path / "built.so", (0, 0))
    return OTHER.format(file=tmp_path / "built.so")


def ran(program, **variables):
    """Status, stdout and stderr of a program, none but these of our variables set."""
    own = {k: v for k, v in os.environ.items() if not k.startswith("DH2URDF_")}
    words = [sys.executable, "-c", program]
    done = subprocess.run(
        words, cwd=ROOT, env=own | variables, capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout.strip(), done.stderr


def test_compiled_kernels_run_and_nothing_is_said():
    """An installation has the extension."""
    status, out, err = ran(ANSWER)
    assert (status, err) == (0, "")
    assert out != "None"


@pytest.mark.parametrize("level", ["any", "v3", "v4"])
def test_every_level_gives_the_same_answers(level):
    """The variable names the level; a processor that lacks it is told so."""
    status, out, err = ran(ANSWER, DH2URDF_LEVEL=level)
    if status:
        assert level != "any"
        assert "that this processor has" in err
    else:
        assert (out, err) == (level, "")


def test_interpreted_as_asked_for_nothing_is_said():
    """The variable takes the kernels as they are written: the same bits."""
    assert ran(ANSWER, DH2URDF_ENGINE="python") == (0, "None", "")


def test_without_the_extension_one_warning_names_the_command():
    """The answers are the same bits all the same."""
    status, out, err = ran(WITHOUT + ANSWER)
    assert (status, out) == (0, "None"), err
    assert err.count("Warning") == 1
    assert "the kernels are not compiled" in err
    assert COMMAND in err


def test_an_extension_of_other_sources_is_not_used(stale):
    """One warning names the command, and the kernels run as they are written."""
    status, out, err = ran(stale + ANSWER)
    assert (status, out) == (0, "None"), err
    assert err.count("Warning") == 1
    assert "were edited after they were compiled" in err
    assert COMMAND in err


def test_nothing_but_the_extension_if_asked_for(stale):
    """Where there is none, or one of other sources, the error says so and names the command."""
    for before, fault in ((WITHOUT, "are not compiled"), (stale, "were edited")):
        status, _, err = ran(before + ANSWER, DH2URDF_ENGINE="compiled")
        last = err.splitlines()[-1]
        assert status == 1
        assert last.startswith(f"ImportError: DH2URDF_ENGINE=compiled: the kernels {fault}")
        assert COMMAND in last


@pytest.mark.parametrize(
    ("variable", "message"),
    [
        ("DH2URDF_ENGINE", "expected compiled or python, got 'fast'"),
        ("DH2URDF_LEVEL", "expected one of v4, v3, any that this processor has, got fast"),
    ],
)
def test_other_values_of_the_variables_are_refused(variable, message):
    """The error says what may be given."""
    status, _, err = ran(ANSWER, **{variable: "fast"})
    assert (status, err.splitlines()[-1]) == (1, f"ValueError: {variable}: {message}")
