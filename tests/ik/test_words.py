"""The controllers' words: definitions of the makers, answers of their virtual controllers."""

import math

import numpy as np
import pytest
from dh_product import rigid
from hypothesis import given
from hypothesis import strategies as st

from dh2urdf import Robot, SerialChain
from dh2urdf.chain.ortho_parallel import OrthoParallel
from dh2urdf.exceptions import ArgumentError, NotOrthoParallelError
from dh2urdf.ik.problem.words import (
    MAKERS,
    AbbWord,
    FanucWord,
    KukaWord,
    _postures,
    controller_words,
)

H = math.pi / 2
NONE = np.full(6, math.inf)
SEEDS = st.integers(0, 2**32 - 1)


def arm(lengths, offsets, signs):
    made = OrthoParallel(*lengths, offsets=offsets, signs=signs)
    return made.chain(tuple("abcdef"), -NONE, NONE)


M20ID = arm(
    (0.075, -0.215, 0, 0, 0.84, 0.89, 0.09), (0, 0, -H, 0, 0, math.pi), (1, 1, -1, -1, -1, -1)
)
IRB = arm((0.32, -0.2, 0, 0.78, 1.125, 1.3925, 0.35), (0, 0, -H, 0, 0, 0), (1,) * 6)

# FANUC ROBOGUIDE's arm, by its positions an M-20iD/25: joint angles [deg] as it shows them,
# configuration, position [mm];
# github.com/LeroyDu56/robconv at d0efb321, tests/fixtures/probes/results/CFGPROBE_roboguide.LS.
ROBOGUIDE = """
   0   0   0    0 -90    0  N U T, 0, 0, 0     965.000    0.000   965.000
   0   0   0    0  90    0  F U T, 0, 0, 0     965.000    0.000  1145.000
   0   0   0    0 -30    0  N U T, 0, 0, 0    1042.942    0.000  1010.000
   0   0   0    0  30    0  F U T, 0, 0, 0    1042.942    0.000  1100.000
   0   0   0  185 -90    0  N U T, 0, 1, 0     965.000    7.844  1144.657
   0   0   0 -185 -90    0  N U T, 0, -1, 0    965.000   -7.844  1144.657
   0   0   0    0 -90  190  N U T, 0, 0, 1     965.000    0.000   965.000
   0   0   0    0 -90 -190  N U T, 0, 0, -1    965.000    0.000   965.000
   0   0   0    0 -90  350  N U T, 0, 0, 1     965.000    0.000   965.000
   0  40  60    0 -90    0  N D T, 0, 0, 0     951.688    0.000  1476.740
   0  40 -60    0 -90    0  N U T, 0, 0, 0    1168.195    0.000   -64.785
   0 -60 -80    0 -90    0  N D B, 0, 0, 0    -374.813    0.000  -434.773
   0 -60  80    0 -90    0  N U B, 0, 0, 0    -621.015    0.000  1318.185
   0  60  80    0 -90    0  N D T, 0, 0, 0     833.907    0.000  1318.185
  90   0   0    0 -90    0  N U T, 0, 0, 0       0.000  965.000   965.000
-150   0   0    0 -90    0  N U T, 0, 0, 0    -835.714 -482.500   965.000
"""

# ABB RobotStudio's CalcRobT for an arm with the lengths of IRB here: the same repository,
# cfgprobe_robotstudio.txt at 57aa3650 and elbowprobe_robotstudio.txt at b3ad552c.
ROBOTSTUDIO = """
   0   0     0    0 -90    0  [0,0,0,1]   1712.500     0.000  2455.000
   0   0     0    0  90    0  [0,0,0,0]   1712.500     0.000  1755.000
   0   0     0    0 -30    0  [0,0,0,1]   2015.609     0.000  2280.000
   0   0     0    0  30    0  [0,0,0,0]   2015.609     0.000  1930.000
   0   0     0  185 -90    0  [0,2,0,1]   1712.500    30.505  1756.332
   0   0     0 -185 -90    0  [0,-3,0,1]  1712.500   -30.505  1756.332
   0   0     0    0 -90  190  [0,0,2,1]   1712.500     0.000  2455.000
   0   0     0    0 -90 -190  [0,0,-3,1]  1712.500     0.000  2455.000
   0   0     0    0 -90  350  [0,0,3,1]   1712.500     0.000  2455.000
   0  40    60    0 -90    0  [0,0,0,1]   1342.975     0.000   174.949
   0  40   -60    0 -90    0  [0,0,0,1]   2163.547     0.000  2634.894
   0 -60   -80    0 -90    0  [0,0,0,5]  -2074.529     0.000  1816.257
   0 -60    80    0 -90    0  [0,0,0,1]    842.354     0.000  1383.068
   0  60    80    0 -90    0  [0,0,0,1]    581.095     0.000    26.094
  90   0     0    0 -90    0  [1,0,0,1]      0.000  1712.500  2455.000
-150   0     0    0 -90    0  [-2,0,0,1] -1483.068  -856.250  2455.000
   0   0   -60    0  90    0  [0,0,0,0]   1146.154     0.000  3035.940
   0   0 -81.5    0  90    0  [0,0,0,0]    674.177     0.000  3260.033
   0   0 -82.2    0  90    0  [0,0,0,2]    657.596     0.000  3264.259
   0   0  -120    0  90    0  [0,0,0,6]   -246.346     0.000  3185.940
   0  40  -100    0  90    0  [0,0,0,2]   1869.290     0.000  2772.740
   0 -60  -100    0  90    0  [0,0,0,6]  -1911.498     0.000  1959.717
"""


