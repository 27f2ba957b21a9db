"""Settings of the whole suite."""

import pytest
from browser import ARGUMENTS, chromium
from hypothesis import settings

from dh2urdf.cli import main

settings.register_profile("default", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("default")


@pytest.fixture
def run(capsys, tmp_path, monkeypatch):
    """Run the command line in an empty folder: status, stdout, stderr."""
    monkeypatch.chdir(tmp_path)

    def call(*argv):
        with pytest.raises(SystemExit) as stop:
            main([str(a) for a in argv])
        out, err = capsys.readouterr()
        return stop.value.code, out, err

    return call


@pytest.fixture
def refused(run):
    """Run the command line on what it refuses: status 2, nothing but the message on stderr."""

    def call(*argv):
        status, out, err = run(*argv)
        assert (status, out) == (2, "")
        assert "dh2urdf: " in err
        assert "Traceback" not in err
        return err

    return call


@pytest.fixture
def written(tmp_path):
    """Write a text to a file of a new folder: its path."""

    def write(name, text):
        (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path / name

    return write


@pytest.fixture(scope="module")
def browser():
    """One browser for the module."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
    with sync_api.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=chromium(), args=ARGUMENTS)
        yield browser
        browser.close()
