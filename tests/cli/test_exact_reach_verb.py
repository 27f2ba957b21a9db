"""``dh2urdf workspace --exact``: reach as numbers, and its picture."""

import json
import math

import pytest


def test_the_numbers_told_are_the_formulas(run, tmp_path):
    """The Puma's shells, without limits; the picture has its boundary and its volume."""
    status, out, err = run("workspace", "puma560", "--exact", "--no-limits", "-o", "reach.svg")
    assert (status, err) == (0, "")
    far = math.hypot(0.15005, 0.4318 + math.hypot(0.0203, 0.4318))
    assert f"to {far:.9f}".rstrip("0") in out
    assert "voids: 0, bounded by folds" in out
    assert out.splitlines()[-1] == "reach.svg"
    picture = (tmp_path / "reach.svg").read_text()
    assert "arm singular" in picture
    assert "volume 2.7024" in picture


def test_limits_are_kept_unless_told_otherwise(run):
    """With limits less is reached, and the limits that bound it are named."""
    free, kept = (
        json.loads(run("workspace", "denso_vs6556", "--exact", "--json", *more)[1])
        for more in (["--no-limits"], [])
    )
    assert kept["volume"]["value"] < free["volume"]["value"]
    assert kept["reach"]["wrist"]["distance"][0] > free["reach"]["wrist"]["distance"][0]
    kinds = {kind for ring in kept["section"]["rings"] for kind in ring["kinds"]}
    assert {"joint_2 upper", "joint_3 lower"} <= kinds
    assert kept["path"] is None


@pytest.mark.parametrize(("arm", "words"), [("franka_fer", "no wrist point"),
                                            ("gantry", "first joint that turns")])  # fmt: skip
def test_arms_without_a_section_are_told_the_reach_of_their_tip(run, arm, words):
    """The tip's extremes on stdout, on stderr why there is no section."""
    status, out, err = run("workspace", arm, "--exact")
    assert status == 0
    assert "tip: " in out
    assert words in err


@pytest.mark.parametrize("arm", ["planar_rr", "franka_fer", "gantry"])
def test_without_a_section_to_draw_nothing_is_written(run, tmp_path, arm):
    """One message says why, and what is told without a picture."""
    status, out, err = run("workspace", arm, "--exact", "-o", "reach.svg")
    assert (status, out) == (2, "")
    assert "no section to draw in reach.svg: " in err
    assert err.rstrip().endswith("without --output the reach of its tip is told")
    assert not (tmp_path / "reach.svg").exists()


def test_heights_are_told_as_above_only_where_they_are(run):
    """The KR 16's axis 1 points down, the gantry's joint 1 slides along x of the base."""
    up = run("workspace", "kuka_kr16_2", "--exact")[1]
    assert "tip: -1.218945533 to 1.508913556 m above the shoulder" in up
    along = run("workspace", "gantry", "--exact")[1]
    assert "tip: 0 to 2 m along axis 1 from the shoulder" in along
    assert "above" not in along
    assert "m from axis 1" not in along
