"""Drawn bodies look like an arm: whole, connected, in proportion at every size."""

import math

import numpy as np
import pytest
from strategies import scaled

import dh2urdf
from dh2urdf.conversions.write.bodies import draw_bodies, link_frames
from dh2urdf.conversions.write.table_chain import dh_to_chain


def bodies_of(table):
    """Bodies of each link, base first."""
    return draw_bodies(table, dh_to_chain(table))


def extent(body):
    """Half sizes of the body's box in its own frame."""
    if body.shape == "sphere":
        return np.full(3, body.size[0])
    if body.shape == "cylinder":
        return np.array([body.size[0], body.size[0], body.size[1] / 2])
    return np.array(body.size) / 2


def distance(body, point):
    """Distance from a point of the link frame to the body's bounding box; 0 inside."""
    local = body.pose[:3, :3].T @ (point - body.pose[:3, 3])
    return float(np.linalg.norm(np.maximum(np.abs(local) - extent(body), 0.0)))


@pytest.mark.parametrize("name", dh2urdf.list_tables())
def test_links_are_whole_and_connected(name):
    """No size is zero, and each link's bodies reach the joint before and the joint after it."""
    table = dh2urdf.load_table(name)
    bodies, frames = bodies_of(table), link_frames(table)
    assert all(min(b.size) > 0 for link in bodies for b in link)
    for i, link in enumerate(bodies):
        last = i == table.n
        ends = frames.tool if last else frames.origins[i]
        d = 0.0 if last else table.joints[i].d
        after = (ends @ np.array([0.0, 0.0, -d, 1.0]))[:3]
        reach = max(extent(b).min() for b in link)
        assert i == 0 or min(distance(b, after) for b in link) <= reach
        if i:
            slides = table.joints[i - 1].joint_type == "prismatic"
            start = np.array([0.0, 0.0, 0.0 if slides else -table.joints[i - 1].d])
            assert min(distance(b, start) for b in link) <= reach


@pytest.mark.parametrize("name", ["ur5", "denso_vs6556", "gantry_wrist", "rpr_by_inspection"])
@pytest.mark.parametrize("factor", [0.02, 30.0])
def test_toy_and_crane_look_alike(name, factor):
    """A table scaled by a factor is drawn by the same bodies, scaled by it."""
    table = dh2urdf.load_table(name)
    for link, other in zip(bodies_of(table), bodies_of(scaled(table, factor)), strict=True):
        assert [b.shape for b in link] == [b.shape for b in other]
        for a, b in zip(link, other, strict=True):
            np.testing.assert_allclose(np.array(b.size), factor * np.array(a.size), rtol=1e-9)
            np.testing.assert_allclose(b.pose[:3, 3], factor * a.pose[:3, 3], atol=1e-9 * factor)


def test_arm_on_a_long_track_stays_an_arm():
    """Five metres of travel before a UR5 make its links at most twice as thick."""
    ur5 = dh2urdf.load_table("ur5")
    slide = dh2urdf.DHRow(joint_type="prismatic", alpha=-math.pi / 2, lower=0.0, upper=5.0)
    track = dh2urdf.DHTable((slide, *ur5.rows), ur5.convention)
    rods = [
        [max(b.size[0] for b in link if b.shape == "sphere") for link in bodies[-6:]]
        for bodies in (bodies_of(ur5), bodies_of(track))
    ]
    assert all(thick <= 2.0 * plain for plain, thick in zip(*rods, strict=True))


@pytest.mark.parametrize("name", ["ur5", "kinova_gen3", "puma560", "planar_rr", "xarm7"])
def test_first_drum_stands_on_the_base(name):
    """The first drum ends where the base's disc begins, to rounding error."""
    table = dh2urdf.load_table(name)
    base, first = bodies_of(table)[:2]
    drum = next(b for b in first if b.material == "joint")
    T_base_drum = link_frames(table).origins[0] @ drum.pose
    disc = next(b for b in base if b.material == "base")
    between = float(np.linalg.norm(T_base_drum[:3, 3] - disc.pose[:3, 3]))
    assert between == pytest.approx((drum.size[1] + disc.size[1]) / 2, rel=1e-9)


@pytest.mark.parametrize("turn", [0.0, math.pi])
def test_the_foot_of_a_flat_arm_is_under_it_whichever_way_its_axis_points(turn):
    """The disc is below the joint where axis 1 points up, and where it points down."""
    rows = tuple(dh2urdf.DHRow(0, 0, 0.3, 0) for _ in range(2))
    base = dh2urdf.Origin((0, 0, 0), (turn, 0, 0))
    table = dh2urdf.DHTable(rows, "standard", base=base)
    foot = bodies_of(table)[0][0]
    assert foot.material == "base"
    assert foot.pose[2, 3] < link_frames(table).origins[0][2, 3]
