"""The scripts and notebooks of ``examples/`` run, and what is kept of a run is small and whole."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import nbformat
import pytest

import dh2urdf

FOLDER = Path(__file__).parents[2] / "examples"
SCRIPTS = sorted(FOLDER.glob("*.py"))
NOTEBOOKS = sorted((FOLDER / "notebooks").glob("*.ipynb"))

LARGEST = 256 * 1024
"""Of a notebook [bytes]: its pictures have few colours, one has the page of a small arm."""

ENDS = "not run: "
"""How a script begins its one line where what it shows is not installed."""


def name(path):
    """Of a case."""
    return path.stem


def shown(notebook):
    """What each cell printed, and the kinds of what else it has."""
    return [
        [o.text if o.output_type == "stream" else sorted(o.data) for o in cell.get("outputs", ())]
        for cell in notebook.cells
    ]


@pytest.fixture(scope="module")
def runner():
    """``examples/notebooks/execute.py``."""
    path = FOLDER / "notebooks" / "execute.py"
    spec = importlib.util.spec_from_file_location("execute", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("script", SCRIPTS, ids=name)
def test_a_script_runs_and_says_what_it_found(script, tmp_path):
    """Status 0, something on stdout, nothing on stderr; Drake's is left out without Drake."""
    done = subprocess.run(
        [sys.executable, "-W", "error", script],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout
    assert not done.stderr
    if done.stdout.startswith(ENDS):
        assert script.stem == "drake_reads_it"
        pytest.skip(done.stdout.strip())


@pytest.mark.parametrize("path", NOTEBOOKS, ids=name)
def test_a_notebook_runs_and_prints_what_is_kept(path, runner, monkeypatch):
    """Every cell runs in a fresh kernel, and its outputs are what the file has, pictures aside."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(FOLDER.parent), *sys.path[:1]]))
    assert shown(runner.tidied(runner.executed(path))) == shown(nbformat.read(path, as_version=4))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=name)
def test_a_kept_notebook_is_small_whole_and_without_errors(path):
    """Each code cell was run, in order; no output is an error or a warning; few bytes."""
    notebook = nbformat.read(path, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell.outputs]
    assert not [o for o in outputs if o.output_type == "error" or o.get("name") == "stderr"]
    assert path.stat().st_size <= LARGEST


def test_the_index_names_every_example():
    """``examples/README.md`` has a line for each script and notebook."""
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert [
        p.name for p in [*SCRIPTS, *NOTEBOOKS] if f"({p.relative_to(FOLDER)})" not in text
    ] == []


@pytest.mark.parametrize("path", NOTEBOOKS, ids=name)
def test_notebooks_use_what_is_public(path):
    """What they import of the package has no underscore and stands at its top or in a room's."""
    rooms = {"dh2urdf", "dh2urdf.figures", "dh2urdf.symbolic"}
    for cell in nbformat.read(path, as_version=4).cells:
        for line in cell.source.splitlines() if cell.cell_type == "code" else ():
            if line.startswith(("import dh2urdf", "from dh2urdf")):
                assert line.split()[1] in rooms, line
            assert "._" not in line, line


def does(*line):
    """A command that ends with 0."""
    done = subprocess.run(line, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done


def configured(arm, folder):
    """The build folder of the CMake project with an arm."""
    command, build = folder / "dh2urdf", folder / "build"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m dh2urdf "$@"\n')
    command.chmod(0o755)
    words = [f"-DDH2URDF={command}", f"-DARM={arm}", "-DCMAKE_BUILD_TYPE=Debug"]
    does("cmake", "-S", FOLDER / "cmake_solver", "-B", build, *words)
    return build


@pytest.mark.skipif(not shutil.which("cmake"), reason="no cmake: apt-get install cmake")
def test_the_cmake_project_writes_the_solver_of_a_file_that_changed_anew(tmp_path):
    """The header is that of the table as it is, not as it was when it was first built."""
    table = tmp_path / "arm.yaml"
    dh2urdf.save_table(dh2urdf.load_table("planar_rr"), table)
    build = configured(table, tmp_path)
    does("cmake", "--build", build, "--target", "solve")
    before = (build / "arm.h").read_text()
    other = replace(dh2urdf.load_table(table), tool=dh2urdf.Origin((0.325, 0.0, 0.0)))
    dh2urdf.save_table(other, table)
    does("cmake", "--build", build, "--target", "solve")
    after = (build / "arm.h").read_text()
    sums = [re.search("links and joints: ([0-9a-f]{64})", text)[1] for text in (before, after)]
    assert sums[0] != sums[1]


@pytest.mark.skipif(not shutil.which("cmake"), reason="no cmake: apt-get install cmake")
@pytest.mark.parametrize(("arm", "solutions"), [("puma560", 8), ("xarm6", 10)])
def test_the_cmake_project_builds_and_its_tests_pass(arm, solutions, tmp_path):
    """The header is written by the build, the test that comes with it passes, and solve solves.

    Of an arm with and of one without a workspace.
    """
    build = configured(arm, tmp_path)
    does("cmake", "--build", build)
    done = does("ctest", "--test-dir", build)
    assert "100% tests passed, 0 tests failed out of 2" in done.stdout
    solved = subprocess.run([build / "solve"], capture_output=True, text=True, check=True)
    assert solved.stdout.count("residual") == solutions
    assert solved.stdout.split()[:6] == [f"{0.2 + 0.1 * i:.5f}" for i in range(6)]
