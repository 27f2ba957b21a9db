"""``-``: every verb that reads a file reads the same from stdin."""

import io
import json

import pytest

import dh2urdf
from dh2urdf.dh_io import table_to_text

TABLE = dh2urdf.load_table("rpr_new_frame")

TEXTS = {
    **{kind: table_to_text(TABLE, kind) for kind in ("yaml", "toml", "json", "csv", "markdown")},
    "urdf": dh2urdf.urdf_text(TABLE),
}

VERBS = {
    "fk": ["fk", "-", "1", "2", "3"],
    "ik": ["ik", "-", "--xyz", "0.1", "5", "0", "--rpy", "0", "0", "1"],
    "show": ["show", "-"],
    "convert": ["convert", "-", "-o", "arm.yaml"],
    "figure": ["figure", "-", "-o", "arm.svg"],
    "workspace": ["workspace", "-", "-o", "arm.svg", "--points=3", "--orientations=1"],
    "map": ["map", "-", "-o", "arm.zarr", "--step=2", "--orientations=1"],
}


@pytest.fixture
def piped(run, monkeypatch):
    """Run a verb with a text on stdin; its JSON object without what a file has in its place."""

    def call(argv, text):
        monkeypatch.setattr("sys.stdin", io.StringIO(text))
        status, out, err = run(*argv, "--json")
        assert status in (0, 1), err
        return json.loads(out.replace(f'"{argv[1]}"', '"SOURCE"'))

    return call


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("kind", TEXTS)
def test_a_table_or_urdf_on_stdin_is_read_as_its_file(piped, tmp_path, verb, kind):
    """The answer to ``-`` is that to the file, whatever the format."""
    path = tmp_path / f"arm.{'md' if kind == 'markdown' else kind}"
    path.write_text(TEXTS[kind])
    argv = VERBS[verb]
    if verb in ("figure", "workspace") and kind not in ("csv", "urdf"):
        argv = ["fk", "-", "0", "0", "0"]  # one picture of each kind of text is enough
    assert piped(argv, TEXTS[kind]) == piped([argv[0], str(path), *argv[2:]], "")


@pytest.mark.parametrize("verb", ["extract", "check"])
def test_a_urdf_on_stdin_is_extracted_and_checked(piped, verb):
    """What came before is still so."""
    answer = piped([verb, "-", *(["--no-run"] if verb == "check" else [])], TEXTS["urdf"])
    assert answer["verb"] == verb
    assert verb == "extract" or answer["files"][0]["path"] == "<stdin>"


def test_poses_on_stdin(run, monkeypatch):
    """--csv - reads poses there."""
    monkeypatch.setattr("sys.stdin", io.StringIO("x,y,z,roll,pitch,yaw\n0.1,5,0,0,0,1\n"))
    status, out, _ = run("ik", "rpr_new_frame", "--csv", "-")
    assert (status, out.splitlines()[0].split(",")[:2]) == (0, ["pose", "solution"])
