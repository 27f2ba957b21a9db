"""A joint held where singularities nearly meet: closed forms leave solutions out, or families."""

from dataclasses import replace

import numpy as np
import pytest
from dh_arm import arm_of
from ik_referee import forward
from structured import rounded
from sweep import Tally, judge

import dh2urdf
from dh2urdf.ik.redundant.special_values import HeldAtAnyValue

TINY = np.array([1.77e-9, -2.7e-9, 3.09e-9, -4.4e-9, 1.62e-9, -7.5e-11, 2.72e-9])
"""What the joints [rad] are off round angles."""

SMALL = np.array([-1.88e-8, -4.52e-9, 9.51e-9, -9.12e-9, -4.77e-9, -3.51e-9, 6.61e-9])

FOLDED = np.array([2.541e-6, -2.393e-5, -8.029e-6, 1.745e-5, 1.62e-5, 3.037e-6, -1.651e-5])

NEAR = np.array([4.36e-10, -1.12e-9, 3.13e-10, -2.07e-10, 8.86e-10, 6.05e-10, -4.4e-10])

UPRIGHT = np.array(
    [
        -3.6247651546972293e-09,
        6.591323931104398e-09,
        -5.431911587194804e-09,
        1.4134871051396658e-09,
        -5.186688856184674e-10,
        -1.2371440094582908e-08,
        -5.678940429021395e-09,
    ]
)

