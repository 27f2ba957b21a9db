"""Parallelograms are drawn beside the links that they move, and close at every configuration."""

import numpy as np
import pytest
from coupled_arms import COUPLED, driven_palletiser, painter, palletiser

from dh2urdf import Robot, load_table
from dh2urdf.conversions.assign import to_convention
from dh2urdf.drawing.arm import drawn_arm
from dh2urdf.figures import figure

PARALLELOGRAMS = {"palletiser": 2, "palletiser driven": 3, "painter": 0, "pendant": 1}


def bars_at(table, q):
    """Where bars begin and end, (bars, 2, 3), cranks and rods apart."""
    arm, joints = drawn_arm(table), Robot.from_dh(table).chain_configuration(q)
    ends = np.array(arm.bar_ends(joints)).reshape(-1, 2, 3)
    crank = np.array([bar.turn == bar.keep for bar in arm.bars], bool)
    return ends[crank], ends[~crank]


def configurations(table):
    """Some within the limits."""
    robot = Robot.from_dh(table)
    return [robot.random_configuration(seed) for seed in range(20)]


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("name", COUPLED)
def test_rods_are_as_many_as_links_that_a_value_passes(name, convention):
    """A rod beside the upper arm and the forearm keeps the tool level, one more drives J3."""
    table = to_convention(COUPLED[name](), convention)
    assert len(bars_at(table, configurations(table)[0])[1]) == PARALLELOGRAMS[name]


@pytest.mark.parametrize("name", ["palletiser", "palletiser driven", "pendant"])
def test_every_rod_ends_where_the_next_crank_does(name):
    """Along the axis aside, on whose other side of the crank the rod lies."""
    table = COUPLED[name]()
    for q in configurations(table):
        cranks, rods = bars_at(table, q)
        joints = Robot.from_dh(table).chain_configuration(q)
        z = table.frames(joints)[1][:3, 2]
        tips = cranks[:, 1] - np.outer(cranks[:, 1] @ z, z)
        for rod in rods:
            flat = rod - np.outer(rod @ z, z)
            gaps = [np.linalg.norm(tips - end, axis=1).min() for end in flat]
            assert max(gaps) < 1e-12


@pytest.mark.parametrize("table", [palletiser(), driven_palletiser()])
def test_cranks_of_the_tool_keep_their_direction(table):
    """They only turn with joint 1, as the tool does but for its own joint."""
    robot = Robot.from_dh(table)
    first = np.zeros(robot.n)
    for q in configurations(table):
        q[0] = 0.0
        one, other = (bars_at(table, v)[0][:3] for v in (first, q))
        assert np.abs(np.diff(one - other, axis=1)).max() < 1e-12


def test_the_crank_of_the_forearm_turns_with_the_third_value_alone():
    """As its motor does: J2 leaves it where it is."""
    table = driven_palletiser()
    start = bars_at(table, [0.0, 0.3, 0.2, 0.0])[0]
    moved = bars_at(table, [0.0, 0.9, 0.2, 0.0])[0]
    turned = bars_at(table, [0.0, 0.3, 0.9, 0.0])[0]
    kept = np.abs(np.diff(start - moved, axis=1)).max(axis=(1, 2))
    assert kept.max() < 1e-12
    swung = np.abs(np.diff(start - turned, axis=1)).max(axis=(1, 2))
    assert sorted(swung > 0.01) == [False] * 3 + [True] * 2


def test_arms_without_couplings_have_no_bars():
    """Nothing is added to the bodies of an arm whose joints move on their own."""
    arm = drawn_arm(load_table("ur5"))
    assert arm.bars == []
    assert len(arm.bodies) == arm.table.n + 1
    assert drawn_arm(painter()).bars == []


@pytest.mark.parametrize("style", ["bodies", "schematic"])
def test_the_picture_of_a_palletiser_shows_q(style):
    """The note under the table has the four values, not the six joints."""
    picture = figure(Robot.from_dh(driven_palletiser()), [0.0, 0.5, 0.25, 0.1], style=style)
    (note,) = [t.get_text() for t in picture.axes[0].texts if "pose drawn" in t.get_text()]
    assert note.count("°") == 4
