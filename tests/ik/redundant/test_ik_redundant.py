"""Arms of seven joints: one held, one swept, and what lies between the samples."""

import math
from functools import cache

import ik_referee as ref
import numpy as np
import pytest
from dh_product import rows
from ik_referee import GAP, RESIDUAL, distances, forward, jacobians, misses, random_robot, rows_of
from margins import assert_apart, assert_margin

import dh2urdf
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.ik.arm import limits
from dh2urdf.ik.redundant.self_motion import members, nearest_members, sample_values

ARMS = ["franka_fer", "franka_fr3", "kuka_iiwa7", "kuka_iiwa14", "xarm7", "kinova_gen3"]
SWEPT = {"franka_fer": "fer_joint7", "franka_fr3": "fr3_joint7", "xarm7": "joint7"}
SWEPT |= {"kuka_iiwa7": "joint_a3", "kuka_iiwa14": "joint_a3", "kinova_gen3": "Actuator3"}

# Joints that can be held so that the others have a closed form. With the elbow of an arm held that
# has a spherical shoulder and wrist, the others have a joint to spare.
CLOSED = dict.fromkeys(("franka_fer", "franka_fr3"), (3, 4, 5, 6))
CLOSED |= dict.fromkeys(("kuka_iiwa7", "kuka_iiwa14"), (0, 1, 2, 4, 5, 6))
CLOSED |= {"xarm7": (3, 4, 5, 6), "kinova_gen3": (0, 1, 2, 3)}
HELD_CLOSED = [(name, joint) for name, joints in CLOSED.items() for joint in joints]
HELD_GENERAL = [
    (name, joint)
    for name in ("franka_fer", "xarm7", "kinova_gen3")
    for joint in range(7)
    if joint not in CLOSED[name]
]


@cache
def robot_of(name):
    return dh2urdf.Robot.from_dh(name)


def draw(robot, m, seed):
    """Configurations within the limits, one in three with a nearly straight elbow."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(robot.lower, robot.upper, (m, 7))
    near = rng.random(m) < 1 / 3
    straight = np.clip(0.0, robot.lower[3], robot.upper[3])
    q[near, 3] = straight + 10.0 ** rng.uniform(-5, -1, near.sum()) * np.sign(q[near, 3] - straight)
    return np.clip(q, robot.lower, robot.upper)


def held_regularity(robot, q, joint):
    """Smallest singular value of the Jacobian without a joint, lengths relative, (k,)."""
    J = np.delete(jacobians(robot.chain, q), joint, axis=-1)
    J[..., :3, :] /= robot.chain.size
    return np.linalg.svd(J, compute_uv=False)[..., -1]


def check_held(robot, joint, m, seed):
    """All contracts at random poses, and that each has its own configuration."""
    q = draw(robot, m, seed)
    Ts = forward(robot.chain, q)
    batch = robot.ik_batch(Ts, locked={joint: q[:, joint]})
    found, owner = rows_of(batch)
    error = ref.pose_errors(forward(robot.chain, found), Ts[owner])
    assert_margin(error, RESIDUAL, quantile=0.999)
    assert np.array_equal(found[:, joint], q[owner, joint])
    assert np.all((found >= robot.lower - 1e-12) & (found <= robot.upper + 1e-12))
    assert_apart(distances(robot.chain, batch), GAP, quantile=0.999)
    regular = held_regularity(robot, q, joint)
    allowed = np.maximum(GAP, 1e-13 / np.maximum(regular, 1e-15) ** 2)
    assert_margin(misses(robot.chain, batch, q), allowed, quantile=0.999)


@pytest.mark.parametrize(("name", "joint"), HELD_CLOSED)
def test_the_generating_configuration_is_found_at_its_own_value(name, joint):
    """Of 500 poses, straight elbows among them, each has its configuration at its held value."""
    check_held(robot_of(name), joint, 500, seed=joint)


@pytest.mark.parametrize(("name", "joint"), HELD_GENERAL)
def test_any_other_joint_can_be_held_too(name, joint):
    """Where holding a joint leaves no closed form the general solver finds the configuration."""
    check_held(robot_of(name), joint, 30, seed=joint)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_the_generating_configuration_is_found_in_100_000_poses(name):
    """At the value of the swept joint each of 100,000 poses has its own configuration."""
    robot = robot_of(name)
    joint = robot.joint_names.index(SWEPT[name])
    for seed in range(10):
        check_held(robot, joint, 10_000, seed)


@pytest.mark.parametrize("slide", [0, 3, 6])
def test_a_sliding_joint_can_be_held(slide):
    """An arm of six turning joints with a slide somewhere is solved at the slide's values."""
    robot = random_robot(7, (slide,), seed=slide, turn=2.9)
    q = np.random.default_rng(0).uniform(robot.lower, robot.upper, (10, 7))
    batch = robot.ik_batch(robot.fk(q), locked={slide: q[:, slide]})
    assert_margin(misses(robot.chain, batch, q), GAP)
    assert "general 6R" in robot.solver_for(locked={slide: 0.1}).explain()


