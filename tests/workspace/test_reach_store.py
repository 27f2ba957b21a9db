"""Maps that are stored: read without the package, gone on with after a kill, not mixed."""

import errno
import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import xarray
from hostile import outcome

import dh2urdf
from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError, OutputError, OutputExistsError
from dh2urdf.workspace import map_summary, open_map, reach_map
from dh2urdf.workspace.reach import job, provenance, store
from dh2urdf.workspace.stored_map import map_cut

GIVEN = {"step": 0.1, "orientations": 2800, "region": ((0.0, 0.8), (-0.4, 0.4), (0.0, 0.8))}
"""Eight blocks of 4 x 4 x 4 voxels."""


@pytest.fixture(scope="module")
def ur5e():
    return Robot.from_dh("ur5e")


SMALL = {"step": 0.4, "orientations": 2, "region": ((0.0, 0.4), (0.0, 0.4), (0.0, 0.4))}


@pytest.fixture(scope="module")
def small(ur5e, tmp_path_factory):
    """A stored map of one voxel."""
    path = tmp_path_factory.mktemp("small") / "arm.zarr"
    reach_map(ur5e, **SMALL, store=path).close()
    return path


@pytest.fixture(scope="module")
def whole(ur5e):
    """The map in memory."""
    return reach_map(ur5e, **GIVEN)


def files(folder):
    """All files of a folder and their bytes."""
    return {p.relative_to(folder): p.read_bytes() for p in Path(folder).rglob("*") if p.is_file()}


