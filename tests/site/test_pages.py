"""Sources of the documentation's pages, without building them."""

import re
from pathlib import Path

import numpy as np
import pytest

import dh2urdf
from dh2urdf import Robot, compare
from docs.extensions.blocks import Runner, blocks

DOCS = Path(__file__).parents[2] / "docs"
PAGES = [p for p in sorted(DOCS.rglob("*.md")) if "_build" not in p.parts]
RUN = ("sh", "python")


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(DOCS)))
def test_blocks_run_or_say_why_not(page):
    """A block runs, is saved as a file, is a directive, or has a comment with the reason above."""
    for block in blocks(page.read_text()):
        runs = block.kind in RUN or block.file or block.kind.startswith("{")
        assert runs or block.mark.startswith("not run: "), (block.kind, block.text)


def test_answers_of_exercises_are_marked_as_right(written):
    """Each exercise has a solution's file, and its answer is the same arm."""
    answers = {b.file: b.text for b in blocks((DOCS / "notes" / "exercises.md").read_text())}
    solutions = sorted((DOCS / "notes" / "files").glob("exercise_*.yaml"))
    assert len(solutions) >= 4
    for solution in solutions:
        name = solution.name.replace("exercise", "my")
        assert compare(written(name, answers[name]), solution).same, name


def test_every_public_name_is_in_the_reference():
    """The page of the Python interface has what ``dh2urdf.__all__`` lists."""
    page = (DOCS / "reference" / "api.md").read_text()
    shown = set(re.findall(r"^\.\. auto\w+:: (?:dh2urdf\.)?(\w+)$", page, re.M))
    assert set(dh2urdf.__all__) - shown <= {"Dh2UrdfError"}  # is one of the errors


def _block(text):
    (block,) = blocks(text)
    return block


def test_runner_shows_what_blocks_print(tmp_path):
    """Python blocks of a page share their names, commands their folder."""
    run = Runner(tmp_path)
    assert run(_block("```{code-block} yaml\n:caption: a.txt\n\nhello\n```")) == ""
    assert run(_block("```sh\ncat a.txt\n```")) == "hello\n"
    assert run(_block("```sh\ncat \\\n  a.txt\necho two\n```")).count("$ ") == 2
    assert run(_block("```python\nx = 2\n```")) == ""
    assert run(_block("```python\nprint(x + 1)\n```")) == "3\n"


def test_runner_fails_where_a_command_does(tmp_path):
    """Another status than the one said is an error, zero included."""
    run = Runner(tmp_path)
    assert run(_block("<!-- status 1 -->\n```sh\nfalse\n```")) == ""
    for text in ("```sh\nfalse\n```", "<!-- status 1 -->\n```sh\ntrue\n```"):
        with pytest.raises(RuntimeError, match="status"):
            run(_block(text))


def test_the_forearm_of_the_page_on_coupled_joints_stays_at_the_angle_shown(written):
    """Whatever J2 is; and FANUC's turns of J4 and J6 are those of q."""
    texts = {b.file: b.text for b in blocks((DOCS / "howto" / "coupled.md").read_text())}
    robot = Robot.from_dh(written("coupled.yaml", texts["coupled.yaml"]))
    q = np.radians([[10, j2, j3, 0, 0, 0] for j2 in (0, 20, 40) for j3 in (-30, 10)])
    assert np.abs(np.arcsin(robot.fk(q)[:, 2, 2]) - q[:, 2]).max() < 1e-12
    shown = np.radians([10, 20, 10, 185, -40, -200])
    (word, *_) = robot.ik(robot.fk(shown), seed=shown).words("fanuc")
    assert word[3:] == (0, 1, -1)