POSES = [
    ("franka_fer", 3, (-45, 0, -30, 30, 90, 165, -75), TINY),
    ("franka_fr3", 3, (-45, 0, -30, 30, 90, 165, -75), TINY),
    ("xarm7", 3, (-45, 0, -30, 30, 90, 165, -75), TINY),
    ("franka_fer", 3, (-131.06, -180, 106.19, 165.3, 7.29, -41.93, 3.56), NEAR),
    ("franka_fr3", 3, (-131.06, -180, 106.19, 165.3, 7.29, -41.93, 3.56), NEAR),
    ("xarm7", 3, (-131.06, -180, 106.19, 165.3, 7.29, -41.93, 3.56), NEAR),
    ("kuka_iiwa14", 5, (-45, -180, -45, 45, 135, 135, -45), np.zeros(7)),
    ("kuka_iiwa14", 5, (-45, -180, -45, 45, 135, 135, -45), TINY),
    ("kuka_iiwa7", 2, (135, 135, -45, 180, 45, 90, -45), SMALL),
    ("kuka_iiwa14", 1, (-60, -60, 30, 180, 90, 90, 90), SMALL),
    ("kuka_iiwa14", 2, (-45, 180, 45, 180, -180, 135, 0), SMALL),
    ("kuka_iiwa14", 6, (90, 180, 90, -180, 90, 90, 90), SMALL),
    ("kuka_iiwa7", 4, (0, 0, 180, 180, 0, -90, 90), FOLDED),
    ("kuka_iiwa7", 6, (90, 180, 90, -180, 90, 90, 90), UPRIGHT),
    ("kinova_gen3", 3, (-180, 0, 180, 0, 90, 180, 90), SMALL),
    ("kinova_gen3", 3, (-180, 0, 180, 0, 90, 180, 90), TINY),
]


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-7])
def test_with_rounded_twists_and_an_elbow_folded_what_was_found_before_stays(size):
    """There solutions form surfaces, on which walks go astray."""
    table, tally = rounded(dh2urdf.load_table("kuka_iiwa14"), 4), Tally("surfaces")
    q = np.radians((90, 90, -90, 180, 90, -180, 90))
    q = q + size * np.random.default_rng(0).standard_normal((3, 7))

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={5: q[:, 5]})

    judge(tally, table, q, held, held=(5,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0


@pytest.mark.parametrize(("name", "joint", "degrees", "off"), POSES)
def test_a_configuration_where_singularities_nearly_meet_is_found(name, joint, degrees, off):
    """It is among the solutions, or on a family that is named and that a walk confirms."""
    table, q = dh2urdf.load_table(name), np.radians(degrees) + off
    tally = Tally(f"{name}, joint {joint} held")

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={joint: q[joint]})

    judge(tally, table, q[None], held, held=(joint,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0


@pytest.mark.xfail(strict=True, reason="one call into the kernels does not see a folded elbow")
@pytest.mark.parametrize("joint", [0, 1, 2, 4, 6])
def test_a_single_call_says_what_a_batch_says_of_a_folded_elbow(joint):
    """Also after a pose of the usual kind, which one call into the kernels answers."""
    robot = dh2urdf.Robot.from_dh("kuka_iiwa7")
    arm = arm_of(dh2urdf.load_table("kuka_iiwa7"))
    q = np.random.default_rng(2).uniform(-2, 2, (2, 7))
    q[1, 3] = np.pi
    Ts = forward(arm, q)
    values = {joint: float(q[1, joint])}
    robot.ik(Ts[0], within_limits=False, locked=values)
    one = robot.ik(Ts[1], within_limits=False, locked=values)
    batch = robot.ik_batch(Ts[1:], within_limits=False, locked=values)
    assert len(one) == batch.count[0]
    assert np.array_equal(one.q, batch.q[0, : len(one)])


@pytest.mark.parametrize(("name", "joint"), [("xarm7", 3), ("kuka_iiwa14", 5)])
def test_a_pose_in_doubt_keeps_sharp_solutions(name, joint):
    """Of random poses, some with axes nearly lined up, each solution reaches its pose to 1e-11."""
    robot = dh2urdf.Robot.from_dh(name)
    q = np.random.default_rng(0).uniform(robot.lower, robot.upper, (8000, 7))
    batch = robot.ik_batch(robot.fk(q), locked={joint: q[:, joint]})
    assert np.nanmax(batch.residual) <= 1e-11
    assert batch.count.min() > 0


def test_with_all_branches_found_a_flat_pose_is_named_and_not_searched(monkeypatch):
    """An elbow 1e-4 off straight, joint 1 held: a batch stays fast."""
    monkeypatch.setattr(HeldAtAnyValue, "_look_wider", None)  # a call of it would fail
    robot, table = dh2urdf.Robot.from_dh("kuka_iiwa7"), dh2urdf.load_table("kuka_iiwa7")
    q = np.random.default_rng(3).uniform(robot.lower, robot.upper, (40, 7))
    q[:, 3] = 1e-4
    tally = Tally("stretched")

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={0: q[:, 0]})

    judge(tally, table, q, held, held=(0,))
    for fault in ("singular lost", "no answer", "wrong", "twice", "no family"):
        assert tally.count[fault] == 0, fault


@pytest.mark.parametrize("name", ["franka_fer", "franka_fr3", "xarm7"])
def test_of_two_solutions_side_by_side_along_a_valley_both_are_kept(name):
    """The pose is missed between them by more than is accepted: they are not one family."""
    table, tally = dh2urdf.load_table(name), Tally("side by side")
    q = np.radians((-131.06, -180, 106.19, 165.3, 7.29, -41.93, 3.56))
    q = q + 1e-9 * np.random.default_rng(0).standard_normal((12, 7))

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={3: q[:, 3]})

    judge(tally, table, q, held, held=(3,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0


ROUNDED = [
    ("franka_fer", 9, 5, (180, 180, 0, 0, 90, 90, -90), 0.0),
    ("franka_fr3", 9, 5, (180, 180, 0, 0, 90, 90, -90), 0.0),
    ("kuka_iiwa14", 4, 6, (-75.57, 83.21, -83.05, 0, 21.66, 105.13, 36.21), 5.934e-11),
    ("kuka_iiwa7", 9, 6, (-75.57, 83.21, -83.05, 0, 21.66, 105.13, 36.21), 5.934e-11),
]


@pytest.mark.parametrize(("name", "decimals", "joint", "degrees", "bent"), ROUNDED)
def test_of_rounded_twists_surfaces_are_named_whole_and_families_as_a_walk_confirms(
    name, decimals, joint, degrees, bent
):
    """Not a surface by a curve on it, nor what a closed form takes for a family beside one."""
    table, tally = rounded(dh2urdf.load_table(name), decimals), Tally("rounded twists")
    q = np.radians(degrees)
    q[3] += bent

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={joint: q[joint]})

    judge(tally, table, q[None], held, held=(joint,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0


@pytest.mark.parametrize(
    ("joint", "q"),
    [
        (2, (0.3, 0.8, 0.0, 0.0, 1.2, 0.0, 0.5)),
        (0, (0.3, 0.8, -0.7, 0.0, 1.2, 0.0, 0.5)),
        (2, (0.0, 2.3, 0.0, 0.0, np.pi, 0.0, -np.pi / 2)),
    ],
)
def test_with_elbow_and_wrist_straight_a_seed_enters_the_family_of_the_wrist(joint, q):
    """Axes 5 and 7 are one line, and rounding parts the elbow's double root from it."""
    robot = dh2urdf.Robot.from_dh("kinova_gen3")
    found = robot.ik(robot.fk(q), seed=q, locked={joint: q[joint]})
    assert found.free_joints[0] == (4, 6)
    assert np.abs(found.q[0] - q).max() < 1e-9


H = np.pi / 2

CRAMPED = [
    ("kuka_iiwa7", 9, 6, UPRIGHT + np.array((H, np.pi, H, -np.pi, H, H, H))),
    (
        "bent",
        4,
        5,
        np.array(
            (
                1.5707963267200278,
                1.7573262425319682e-11,
                9.76306297693364e-12,
                1.5707963268909317,
                2.0305028814674016e-10,
                1.5707963268932568,
                1.5707963269221914,
            )
        ),
    ),
    (
        "bent",
        None,
        2,
        np.array(
            (
                -1.5707963266787415,
                3.141592653667389,
                -9.620737434554694e-11,
                1.570796326739327,
                -3.141592653632525,
                -3.141592653573725,
                -1.5707963268094536,
            )
        ),
    ),
    (
        "bent",
        9,
        6,
        np.array(
            (
                2.0943966844993556,
                3.1415930424866296,
                -2.0943938894689977,
                -1.5707967522140207,
                2.0943953824038806,
                -2.6179933594421136,
                -1.5707960871258904,
            )
        ),
    ),
]


def table_of(name):
    """A table that ships, or an iiwa of other lengths whose elbow is bent at rest."""
    if name != "bent":
        return dh2urdf.load_table(name)
    table, lengths = dh2urdf.load_table("kuka_iiwa14"), (0.4, 0.0, 0.49, 0.0, 0.52, 0.0, 0.11)
    rows = [replace(row, d=d) for row, d in zip(table.rows, lengths, strict=True)]
    rows[3] = replace(rows[3], theta=H)
    return replace(table, rows=tuple(rows), name=name)


@pytest.mark.parametrize(("name", "decimals", "joint", "q"), CRAMPED)
def test_of_more_solutions_than_there_is_room_for_one_of_each_kind_is_kept(
    name, decimals, joint, q
):
    """Members of one family, which rounded twists part, leave room for the others."""
    table, tally = rounded(table_of(name), decimals), Tally("no room for all")

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={joint: q[joint]})

    judge(tally, table, q[None], held, held=(joint,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0


ON_THE_WAY = [
    ("franka_fer", None, 6, (-90, 0, 180, 135, 90, 0, 135)),
    ("kuka_iiwa14", 4, 6, (-90, 0, 180, 135, 90, 0, 135)),
]


@pytest.mark.parametrize(("name", "decimals", "joint", "degrees"), ON_THE_WAY)
def test_an_exact_solution_on_the_way_along_a_family_is_a_member_of_it(
    name, decimals, joint, degrees
):
    """Beside a shoulder in line, where the arm moves freely, others reach the pose exactly."""
    table, tally = rounded(dh2urdf.load_table(name), decimals), Tally("on the way")
    off = (1.2e-5, -1.07e-7, 5.47e-6, 3.84e-6, 1.203e-5, 5.06e-6, 2.03e-6)
    q = np.radians(degrees) + off

    def held(robot, Ts):
        return robot.ik_batch(Ts, within_limits=False, locked={joint: q[joint]})

    judge(tally, table, q[None], held, held=(joint,))
    assert tally.failures() == []
    assert tally.count["singular lost"] == 0