def test_a_store_is_read_by_xarray_alone(ur5e, whole, tmp_path):
    """A process without the package finds values, units, coordinates, and where they came from."""
    reach_map(ur5e, **GIVEN, store=tmp_path / "arm.zarr")
    read = (
        "import sys, xarray, json\n"
        "found = xarray.open_zarr('arm.zarr')\n"
        "assert 'dh2urdf' not in sys.modules\n"
        "print(json.dumps([float(found.share.sum()), found.x.units, found.share.long_name,"
        " found.attrs['table'], found.attrs['dh2urdf_map']['version']]))\n"
    )
    done = subprocess.run(
        [sys.executable, "-I", "-c", read], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    total, unit, words, table, version = json.loads(done.stdout)
    assert np.isclose(total, float(whole.share.sum()), rtol=1e-6)
    assert (unit, words) == ("m", "share of orientations reached")
    assert version == dh2urdf.__version__
    (tmp_path / "again.yaml").write_text(table)
    assert dh2urdf.load_table(tmp_path / "again.yaml") == ur5e.table


def test_stored_and_in_memory_are_the_same_bits(ur5e, whole, tmp_path):
    """Every variable, coordinate and attribute; and two stores of one call are the same files."""
    for name in ("a.zarr", "b.zarr"):
        kept = reach_map(ur5e, **GIVEN, store=tmp_path / name)
        xarray.testing.assert_identical(kept.load(), whole)
    assert files(tmp_path / "a.zarr") == files(tmp_path / "b.zarr")


def test_a_run_that_was_killed_goes_on_and_ends_in_the_same_bits(ur5e, tmp_path, monkeypatch):
    """Killed after some blocks, only the others are worked out, and the files are the same."""
    reach_map(ur5e, **GIVEN, store=tmp_path / "whole.zarr")
    script = (
        "import sys, dh2urdf\nfrom dh2urdf.workspace import reach_map\n"
        f"reach_map(dh2urdf.Robot.from_dh('ur5e'), **{GIVEN!r}, store='arm.zarr', progress="
        "lambda done, total: print(done, flush=True))\n"
    )
    run = subprocess.Popen(
        [sys.executable, "-c", script], cwd=tmp_path, stdout=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": str(Path(dh2urdf.__file__).parents[1])},
    )  # fmt: skip
    with run:
        while int(run.stdout.readline()) < 2:
            pass
        os.kill(run.pid, signal.SIGKILL)
    before = store.done(str(tmp_path / "arm.zarr"))
    assert 2 <= before.sum() < before.size
    worked, once = [], job.block_values
    monkeypatch.setattr(job, "block_values", lambda *a: worked.append(a[2]) or once(*a))
    reach_map(ur5e, **GIVEN, store=tmp_path / "arm.zarr")
    assert len(worked) == len(set(worked)) == before.size - before.sum()
    assert files(tmp_path / "arm.zarr") == files(tmp_path / "whole.zarr")


@pytest.mark.parametrize(("change", "key"), [
    ({"step": 0.2}, "step 0.1, asked is 0.2"),
    ({"orientations": 200}, "orientations .*2800, 1.*asked is .*200, 1"),
    ({"within_limits": False}, "within_limits True, asked is False"),
    ({"region": ((-0.8, 0.8), (-0.8, 0.8), (0.1, 0.9))}, "low"),
    ({"refine": 1}, "refine 0, asked is 1"),
])  # fmt: skip
def test_maps_of_other_settings_are_not_mixed(ur5e, tmp_path, change, key):
    """One message names the store, the first setting that differs, and both values."""
    small = GIVEN | {"region": ((0.0, 0.2), (0.0, 0.2), (0.0, 0.2))}
    reach_map(ur5e, **small, store=tmp_path / "arm.zarr")
    before = files(tmp_path)
    with pytest.raises(ArgumentError, match=rf"arm.zarr: is a map with .*{key}"):
        reach_map(ur5e, **(small | change), store=tmp_path / "arm.zarr")
    with pytest.raises(ArgumentError, match=r"is a map with robot ur5e, asked is ur3e"):
        reach_map(Robot.from_dh("ur3e"), **small, store=tmp_path / "arm.zarr")
    assert files(tmp_path) == before


def test_a_changed_arm_is_refused_by_what_changed(ur5e, tmp_path):
    """The joint and its limit, or the link after it, with both values; no digests."""
    small = GIVEN | {"region": ((0.0, 0.2), (0.0, 0.2), (0.0, 0.2))}
    reach_map(ur5e, **small, store=tmp_path / "arm.zarr")
    rows = ur5e.table.rows
    for change, words in [
        ({"upper": 1.5}, r"upper limit of shoulder_lift_joint 6\.28\d*, asked is 1\.5;"),
        (
            {"a": -0.5},
            r"link after shoulder_lift_joint, row \d, column 4: -?0\.425, asked is -?0\.5;",
        ),
    ]:
        other = replace(ur5e.table, rows=(rows[0], replace(rows[1], **change), *rows[2:]))
        with pytest.raises(ArgumentError, match=rf"arm.zarr: is a map with {words}"):
            reach_map(Robot.from_dh(other), **small, store=tmp_path / "arm.zarr")


def test_a_store_of_another_version_is_refused(ur5e, tmp_path, monkeypatch):
    """Values of two versions of the package do not stand in one map."""
    small = GIVEN | {"region": ((0.0, 0.2), (0.0, 0.2), (0.0, 0.2))}
    reach_map(ur5e, **small, store=tmp_path / "arm.zarr")
    monkeypatch.setattr(provenance, "version", lambda _: "99.0")
    with pytest.raises(ArgumentError, match=r"arm.zarr: is a map with version .*, asked is 99.0"):
        reach_map(ur5e, **small, store=tmp_path / "arm.zarr")


@pytest.mark.parametrize("kind", ["file", "folder", "group", "array"])
def test_what_is_no_map_stays_untouched(ur5e, tmp_path, kind):
    """A file, a folder with something in it, and other people's Zarr are refused as they are."""
    import zarr

    path = tmp_path / "arm.zarr"
    if kind == "file":
        path.write_text("mine")
    elif kind == "folder":
        path.mkdir()
        (path / "mine").write_text("mine")
    else:
        make = zarr.create_group if kind == "group" else zarr.create_array
        make(str(path), **({} if kind == "group" else {"shape": (2,), "dtype": "f8"}))
    before = files(tmp_path)
    with pytest.raises(OutputExistsError, match=r"arm\.zarr"):
        reach_map(ur5e, **GIVEN, store=path)
    assert files(tmp_path) == before


def test_a_pickle_in_a_store_is_never_loaded(ur5e, tmp_path, monkeypatch):
    """Zarr's format 2 may hold pickles, which are code: no such store is read, nor gone on with."""
    monkeypatch.setattr("numcodecs.pickles.ALLOW_UNSAFE_PICKLE_DECODE", True, raising=False)
    path = tmp_path / "arm.zarr"
    (path / "share").mkdir(parents=True)
    array = {"shape": [1] * 3, "chunks": [1] * 3, "dtype": "|O", "fill_value": "", "order": "C"}
    array |= {"compressor": None, "filters": [{"id": "vlen-utf8"}, {"id": "pickle"}]}
    (path / ".zgroup").write_text('{"zarr_format": 2}')
    (path / ".zattrs").write_text('{"dh2urdf_map": {}, "chain": "", "complete": 1}')
    (path / "share" / ".zarray").write_text(json.dumps(array | {"zarr_format": 2}))
    (path / "share" / ".zattrs").write_text('{"_ARRAY_DIMENSIONS": ["x", "y", "z"]}')
    chunk = pickle.dumps(Touches(tmp_path / "touched"))
    (path / "share" / "0.0.0").write_bytes(chunk)
    with pytest.raises(ArgumentError, match=r"arm.zarr: no map that can be read"):
        open_map(path).share.load()
    with pytest.raises(OutputExistsError, match=r"arm\.zarr: is there and no map"):
        reach_map(ur5e, **GIVEN, store=path)
    assert not (tmp_path / "touched").exists()
    pickle.loads(chunk)
    assert (tmp_path / "touched").exists()


@pytest.mark.parametrize("name", ["zarr.json", "share/zarr.json", "progress/done/zarr.json"])
@pytest.mark.parametrize(
    "content", [b"", b"\xff", b"[]", b'{"zarr_format": 3}', b'{"a": [{"b": 1}]}']
)
def test_a_damaged_file_of_a_store_is_one_message(ur5e, small, tmp_path, name, content):
    """Whatever stands in a file of metadata, a map is opened or gone on with, or refused."""
    shutil.copytree(small, tmp_path / "arm.zarr")
    (tmp_path / "arm.zarr" / name).write_bytes(content)
    for call in (open_map, lambda path: reach_map(ur5e, **SMALL, store=path)):
        found = outcome(call, tmp_path / "arm.zarr")
        assert isinstance(found, xarray.Dataset) or "arm.zarr: " in str(found)


def test_a_block_whose_mark_cannot_be_read_is_one_message(ur5e, small, tmp_path):
    """Chunks of the marks that are larger than any array are found while blocks are worked out."""
    shutil.copytree(small, tmp_path / "arm.zarr")
    place = tmp_path / "arm.zarr" / "progress" / "done" / "zarr.json"
    told = json.loads(place.read_text())
    told["chunk_grid"]["configuration"]["chunk_shape"][2] = 10**30
    place.write_text(json.dumps(told))
    with pytest.raises(OutputError, match=r"arm\.zarr: is damaged .* remove it, or give another"):
        reach_map(ur5e, **SMALL, store=tmp_path / "arm.zarr")


@pytest.mark.parametrize("name", ["progress/done", "share"])
def test_an_array_of_another_shape_is_one_message(ur5e, small, tmp_path, name):
    """Marks of no block at all, or fewer voxels than the grid has, are told before any work."""
    shutil.copytree(small, tmp_path / "arm.zarr")
    place = tmp_path / "arm.zarr" / name / "zarr.json"
    told = json.loads(place.read_text())
    told["shape"][2] = 0
    place.write_text(json.dumps(told))
    with pytest.raises(OutputError, match=rf"arm\.zarr: is damaged \({name} has the shape .*, 0\)"):
        reach_map(ur5e, **SMALL, store=tmp_path / "arm.zarr")


class Touches(NamedTuple):
    """What makes a file where it is unpickled."""

    path: Path

    def __reduce__(self):
        return Path.touch, (self.path,)


def test_a_disk_that_is_full_is_one_error_and_the_map_goes_on(ur5e, whole, tmp_path, monkeypatch):
    """Blocks before it are kept; once there is room the same call ends in the same bits."""
    path, written, once = tmp_path / "arm.zarr", [], store.write

    def full(*given):
        with store.writing(given[0]):
            if len(written) == 4:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        written.append(given)
        once(*given)

    monkeypatch.setattr(store, "write", full)
    with pytest.raises(OutputError, match=r"arm.zarr: No space left on device; blocks .* kept"):
        reach_map(ur5e, **GIVEN, store=path)
    monkeypatch.undo()
    assert 4 <= store.done(str(path)).sum() <= 5
    xarray.testing.assert_identical(reach_map(ur5e, **GIVEN, store=path).load(), whole)


def test_files_that_may_not_grow_are_one_error(ur5e, tmp_path):
    """A limit of the system on file sizes, met within Zarr, is told by path and reason."""
    code = (
        "import resource, signal, dh2urdf\nfrom dh2urdf.workspace import reach_map\n"
        "robot = dh2urdf.Robot.from_dh('ur5e')\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))\n"
        f"try:\n    reach_map(robot, **{GIVEN!r}, store='arm.zarr')\n"
        "except dh2urdf.exceptions.OutputError as error:\n    print(error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(Path(dh2urdf.__file__).parents[1])},
    )  # fmt: skip
    assert "arm.zarr: File too large; this call worked out nothing" in done.stdout


def begun(robot, path, monkeypatch, **given):
    """A map of which some blocks are done, as a kill or a fault leaves it."""

    def stop(done, total):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        reach_map(robot, **given, store=path, progress=stop)


def test_a_map_that_is_not_finished_says_so(ur5e, whole, tmp_path, monkeypatch, run):
    """Its attribute is 0, what is not worked out is NaN, and who draws or sums it up refuses."""
    path = tmp_path / "arm.zarr"
    begun(ur5e, path, monkeypatch, **GIVEN)
    part, marks = xarray.open_zarr(path), store.done(str(path))
    assert 3 <= marks.sum() < marks.size
    assert part.attrs["complete"] == 0
    lasting = marks.repeat(4, 0).repeat(4, 1).repeat(4, 2)
    for name in ("share", "solutions_mean", "solutions_max"):
        np.testing.assert_array_equal(np.isfinite(part[name].values), lasting)
    for use in (open_map, map_summary):
        with pytest.raises(ArgumentError, match=r"is not finished, \d+% of its voxels"):
            use(part)
    code, out, err = run("workspace", "arm.zarr", "-o", "arm.png")
    assert (code, out) == (2, "")
    assert "arm.zarr: is not finished" in err
    assert not (tmp_path / "arm.png").exists()
    reach_map(ur5e, **GIVEN, store=path)
    xarray.testing.assert_identical(open_map(path).load(), whole)
    assert whole.attrs["complete"] == 1


@pytest.mark.parametrize("name", ["share", "solutions_max", "limit_margin", "singular_value_each"])
def test_a_chunk_that_is_gone_is_worked_out_again(ur5e, tmp_path, monkeypatch, name):
    """A block whose mark is there and a file is not is noticed, and it alone is done again."""
    given = GIVEN | {"each": name.endswith("each")}
    path = tmp_path / "arm.zarr"
    reach_map(ur5e, **given, store=path)
    before = files(path)
    (path / name / "c/1/1/1" / ("0" if given["each"] else "")).unlink()
    worked, once = [], job.block_values
    monkeypatch.setattr(job, "block_values", lambda *a: worked.append(a[2]) or once(*a))
    reach_map(ur5e, **given, store=path)
    assert [tuple(map(int, block)) for block in worked] == [(1, 1, 1)]
    assert files(path) == before


def test_a_damaged_chunk_of_each_orientation_is_mended(ur5e, tmp_path):
    """What cannot be decoded is worked out again, too."""
    given = GIVEN | {"region": ((0.2, 0.6), (0.0, 0.4), (0.0, 0.4)), "each": True}
    path = tmp_path / "arm.zarr"
    reach_map(ur5e, **given, store=path)
    before = files(path)
    os.truncate(path / "limit_margin_each/c/0/0/0/0", 12)
    reach_map(ur5e, **given, store=path)
    assert files(path) == before


@pytest.mark.parametrize("fault", ["truncated", "gone", "no array"])
def test_a_damaged_map_is_not_drawn_and_is_mended(ur5e, tmp_path, run, fault):
    """One message instead of a picture; the call that wrote it ends in the bits of before."""
    path = tmp_path / "arm.zarr"
    reach_map(ur5e, **GIVEN, store=path)
    before = files(path)
    if fault == "no array":
        shutil.rmtree(path / "share")
    for chunk in (path / "share").rglob("c/*/*/*"):
        os.truncate(chunk, 12) if fault == "truncated" else chunk.unlink()
    code, out, err = run("workspace", "arm.zarr", "-o", "arm.png")
    assert (code, out, err.count("\n")) == (2, "", 1)
    words = {"truncated": "cannot be read", "gone": "lacks 64 of 64", "no array": "holds no map"}
    assert words[fault] in err
    if fault == "truncated":
        with pytest.raises(ArgumentError, match="shares cannot be read"):
            map_summary(xarray.open_zarr(path))
    reach_map(ur5e, **GIVEN, store=path)
    assert files(path) == before


@pytest.mark.parametrize("change", [
    {"settings": None}, {"settings": "none"}, {"block": 0}, {"block": "4"}, {"refine": "1"},
    {"refine": -(10**12)}, {"step": "wide"}, {"orientations": [30]},
])  # fmt: skip
def test_settings_that_are_none_are_told_by_one_error(whole, change):
    """A map whose attribute holds anything else is not summed up."""
    attrs = dict(whole.attrs)
    attrs["dh2urdf_map"] = change.get("settings", attrs["dh2urdf_map"] | change)
    with pytest.raises(ArgumentError, match="its settings or shares cannot be read"):
        map_summary(whole.assign_attrs(attrs))


@pytest.mark.parametrize("fault", ["other axes", "missing", "words"])
def test_what_a_map_has_not_of_its_voxels_is_not_drawn(whole, fault):
    """A measure that lies on other axes, or is gone, and centres that are no numbers."""
    other = whole.solutions_mean.rename(x="block_x", y="block_y", z="block_z")
    changed = {
        "other axes": lambda: whole.assign(solutions_mean=other.drop_vars(other.coords)),
        "missing": lambda: whole.drop_vars("solutions_mean"),
        "words": lambda: whole.assign_coords(x=[f"{x} m" for x in whole.x.values]),
    }
    words = "map's x cannot be read" if fault == "words" else "has no solutions_mean of its voxels"
    with pytest.raises(ArgumentError, match=words):
        map_cut(changed[fault](), "solutions_mean")


def test_urls_go_to_fsspec(ur5e, whole, tmp_path, run):
    """A map in fsspec's memory, and by file:// where it says; no folder is named like a URL."""
    kept = reach_map(ur5e, **GIVEN, store="memory://maps/arm.zarr")
    xarray.testing.assert_identical(kept.load(), whole)
    xarray.testing.assert_identical(open_map("memory://maps/arm.zarr").load(), whole)
    reach_map(ur5e, **GIVEN, store=f"file://{tmp_path}/arm%20a.zarr")
    xarray.testing.assert_identical(open_map(tmp_path / "arm a.zarr").load(), whole)
    kept = run("map", "ur5e", "-o", "nothing://bucket/arm.zarr", "--step", "0.4")
    assert kept == (2, "", "dh2urdf: nothing://bucket/arm.zarr: Protocol not known: nothing\n")
    assert [p.name for p in tmp_path.iterdir()] == ["arm a.zarr"]


def test_a_protocol_whose_package_is_missing_is_one_error(tmp_path, monkeypatch, run):
    """The package that fsspec asks for is named, and nothing is written."""
    monkeypatch.setitem(sys.modules, "s3fs", None)
    code, out, err = run("map", "ur5e", "-o", "s3://bucket/arm.zarr", "--step", "0.4")
    assert (code, out) == (2, "")
    assert err == "dh2urdf: s3://bucket/arm.zarr: Install s3fs to access S3\n"
    assert list(tmp_path.iterdir()) == []


def test_a_map_is_not_written_to_standard_output(tmp_path, run):
    """A map is a folder: -o - is refused, and no folder of that name is made."""
    code, out, err = run("map", "ur5e", "-o", "-", "--step", "0.4")
    assert (code, out) == (2, "")
    assert "a map is a folder" in err
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_takes_nothing_is_told_so(ur5e):
    """Where the store cannot even be begun, nothing is said of blocks that are kept."""
    with pytest.raises(OutputError, match=r"/proc/arm.zarr: .*; this call worked out nothing$"):
        reach_map(ur5e, **GIVEN, store="/proc/arm.zarr")


def test_voxels_are_halved_where_shares_change(ur5e, tmp_path):
    """Halves hold what the finer grid's voxels hold, wholes their own value in all eight parts."""
    given = {"step": 0.2, "orientations": 30, "region": ((-1.6, 1.6), (0.0, 1.2), (0.0, 1.2))}
    coarse, fine = reach_map(ur5e, **given), reach_map(ur5e, **given | {"step": 0.1})
    mixed = reach_map(ur5e, **given, refine=1)
    halved = mixed.level.values == 1
    assert 0.1 < halved.mean() < 0.9
    spread = coarse.share.values.repeat(2, 0).repeat(2, 1).repeat(2, 2)
    np.testing.assert_array_equal(mixed.x, fine.x)
    for name in ("share", "solutions_max", "limit_margin"):
        finer, wholes = fine[name].values, coarse[name].values.repeat(2, 0).repeat(2, 1)
        expected = np.where(halved, finer, wholes.repeat(2, 2))
        np.testing.assert_array_equal(mixed[name].values, expected)
    wide = np.pad(coarse.share.values, 1, mode="edge")
    far = np.max([abs(np.roll(wide, s, axis=a) - wide) for a in range(3) for s in (1, -1)], axis=0)
    assert halved[(far[1:-1, 1:-1, 1:-1] > 0.1).repeat(2, 0).repeat(2, 1).repeat(2, 2)].all()
    assert spread.shape == halved.shape
    kept = reach_map(ur5e, **given, refine=1, store=tmp_path / "arm.zarr")
    xarray.testing.assert_identical(kept.load(), mixed)
    twice = reach_map(ur5e, **given, refine=2)
    assert set(np.unique(twice.level)) == {0, 1, 2}
    assert twice.share.shape == (64, 24, 24)