@pytest.mark.parametrize(("name", "joint"), [("franka_fer", 6), ("kuka_iiwa14", 2)])
def test_single_calls_equal_the_batch(name, joint):
    """A batch with a value for each pose has the solutions of one call a pose, by name too."""
    robot = robot_of(name)
    q = draw(robot, 200, seed=8)
    Ts = robot.fk(q)
    batch = robot.ik_batch(Ts, locked={joint: q[:, joint]}, threads=2)
    key = robot.joint_names[joint]
    alone = [robot.ik(T, locked={key: x[joint]}).q for x, T in zip(q, Ts, strict=True)]
    assert_margin(np.abs(np.concatenate(alone) - rows_of(batch)[0]), 1e-9)


@pytest.mark.parametrize("name", ARMS)
def test_values_at_which_axes_line_up_are_like_others(name):
    """At 0, near 0 and at quarter turns of the held joint the configuration is found."""
    robot = robot_of(name)
    joint = robot.joint_names.index(SWEPT[name])
    values = [0.0, 1e-10, 1e-8, -1e-6, 1e-4, math.pi / 2, -math.pi / 2, math.pi / 2 - 1e-9]
    rng = np.random.default_rng(3)
    q = np.repeat(rng.uniform(robot.lower, robot.upper, (20, 7)), len(values), axis=0)
    q[:, joint] = np.tile(values, 20)
    batch = robot.ik_batch(robot.fk(q), locked={joint: q[:, joint]})
    assert_margin(misses(robot.chain, batch, q), GAP)


@pytest.mark.parametrize("name", ARMS)
def test_the_swept_joint_is_named(name):
    """The solver says which joint it sweeps, why, and what solves for the others."""
    solver = robot_of(name).solver
    family = "shoulder" if name[0] in "fx" else "wrist"
    assert str(solver) == f"spherical {family}, {SWEPT[name]} swept"
    assert f"{SWEPT[name]} at 16 values" in solver.explain()


@pytest.mark.parametrize("name", ARMS)
def test_a_sweep_is_the_union_of_its_values(name):
    """Without a held joint the solutions are those at the samples, each verified by Pinocchio."""
    robot = robot_of(name)
    joint = robot.joint_names.index(SWEPT[name])
    rng = np.random.default_rng(5)
    for samples in (1, 7):
        T = robot.fk(rng.uniform(0.7 * robot.lower, 0.7 * robot.upper))
        found = robot.ik(T, samples=samples)
        values = sample_values(robot.chain, joint, samples, True)
        single = [robot.ik(T, locked={joint: v}).q for v in values]
        if found and np.isin(found.q[:, joint], values).all():
            assert_margin(np.abs(found.q - np.concatenate(single)), 1e-9)
        else:
            assert sum(len(q) for q in single) == 0
        assert_margin(np.append(found.verify(), 0.0), RESIDUAL)


@pytest.mark.parametrize("name", ARMS)
def test_reachable_poses_have_solutions(name):
    """A pose that is reached in a short interval only is not called out of reach."""
    robot = robot_of(name)
    q = np.random.default_rng(6).uniform(robot.lower, robot.upper, (150, 7))
    batch = robot.ik_batch(robot.fk(q), samples=4)
    assert batch.count.min() > 0
    found, owner = rows_of(batch)
    assert_margin(ref.pose_errors(forward(robot.chain, found), robot.fk(q)[owner]), RESIDUAL)
    assert limits.inside(robot.chain, found).all()


def brute_force_distance(robot, T, seed, samples):
    """Distance from a seed to the nearest of many samples."""
    q = robot.ik(T, samples=samples).q
    return np.linalg.norm(limits.turned_to(robot.chain, q, seed) - seed, axis=1).min()


@pytest.mark.parametrize("name", ["franka_fer", "kuka_iiwa14", "xarm7", "kinova_gen3"])
def test_the_nearest_solution_is_nearer_than_any_sample(name):
    """With a seed the first solution is as near as the best of 1,000 values of the swept joint."""
    robot = robot_of(name)
    rng, measured = np.random.default_rng(7), []
    for _ in range(15):
        T = robot.fk(rng.uniform(robot.lower, robot.upper))
        seed = rng.uniform(robot.lower, robot.upper)
        found = robot.ik(T, seed=seed)
        distances = np.linalg.norm(found.q - seed, axis=1)
        assert np.all(np.diff(distances) >= 0.0)
        assert distances[0] <= brute_force_distance(robot, T, seed, 1000) + 1e-7
        assert limits.inside(robot.chain, found.q).all()
        measured += found.verify().tolist()
    assert_margin(measured, RESIDUAL)


