"""Every block of the README runs, in order, in one folder."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"
BLOCK = re.compile(r"(?:<!-- (?P<mark>[\w-]+) -->\n)?```(?P<kind>\w+)\n(?P<text>.*?)```", re.S)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """One folder for all blocks, the YAML block saved in it as rpr.yaml."""
    path = tmp_path_factory.mktemp("readme")
    yaml = [m["text"] for m in BLOCK.finditer(README.read_text()) if m["kind"] == "yaml"]
    (path / "rpr.yaml").write_text(yaml[0])
    (path / "docs").mkdir()
    return path


def environment():
    """The environment with this interpreter's commands first."""
    return os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}


def commands():
    """Lines of the README's shell blocks, the two set-up commands and the tests aside."""
    for block in BLOCK.finditer(README.read_text()):
        if block["kind"] == "sh" and not block["mark"]:
            yield from (line for line in block["text"].splitlines() if line.strip())


def run(command, folder, shell=False):
    """A command's end, status and both outputs kept."""
    return subprocess.run(
        command,
        shell=shell,
        cwd=folder,
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
    )


def test_commands_run_one_after_the_other(folder):
    """Each command ends with status 0 and prints something."""
    for command in commands():
        done = run(command, folder, shell=True)
        assert done.returncode == 0, (command, done.stderr)
        assert done.stdout, command


def test_python_blocks_run(folder):
    """Each Python block runs as it stands."""
    for block in BLOCK.finditer(README.read_text()):
        if block["kind"] == "python":
            done = run([sys.executable, "-W", "error", "-c", block["text"]], folder)
            assert done.returncode == 0, done.stderr
            assert done.stdout


def test_main_job_runs_as_the_set_up_command_shows(folder):
    """What follows the installation in the set-up command runs here too."""
    (setup,) = (m["text"] for m in BLOCK.finditer(README.read_text()) if m["mark"] == "set-up")
    jobs = [part.strip() for part in setup.split("&&") if ".venv/bin/dh2urdf" in part]
    assert len(jobs) == 2
    for job in jobs:
        done = run(job.replace(".venv/bin/", ""), folder, shell=True)
        assert done.returncode == 0, done.stderr


def test_pictures_exist_and_name_their_command():
    """Every picture of the README is in the repository, with the command that drew it."""
    text = README.read_text()
    for picture in re.findall(r"!\[[^]]*\]\(([^)]+)\)", text):
        assert (README.parent / picture).is_file(), picture
        assert re.search(rf"`[^`]*{re.escape(picture)}[^`]*`", text), picture