def lines(text):
    out = []
    for line in text.strip().splitlines():
        cells = line.split()
        word, place = " ".join(cells[6:-3]), np.array(cells[-3:], float)
        angles = np.array(cells[:6], float)
        out.append(pytest.param(np.radians(angles), word, place, id=" ".join(cells[:6])))
    return out


@pytest.mark.parametrize(("angles", "word", "place"), lines(ROBOGUIDE))
def test_fanuc_words_are_those_of_roboguide(angles, word, place):
    """N U T and turns, at the place that the virtual controller shows, too."""
    q = angles.copy()
    q[2] += q[1]  # J3 is shown from the level
    assert np.abs(M20ID.fk(q)[:3, 3] * 1000 - place).max() < 2e-3
    assert str(controller_words(M20ID, q[None], "fanuc")[0]) == word


@pytest.mark.parametrize(("angles", "word", "place"), lines(ROBOTSTUDIO))
def test_abb_words_are_those_of_robotstudio(angles, word, place):
    """cf1, cf4, cf6 and cfx on both sides of its three singularities."""
    assert np.abs(IRB.fk(angles)[:3, 3] * 1000 - place).max() < 2e-3
    assert str(controller_words(IRB, angles[None], "abb")[0]) == word


def kuka(name, *degrees):
    return controller_words(Robot.from_dh(name).chain, np.radians([degrees]), "kuka")[0]


def test_turn_has_the_signs_of_the_axes():
    """A1 91, A2 -45, A3 37, A4 1, A5 -1, A6 0 is binary 010010 (KUKA forum, of the manual)."""
    assert kuka("kuka_kr6_r700", 91, -45, 37, 1, -1, 0).turn == 0b010010
    assert kuka("kuka_kr16_2", 0, 0, 0, 0, 0, 0).turn == 0
    assert kuka("kuka_kr16_2", -1, -1, -1, -1, -1, -1).turn == 0b111111


@given(SEEDS)
def test_status_is_as_the_manuals_define_it(seed):
    """Basic and overhead area, axis 3 beyond the stretched arm, sign of axis 5.

    A KR 3 with a1 = 100, a2 = 265 and a3 = 270 mm, whose axes 3 and 4 meet: bit 0 by the formula of
    the KUKA forum, ``100 + 265 cos A2 + 270 cos(A2 + A3) < 0``, bit 1 by A3 >= 0, bit 2 by A5 < 0.
    """
    kr3 = arm((0.1, 0, 0, 0.35, 0.265, 0.27, 0.075), (0, -H, 0, 0, 0, 0), (-1, 1, 1, -1, 1, -1))
    A = np.random.default_rng(seed).uniform(-3, 3, 6)
    behind = 100 + 265 * math.cos(A[1]) + 270 * math.cos(A[1] + A[2]) < 0
    status = behind + 2 * (A[2] >= 0) + 4 * (A[4] < 0)
    assert controller_words(kr3, A[None], "kuka")[0].status == status


@pytest.mark.parametrize(
    ("status", "turn"),
    [(6, 50), (6, 27), (6, 26), (2, 2), (2, 35), (2, 10), (2, 42), (22 - 16, 18), (22 - 16, 27)],
)
def test_words_of_taught_points_exist(status, turn):
    """S and T of points of public programs, less 16 for an absolutely accurate arm, exist."""
    rng = np.random.default_rng(0)
    q = np.radians(
        rng.uniform([-170, -130, -100, -185, -120, -350], [170, 40, 150, 185, 120, 350], (4000, 6))
    )
    found = controller_words(Robot.from_dh("kuka_kr6_r700").chain, q, "kuka")
    assert KukaWord(status, turn) in found
    assert KukaWord(status ^ 4, turn) not in found, "bit 2 of S and bit 4 of T say the same"