def test_a_curve_between_two_values_of_the_swept_joint_is_found():
    """Of a curve on which joint 7 moves by less than from value to value points are known.

    The elbow is nearly straight, and joints 3 and 5 turn against each other.
    """
    robot = robot_of("franka_fr3")
    q = np.array([-0.4944, 1.5475, 3.0308, 0.0119, 1.6535, 2.1627, -0.8802])
    found = members(robot.solver, robot.fk(q), q, within_limits=False)
    far = np.abs(np.remainder(found - q + math.pi, 2 * math.pi) - math.pi).max(axis=1)
    on_curve = np.abs(found[:, 3]) < 0.1
    assert far.min() < 0.2
    assert np.ptp(found[on_curve, 6]) < 2 * math.pi / 256
    assert np.ptp(found[on_curve, 2]) > 2.0


@pytest.mark.parametrize("name", ["franka_fer", "kuka_iiwa14"])
def test_no_step_along_the_self_motion_comes_nearer(name):
    """At the nearest solution away from limits the self-motion is square to the way to the seed."""
    robot = robot_of(name)
    rng, slopes = np.random.default_rng(9), []
    for _ in range(20):
        T = robot.fk(rng.uniform(robot.lower, robot.upper))
        seed = rng.uniform(robot.lower, robot.upper)
        q = nearest_members(robot.solver, T, seed, within_limits=True)[0]
        if np.min(np.minimum(q - robot.lower, robot.upper - q)) < 1e-3:
            continue
        tangent = np.linalg.svd(jacobians(robot.chain, q))[2][-1]
        slopes.append(abs(tangent @ (seed - q)))
    assert len(slopes) >= 3
    # The distance stops falling where the slope squared is its rounding: sqrt(eps) of it.
    assert_margin(slopes, 1e-6, 2)


@pytest.mark.parametrize("name", ARMS)
def test_a_seed_that_solves_the_pose_is_returned(name):
    """The seed's own pose gives the seed back."""
    robot = robot_of(name)
    rng = np.random.default_rng(4)
    seeded, nearest = [], []
    for q in rng.uniform(robot.lower, robot.upper, (20, 7)):
        T = robot.fk(q)
        seeded.append(robot.ik(T, seed=q)[0] - q)
        nearest.append(robot.ik(T).nearest(q) - q)
    assert_margin(np.abs(seeded), 1e-7)
    assert_margin(np.abs(nearest), 1e-7)


def is_at_an_end(robot, joint, q):
    """Whether q has a joint at a limit, or the swept joint at a turning point of its curve."""
    margin = np.minimum(q - robot.lower, robot.upper - q).min()
    return margin < 1e-8 or held_regularity(robot, q, joint) < 1e-4


@pytest.mark.parametrize("name", ARMS)
def test_intervals_end_where_reach_ends(name):
    """Just inside an end the pose has a solution at a limit or a fold; just outside it has none."""
    robot = robot_of(name)
    joint = robot.joint_names.index(SWEPT[name])
    low, high = robot.lower[joint], robot.upper[joint]
    rng = np.random.default_rng(11)
    for _ in range(4):
        q = rng.uniform(robot.lower, robot.upper)
        T = robot.fk(q)
        intervals = robot.ik_intervals(T)
        assert np.all(np.diff(intervals.ravel()) > 0.0)
        assert ((intervals[:, 0] <= q[joint]) & (q[joint] <= intervals[:, 1])).any()
        for end, inward in [
            (e, s) for pair in intervals for e, s in zip(pair, (1, -1), strict=True)
        ]:
            at_end = robot.ik(T, locked={joint: min(max(end, low), high)})
            assert at_end
            if low < end < high:
                assert any(is_at_an_end(robot, joint, p) for p in at_end)
                beyond = end - 1e-6 * inward
                assert not robot.ik(T, locked={joint: min(max(beyond, low), high)})


@pytest.mark.parametrize("name", ["franka_fer", "xarm7"])
def test_intervals_agree_with_many_held_values(name):
    """A held value has a solution exactly if it lies in an interval."""
    robot = robot_of(name)
    joint = robot.joint_names.index(SWEPT[name])
    T = robot.fk(np.random.default_rng(12).uniform(robot.lower, robot.upper))
    intervals = robot.ik_intervals(T)
    values = np.random.default_rng(0).uniform(robot.lower[joint], robot.upper[joint], 2000)
    batch = robot.ik_batch(np.repeat(T[None], 2000, axis=0), locked={joint: values})
    inside = ((intervals[:, :1] <= values) & (values <= intervals[:, 1:])).any(axis=0)
    near = np.abs(intervals.reshape(-1, 1) - values).min(axis=0) < 1e-6
    assert np.array_equal(inside[~near], (batch.count > 0)[~near])


