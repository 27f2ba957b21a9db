"""The envelope: a closed surface around all that is reached, but for the quarter cut out."""

import math

import numpy as np
import pytest
from strategies import FACTORY

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError
from dh2urdf.figures import workspace_figure
from dh2urdf.workspace import envelope, mapped_robot, reach_ball

TOWARDS = -1.0
"""Azimuth of the open quarter [rad]."""


@pytest.fixture(scope="module", params=["ur5e", "puma560", "cylindrical", "factory"])
def arm(request):
    """A robot and its envelope."""
    robot = Robot.from_dh(FACTORY if request.param == "factory" else request.param)
    robot = mapped_robot(robot).robot
    return robot, envelope(robot, TOWARDS)


def polar(points, robot):
    """Azimuth from the open quarter, in (-pi, pi], distance from axis 1 and height."""
    off = points - reach_ball(robot)[0]
    phi = np.remainder(np.arctan2(off[:, 1], off[:, 0]) - TOWARDS + math.pi, 2 * math.pi) - math.pi
    return phi, np.hypot(off[:, 0], off[:, 1]), points[:, 2]


def test_the_surface_is_closed(arm):
    """Every edge belongs to an even number of quadrilaterals."""
    _, found = arm
    edges = np.sort(np.stack([found.quads, np.roll(found.quads, -1, axis=1)], axis=-1), axis=-1)
    _, count = np.unique(edges.reshape(-1, 2), axis=0, return_counts=True)
    assert (count % 2 == 0).all()
    assert found.is_cut.any()


def test_the_quarter_is_open_and_the_cut_is_flat(arm):
    """No corner is in the open quarter; those of the cut are on its two half planes."""
    robot, found = arm
    phi, r, _ = polar(found.corners, robot)
    clear = r > 0.02 * robot.chain.size
    assert np.abs(phi[clear]).min() >= math.pi / 4 - 1e-6
    cut = np.unique(found.quads[found.is_cut])
    on_cut = np.abs(phi[cut])[clear[cut]]
    np.testing.assert_allclose(on_cut, math.pi / 4, atol=1e-6)


def test_nothing_is_reached_outside_and_the_surface_is_reached(arm):
    """Random places lie within it in radius and height, and come as far as it does."""
    robot, found = arm
    rng = np.random.default_rng(5)
    low, high = robot.bounded(1.0, np.pi)
    _, r, z = polar(robot.fk(rng.uniform(low, high, (200_000, robot.n)))[:, :3, 3], robot)
    _, edge_r, edge_z = polar(found.corners, robot)
    size = robot.chain.size
    assert r.max() <= edge_r.max() + 0.01 * size
    assert edge_z.min() - 0.01 * size <= z.min()
    assert z.max() <= edge_z.max() + 0.01 * size
    assert edge_r.max() <= r.max() + 0.05 * size
    assert edge_z.max() <= z.max() + 0.1 * size


def test_the_cylindrical_arm_fills_a_hollow_cylinder():
    """Its radii and heights are the travels of its two slides."""
    robot = Robot.from_dh("cylindrical")
    corners = envelope(robot, TOWARDS).corners
    ends = np.array([robot.fk(q)[:3, 3] for q in (robot.lower, robot.upper)])
    _, r, z = polar(corners, robot)
    tall = np.ptp(ends[:, 2])
    assert [z.min(), z.max()] == pytest.approx(sorted(ends[:, 2]), abs=0.01 * tall)
    radii = np.hypot(*(ends[:, :2] - reach_ball(robot)[0][:2]).T)
    assert [r.min(), r.max()] == pytest.approx(sorted(radii), abs=0.01)


def test_the_picture_has_its_sentence_and_stays_on_the_sheet():
    """The sentence gives radius and heights; all that is drawn is on the sheet."""
    picture = workspace_figure(Robot.from_dh("omron_cobra600"), envelope=True)
    (axes,) = picture.axes
    texts = " ".join(text.get_text() for text in axes.texts)
    assert "Envelope, radius 0.6 m, z from 0.17" in texts
    assert "self-collision not checked" in texts
    drawn = [p.get_xy() for p in axes.patches if hasattr(p, "get_xy")]
    drawn += [path.vertices for path in axes.collections[0].get_paths()]
    corners, sheet = np.concatenate(drawn), 72.0 * picture.get_size_inches()
    assert (corners >= 0.0).all()
    assert (corners <= sheet).all()


def test_a_planar_arm_has_no_envelope():
    """It is said, and so is every option that says nothing beside it."""
    with pytest.raises(ArgumentError, match="moves in a plane"):
        workspace_figure(Robot.from_dh("planar_rrr"), envelope=True)
    for option in ({"plane": "xz"}, {"points": 9}, {"rpy": [0, 0, 0]}, {"at": 0.0}):
        with pytest.raises(ArgumentError, match=next(iter(option))):
            workspace_figure(Robot.from_dh("ur5e"), envelope=True, **option)