def test_solutions_have_words_that_tell_them_apart():
    """Eight solutions of a pose, eight words, the names of branches beside them."""
    for name, maker in (
        ("kuka_kr6_r700", "kuka"),
        ("abb_irb140", "abb"),
        ("fanuc_lrmate200id", "fanuc"),
    ):
        robot = Robot.from_dh(name)
        found = robot.ik(robot.fk(np.radians([10, -60, 80, 20, 50, 30])), within_limits=False)
        words = found.words(maker)
        assert len(set(words)) == len(found) == 8
        assert found.select(np.array([2, 0])).words(maker) == (words[2], words[0])
    assert robot.ik(rigid([9, 9, 9], [0, 0, 0])).words("abb") == ()


@pytest.mark.parametrize("maker", ["kuka", "abb", "fanuc"])
@given(SEEDS)
def test_words_do_not_depend_on_zeros_directions_and_ends_of_the_model(maker, seed):
    """Joints 2 to 5 with other zeros and directions, another tip: one posture, one word."""
    rng = np.random.default_rng(seed)
    own = Robot.from_dh("abb_irb140").chain
    signs, shift = rng.choice([-1, 1], 6), rng.uniform(-0.7, 0.7, 6)
    signs[[0, 5]], shift[[0, 5]] = 1, 0
    shift[3], signs[4] = 0, 1
    links = own.links.copy()
    flip = np.diag([1.0, -1, -1, 1])
    for i, (sign, angle) in enumerate(zip(signs, shift, strict=True)):
        links[i] = links[i] @ rigid([0, 0, 0], [0, 0, angle])
        if sign < 0:
            links[i], links[i + 1] = links[i] @ flip, flip @ links[i + 1]
    links[6] = links[6] @ rigid(rng.uniform(-0.2, 0.2, 3), [0, 0, rng.uniform(-1, 1)])
    other = SerialChain(links, own.joint_types, own.names, own.lower, own.upper)
    q = rng.uniform(-3, 3, (5, 6))
    turned = signs * (q - shift)
    axes = (other.fk(turned[0])[:3, 2], own.fk(q[0])[:3, 2])
    np.testing.assert_allclose(*axes, atol=1e-12)
    assert controller_words(other, turned, maker) == controller_words(own, q, maker)


@pytest.mark.parametrize(
    ("name", "maker"),
    [
        *((f"kuka_{name}", "kuka") for name in ("kr5_arc", "kr6_r700", "kr16_2")),
        *((f"abb_{name}", "abb") for name in ("irb120", "irb140", "irb140_modified")),
        ("fanuc_lrmate200id", "fanuc"),
    ],
)
def test_shipped_tables_of_a_maker_have_the_angles_of_its_controller(name, maker):
    """q is what the display shows, turns and all, but for FANUC's J3."""
    arm = OrthoParallel.of_chain(Robot.from_dh(name).chain)
    q = np.random.default_rng(0).uniform(-9, 9, (5, 6))
    np.testing.assert_allclose(_postures(arm, q, MAKERS[maker]).angles, q, atol=1e-14)


def test_rounding_at_zero_does_not_turn_a_word():
    """1e-12 below zero is zero, as quadrant, turn and sign."""
    chain = Robot.from_dh("abb_irb120").chain
    q = np.radians([[0, 0, 0, 0, 0, 0]]) - 1e-12
    assert controller_words(chain, q, "abb")[0] == AbbWord(0, 0, 0, 0)
    assert controller_words(Robot.from_dh("kuka_kr16_2").chain, q, "kuka")[0] == KukaWord(2, 0)
    quarter = np.radians([[90, 0, 0, -90, 30, 180]]) - 1e-12
    assert controller_words(chain, quarter, "abb")[0] == AbbWord(1, -1, 2, 0)
    turns = np.radians([[180, 0, 0, -180, -30, 539]])
    lrmate = Robot.from_dh("fanuc_lrmate200id").chain
    assert controller_words(lrmate, turns, "fanuc")[0] == FanucWord("N", "U", "T", 1, -1, 1)


def test_an_arm_of_another_shape_has_no_words():
    """A UR: one message with what fails; and of makers there are three."""
    robot = Robot.from_dh("ur5e")
    found = robot.ik(robot.fk(np.full(6, 0.5)))
    with pytest.raises(
        NotOrthoParallelError, match="no ortho-parallel arm with a spherical wrist: ax"
    ):
        found.words("abb")
    with pytest.raises(ArgumentError, match="maker: expected 'kuka' or 'abb' or 'fanuc', got 'ur'"):
        found.words("ur")
