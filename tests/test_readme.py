"""Every block of the README runs, in order, in one folder."""

import re
import sys
from pathlib import Path

import pytest

from docs.extensions.blocks import blocks, run

README = Path(__file__).parents[1] / "README.md"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """One folder for all blocks, the YAML block saved in it as rpr.yaml."""
    path = tmp_path_factory.mktemp("readme")
    yaml = [block.text for block in _blocks("yaml")]
    (path / "rpr.yaml").write_text(yaml[0])
    (path / "docs").mkdir()
    return path


def _blocks(kind):
    return [block for block in blocks(README.read_text()) if block.kind == kind]


def test_commands_run_one_after_the_other(folder):
    """Each command ends with status 0 and prints something; set-up, tests and servers aside."""
    for block in _blocks("sh"):
        for command in [] if block.mark else block.commands():
            done = run(command, folder)
            assert done.returncode == 0, (command, done.stderr)
            assert done.stdout, command


def test_python_blocks_run(folder):
    """Each Python block runs as it stands."""
    for block in _blocks("python"):
        done = run([sys.executable, "-W", "error", "-c", block.text], folder)
        assert done.returncode == 0, done.stderr
        assert done.stdout


def test_main_job_runs_as_the_set_up_command_shows(folder):
    """What follows the installation in the set-up command runs here too."""
    (setup,) = (block.text for block in _blocks("sh") if block.mark == "set-up")
    jobs = [part.strip() for part in setup.split("&&") if ".venv/bin/dh2urdf" in part]
    assert len(jobs) == 2
    for job in jobs:
        done = run(job.replace(".venv/bin/", ""), folder)
        assert done.returncode == 0, done.stderr


def test_pictures_exist_and_name_their_command():
    """Every picture of the README is in the repository, with the command that drew it."""
    text = README.read_text()
    for picture in re.findall(r"!\[[^]]*\]\(([^)]+)\)", text):
        assert (README.parent / picture).is_file(), picture
        assert re.search(rf"`[^`]*{re.escape(picture)}[^`]*`", text), picture
