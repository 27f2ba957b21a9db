"""Pictures of maps of reach: a cut, the difference of two, a surface of a level."""

import numpy as np
import pytest

from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.exceptions import ArgumentError, UnreachedError
from dh2urdf.figures import map_figure, picture_bytes
from dh2urdf.workspace import cone, map_surface, open_map, reach_map

pytest.importorskip("xarray")

REGION = [[-1.1, 1.1], [-1.1, 1.1], [-0.8, 1.2]]


@pytest.fixture(scope="module")
def maps():
    """Of two arms, on one grid."""
    return [reach_map(Robot.from_dh(name), step=0.1, orientations=30, region=REGION)
            for name in ("ur5e", "denso_vs6556")]  # fmt: skip


def test_a_cut_and_a_difference_are_the_same_each_time(maps):
    """Both arms and what one reaches more than the other, byte for byte twice."""
    one, two = (picture_bytes(map_figure(*some), "svg") for some in (maps[:1], maps))
    assert picture_bytes(map_figure(*maps), "svg") == two
    assert b"share of orientations" in one
    assert b"ur5e less denso_vs6556" in two
    assert b"denso_vs6556 alone" in two
    each = picture_bytes(map_figure(*maps, variable="limit_margin", plane="xy", at=0.3), "svg")
    assert b"difference of margin to limits" in each


def test_maps_on_different_grids_are_not_compared(maps):
    """Another step, something that is no map, a plane outside: each is refused by name."""
    other = maps[0].isel(x=slice(0, 5))
    with pytest.raises(ArgumentError, match="different grids along x"):
        map_figure(maps[0], other)
    with pytest.raises(ArgumentError, match="holds no map"):
        map_figure(maps[0].drop_vars("share"))
    with pytest.raises(ArgumentError, match="no such map"):
        map_figure("nowhere.zarr")
    with pytest.raises(ArgumentError, match="variable"):
        map_figure(maps[0], variable="colour")
    with pytest.raises(UnreachedError, match="ends before"):
        map_figure(maps[0], at=5.0)


@pytest.mark.parametrize(("change", "words"), [
    ({"orientations": 20}, "orientations: 30 and 20"),
    ({"orientations": cone(30, spins=1)}, "rotations tried"),
    ({"within_limits": False}, "joint limits: kept and ignored"),
])  # fmt: skip
def test_maps_of_other_questions_are_not_compared(maps, change, words):
    """Where two maps on one grid were asked otherwise, the message names it."""
    given = {"step": 0.1, "orientations": 30, "region": REGION, **change}
    other = reach_map(Robot.from_dh("ur5e"), **given)
    with pytest.raises(ArgumentError, match=f"the maps differ in their {words}"):
        map_figure(maps[0], other)


@pytest.mark.parametrize("settings", ["none", 3, {"orientations": [1, 2, 3], "task": [[]]}])
def test_a_map_whose_settings_are_damaged_is_compared_or_refused_in_words(maps, settings):
    """What is no setting counts as none; another shape of one is told as it is."""
    damaged = maps[0].assign_attrs(dh2urdf_map=settings)
    if isinstance(settings, dict):
        with pytest.raises(ArgumentError, match=r"the maps differ in their task"):
            map_figure(maps[0], damaged)
    else:
        assert picture_bytes(map_figure(maps[0], damaged), "svg")


def test_maps_of_one_arm_are_told_apart_by_their_files(maps, tmp_path):
    """Titles say which is less which, by names or, where those are equal, too, by paths."""
    for name in ("a.zarr", "b.zarr", "sub/a.zarr"):
        maps[0].to_zarr(tmp_path / name, consolidated=False)
    drawn = picture_bytes(map_figure(tmp_path / "a.zarr", tmp_path / "b.zarr"), "svg")
    assert b"a.zarr less b.zarr" in drawn
    drawn = picture_bytes(map_figure(tmp_path / "a.zarr", tmp_path / "sub/a.zarr"), "svg")
    assert b"sub/a.zarr" in drawn
    assert b"ur5e (1) less ur5e (2)" in picture_bytes(map_figure(maps[0], maps[0]), "svg")


def test_a_stored_map_is_drawn_as_it_was(maps, tmp_path):
    """By the path of its Zarr group; a folder that holds none is refused."""
    maps[0].to_zarr(tmp_path / "arm.zarr", consolidated=False)
    np.testing.assert_array_equal(open_map(tmp_path / "arm.zarr").share, maps[0].share)
    drawn = [picture_bytes(map_figure(m), "svg") for m in (maps[0], tmp_path / "arm.zarr")]
    assert drawn[0] == drawn[1]
    (tmp_path / "empty").mkdir()
    with pytest.raises(ArgumentError, match="no map that can be read"):
        open_map(tmp_path / "empty")


def test_workspace_draws_stored_maps(maps, run, tmp_path):
    """A map in the place of a robot, and the difference of two."""
    for found, name in zip(maps, ("a.zarr", "b.zarr"), strict=True):
        found.to_zarr(tmp_path / name, consolidated=False)
    argv = ["workspace", "a.zarr", "-o", "cut.svg", "--plane", "xy", "--at", "0.3"]
    assert run(*argv, "--variable", "limit_margin") == (0, "cut.svg\n", "")
    assert b"margin to limits" in (tmp_path / "cut.svg").read_bytes()
    assert run(*argv, "--against", "b.zarr") == (0, "cut.svg\n", "")
    assert b"ur5e less denso_vs6556" in (tmp_path / "cut.svg").read_bytes()


def test_the_surface_of_a_level_is_closed_and_holds_its_volume(maps):
    """Each edge is met once each way, outwards; the volume is that of the voxels within a shell."""
    share = maps[0].share.values
    corners, triangles = map_surface(maps[0], 0.5)
    edges = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    there, back = (np.sort(e[:, 0] * len(corners) + e[:, 1]) for e in (edges, edges[:, ::-1]))
    np.testing.assert_array_equal(there, back)
    a, b, c = corners[triangles].transpose(1, 0, 2)
    volume = np.einsum("ki,ki->k", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx((share > 0.5).sum() * 0.1**3, rel=0.1)
    with pytest.raises(UnreachedError, match="nowhere above"):
        map_surface(maps[0], 1.0)


def test_the_map_of_a_planar_arm_is_drawn_in_its_plane():
    """One layer of voxels has a cut, too."""
    robot = Robot.from_dh(DHTable(tuple(DHRow(a=a) for a in (0.5, 0.4, 0.1)), "standard", "rrr"))
    region = [[-1.1, 1.1], [-1.1, 1.1], [-0.05, 0.05]]
    found = reach_map(robot, step=0.1, orientations=12, region=region, within_limits=False)
    assert b"rrr reaches" in picture_bytes(map_figure(found, plane="xy"), "svg")


def test_a_flat_map_is_drawn_in_its_plane_unasked(tmp_path, run):
    """From the command line, with an area; the planes that cut it to a line are refused."""
    assert run("map", "planar_rr", "-o", "rr.zarr", "--step", "0.1")[0] == 0
    assert run("workspace", "rr.zarr", "-o", "rr.svg") == (0, "rr.svg\n", "")
    drawn = (tmp_path / "rr.svg").read_bytes()
    assert drawn == picture_bytes(map_figure(tmp_path / "rr.zarr", plane="xy"), "svg")
    assert b"reaches 0 m" not in drawn
    code, _, err = run("workspace", "rr.zarr", "-o", "xz.svg", "--plane", "xz")
    assert code == 2
    assert "plane: xz cuts a map of one layer to a line; it lies in xy" in err