def test_intervals_without_limits_cover_a_turn():
    """Without limits an interval lies in one turn, and is wider than within the limits."""
    robot = robot_of("kuka_iiwa14")
    T = robot.fk(np.random.default_rng(13).uniform(0.5 * robot.lower, 0.5 * robot.upper))
    free, bound = robot.ik_intervals(T, within_limits=False), robot.ik_intervals(T)
    assert np.ptp(free) <= 2 * math.pi + 1e-12
    assert np.diff(free, axis=1).sum() >= np.diff(bound, axis=1).sum()


def test_an_unreachable_pose_has_no_interval():
    """A pose 5 m away has no solution, no interval, and none near a seed."""
    robot = robot_of("franka_fer")
    T = np.eye(4)
    T[0, 3] = 5.0
    assert robot.ik_intervals(T).shape == (0, 2)
    assert not robot.ik(T)
    assert not robot.ik(T, seed=np.zeros(7), within_limits=False)


def test_an_arm_without_any_closed_form_is_swept():
    """Seven skew axes: an end is held, the general solver does the rest."""
    robot = random_robot(7, seed=3, turn=2.9)
    q = np.random.default_rng(2).uniform(robot.lower, robot.upper)
    T = robot.fk(q)
    found = robot.ik(T, samples=8)
    assert str(robot.solver) == "general 6R, joint_1 swept"
    assert_margin(found.verify(), RESIDUAL)
    assert_margin(np.abs(robot.ik(T, seed=q)[0] - q), GAP)


def test_holding_the_elbow_names_the_joints_left_free():
    """With the elbow of an iiwa held the rest still moves: the solutions name the free joints."""
    robot = robot_of("kuka_iiwa14")
    q = np.array([0.3, 0.5, -0.2, 0.9, 0.4, -0.6, 0.1])
    found = robot.ik(robot.fk(q), locked={3: 0.9})
    assert_margin(found.verify(), RESIDUAL)
    assert all(set(free) >= {0, 2, 4, 6} for free in found.free_joints)


WRONG = {
    "zero": ({"samples": 0}, "samples: expected a whole number from 1 .* got 0"),
    "float": ({"samples": 2.5}, "samples: expected a whole number from 1 .* got 2.5"),
    "both": ({"samples": 4, "locked": {6: 0.1}}, "samples: a joint is swept or locked, not both"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_samples_are_one_clear_exception(case):
    """The message says what is allowed."""
    arguments, message = WRONG[case]
    with pytest.raises(ConfigurationError, match=message):
        robot_of("franka_fer").ik(np.eye(4), **arguments)


def test_a_sweep_of_six_joints_is_refused():
    """An arm without a joint to spare has neither samples nor intervals."""
    robot = dh2urdf.Robot.from_dh("ur5")
    with pytest.raises(ConfigurationError, match="no joint is swept"):
        robot.ik(np.eye(4), samples=4)
    with pytest.raises(ConfigurationError, match="no joint is swept"):
        robot.ik_intervals(np.eye(4))


def test_a_seed_on_another_curve_of_a_redundant_arm_is_the_first_answer():
    """Held values lead to members of some curves; the seed leads to its own."""
    table = dh2urdf.DHTable.from_array(
        rows(
            "pi -.1425 0 pi; 0 0 -.411 pi; -h .2 0 -1.0471975511965976;"
            "pi -.5697 .3 0; -h 0 .5 0; 0 .2 .3 0"
        ),
        convention="modified",
        columns="theta d a alpha",
    )
    robot = dh2urdf.Robot.from_dh(table)
    q = np.array([1.4364, -2.9494, -1.7405, -2.9401, 1.2902, -3.104])
    found = robot.ik(robot.fk(q), seed=q, within_limits=False)
    assert_margin(np.abs(found.q[0] - q).max(), 1e-6)


def test_an_idle_joint_stays_where_the_seed_has_it():
    """Joint 4 of a SCARA turns the tool about its own origin: a point leaves it to the seed."""
    robot = dh2urdf.Robot.from_dh("omron_cobra600")
    seed = np.array([0.4, 0.9, 0.1, 1.3])
    found = robot.ik(robot.fk(seed)[:3, 3], seed=seed, task="position")
    assert_margin(np.abs(found.q[:, 3] - seed[3]).max(), 1e-6)
    assert_margin(np.abs(found.q[0] - seed).max(), 1e-6)
