"""A pose solved by one call into the extension: the same answers as by the calls in turn."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from dh2urdf import DHRow, JointType, Robot, engine, list_tables, load_table
from dh2urdf.exceptions import ConfigurationError, NameNotFoundError, PoseError
from dh2urdf.kernels.numbers import any_family, is_pose

pytestmark = pytest.mark.skipif(engine._COMPILED is None, reason="the kernels are interpreted")

ANGLES = np.radians([-180.0, -90.0, -45.0, 0.0, 30.0, 90.0])


def taken(robot):
    """The functions without and with limits, after a call of each kind; None where Python helps."""
    zero = np.zeros(robot.n)
    for seed in (None, zero):
        for inside in (False, True):
            robot.ik(robot.fk(zero), seed=seed, within_limits=inside)
    both = [robot._ik._plain[None, way][1] for way in range(4)]
    return None if engine.nothing_at_once in both else both


def poses(robot, m):
    """Poses anywhere, every other at multiples of 15 deg, where singularities are."""
    rng = np.random.default_rng(0)
    q = rng.uniform(robot.lower, robot.upper, (m, robot.n)).clip(-4, 4)
    q[::2] = np.where(robot.slides, q[::2], rng.choice(ANGLES, (len(q[::2]), robot.n)))
    return robot.fk(q)


@pytest.mark.parametrize("name", list_tables())
def test_one_call_answers_as_the_calls_in_turn_do(name):
    """With and without limits, bit by bit, or it leaves the pose to them."""
    robot = Robot.from_dh(name)
    both = taken(robot)
    if both is None:
        assert robot.solver.name not in ("spherical wrist", "three parallel axes", "short chain")
        return
    some = 0
    for T in poses(robot, 60):
        for inside in (False, True):
            apart = robot._ik.problem().solve_one(T, inside)
            together = robot.ik(T, within_limits=inside)
            some += both[inside](T) is not None
            for a, b in zip(
                (apart.q, apart.residual, *apart.codes),
                (together.q, together.residual, *together.codes),
                strict=True,
            ):
                np.testing.assert_array_equal(a, b)
            assert apart.T.tobytes() == together.T.tobytes() == T.tobytes()
    assert some > 20


def same_answers(a, b):
    """Bit by bit."""
    for x, y in zip(
        (a.q, a.residual, *a.codes, a.T), (b.q, b.residual, *b.codes, b.T), strict=True
    ):
        np.testing.assert_array_equal(x, y)


SEEDED = ["puma560", "ur5", "fanuc_crx10ia", "omron_cobra600", "stanford"]


@pytest.mark.parametrize("name", [*SEEDED, "franka_fer", "kuka_iiwa14", "kinova_gen3"])
def test_one_call_with_a_seed_answers_as_the_calls_in_turn_do(name):
    """Turned and sorted; seeds are arrays, lists, and what only Python takes."""
    robot, rng = Robot.from_dh(name), np.random.default_rng(1)
    calls, some = taken(robot), 0
    for T in poses(robot, 60):
        seed = rng.uniform(-7.0, 7.0, robot.n)
        for inside in (False, True):
            problem = robot._ik.problem()
            apart = problem.arranged(problem.solve_one(T, inside), seed, inside)
            for given in (seed, seed.tolist(), tuple(seed), np.repeat(seed, 2)[::2]):
                same_answers(robot.ik(T, seed=given, within_limits=inside), apart)
            some += calls[2 + inside](T, seed) is not None
    assert some > 20


@pytest.mark.parametrize("samples", [1, 16, 40])
def test_one_call_with_samples_answers_as_the_calls_in_turn_do(samples):
    """As many values of the swept joint as are asked for, with a seed and without."""
    robot, seed = Robot.from_dh("franka_fer"), np.full(7, 0.2)
    problem = robot._ik.problem(samples=samples)
    for T in poses(robot, 10):
        apart = problem.solve_one(T, True)
        near = problem.arranged(apart, seed, True)
        for _ in range(2):  # the first makes the function
            same_answers(robot.ik(T, samples=samples), apart)
            same_answers(robot.ik(T, samples=samples, seed=seed), near)
    assert engine.nothing_at_once not in [call for _, call in robot._ik._plain.values()]
    with pytest.raises(ConfigurationError, match="swept or locked"):
        robot.ik(T, samples=samples, locked={6: 0.3})


def test_seeds_that_are_none_are_refused_at_the_first_call_and_later():
    """The check is part of the call."""
    robot = Robot.from_dh("puma560")
    T, good = robot.fk(np.full(6, 0.3)), np.zeros(6)
    for bad in ([np.nan] * 6, [2e5, 0, 0, 0, 0, 0.0], np.zeros(5), [0.0] * 7, "seed", 1.0):
        for _ in range(2):
            with pytest.raises(ConfigurationError):
                robot.ik(T, seed=bad)
            assert len(robot.ik(T, seed=good))
    same_answers(robot.ik(T, seed=[0] * 6), robot.ik(T, seed=good))


def on_rail(name):
    """An arm on a rail: what is left where the rail is held is the arm itself."""
    table = load_table(name)
    rail = DHRow(0.0, 0.0, 0.0, 0.5 * np.pi, JointType.PRISMATIC, lower=-2.0, upper=2.0)
    return Robot.from_dh(replace(table, rows=(rail, *table.rows), name=f"{name}_on_rail"))


HOLDS = [("franka_fer", 6), ("kuka_iiwa7", 2), ("xarm7", 6), ("kinova_gen3", 2), ("ur5", 0)]


@pytest.mark.parametrize(("name", "joint"), HOLDS)
def test_one_call_with_a_joint_held_answers_as_the_calls_in_turn_do(name, joint):
    """Also beside and at values that line two axes up, at limits, by index, by name, seeded."""
    robot = on_rail(name) if name == "ur5" else Robot.from_dh(name)
    rng = np.random.default_rng(2)
    lower, upper = robot.lower[joint], robot.upper[joint]
    special = np.radians([-180.0, -90.0, 0.0, 90.0, 180.0])
    beside = (special[:, None] + [0.0, 5e-5, 1.5e-4, -3e-4]).ravel()
    values = np.concatenate([beside, [lower, upper], rng.uniform(-3.0, 3.0, 20)])
    some = 0
    for value in values[(lower <= values) & (values <= upper)].tolist():
        q = rng.uniform(-1.5, 1.5, robot.n)
        q[joint] = value
        T, seed = robot.fk(q), rng.uniform(-3.0, 3.0, robot.n)
        for inside in (False, True):
            apart = robot._ik.problem("pose", {joint: value}, inside).solve_one(T, inside)
            near = robot._ik.problem("pose", {joint: value}, inside).arranged(apart, seed, inside)
            for locked in ({joint: value}, {robot.chain.names[joint]: value}):
                for _ in range(2):
                    same_answers(robot.ik(T, locked=locked, within_limits=inside), apart)
                    asked = {"seed": seed, "locked": locked, "within_limits": inside}
                    same_answers(robot.ik(T, **asked), near)
                for towards in (None, seed):
                    answer = robot._ik._held.answer(T, locked, inside, towards)
                    some += answer is not None and answer[1] is not None
    assert some > 80


def test_a_held_value_that_is_none_is_refused_at_the_first_call_and_later():
    """Neither limits nor kinds of keys are passed by."""
    robot = Robot.from_dh("franka_fer")
    T = robot.fk(np.array([0.1, 0.2, 0.3, -1.5, 0.4, 1.6, 0.3]))
    for locked in ({6: 3.0}, {6: np.nan}, {True: 0.3}, {7: 0.3}, {"7": 0.3}, {6: "0.3"}):
        for _ in range(2):
            with pytest.raises((ConfigurationError, NameNotFoundError)):
                robot.ik(T, locked=locked)
            with pytest.raises(ConfigurationError):
                robot.ik(T, locked={6: 0.3}, seed=[np.nan] * 7)
            assert len(robot.ik(T, locked={6: 0.3}))
            assert len(robot.ik(T, locked={1: 0.2}))


def test_threads_do_not_mix_poses_seeds_and_held_values():
    """What a call is given and what it answers belong together."""
    puma, panda = Robot.from_dh("puma560"), Robot.from_dh("franka_fer")
    rng = np.random.default_rng(3)

    def work(seed):
        q = rng.uniform(-1.0, 1.0, 6)
        found = puma.ik(puma.fk(q), seed=q, within_limits=False)
        near = np.abs(found.q[0] - q).max() < 1e-9
        q = np.array([0.1, 0.2, 0.3, -1.5, 0.4, 1.6, seed / 1000])
        found = panda.ik(panda.fk(q), locked={6: float(q[6])})
        return near and (found.q[:, 6] == q[6]).all() and len(found) > 0

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(work, range(400)))


def test_a_pose_comes_as_an_array_in_any_order_as_a_list_or_as_of_pinocchio():
    """Neighbours in memory, strides and kinds of numbers do not count."""
    robot = Robot.from_dh("puma560")
    function = taken(robot)[True]
    T = poses(robot, 2)[1]
    wide = np.zeros((8, 12))
    wide[::2, ::3] = T
    want = robot.ik(T)
    assert len(want)
    for given in (T.copy("F"), wide[::2, ::3], wide[::2, ::3][::-1][::-1]):
        assert function(given) == function(T)
    for given in (
        T.tolist(),
        pin.SE3(T),
        T.astype(">f8"),
        T.view(np.matrix),
        T[None],
        np.ma.masked_array(T),
    ):
        assert function(given) is None
        np.testing.assert_array_equal(robot.ik(given).q, want.q)
    assert function(T.astype(np.float32)) is None
    assert len(robot.ik(T.astype(np.float32))) == len(want)
    for none in (None, "T", np.eye(3), np.zeros((4, 4, 1)), object()):
        assert function(none) is None


@pytest.mark.parametrize("spoil", [np.nan, np.inf, 2.0, 1e305])
def test_what_is_no_pose_is_refused_at_the_first_call_and_later(spoil):
    """The check is part of the call."""
    robot = Robot.from_dh("ur5")
    T = robot.fk(np.full(6, 0.3))
    bad = T.copy()
    bad[0, 0] = spoil
    for _ in range(2):
        with pytest.raises(PoseError):
            robot.ik(bad)
        assert len(robot.ik(T))


@pytest.mark.parametrize(
    "again", [copy.copy, copy.deepcopy, lambda x: pickle.loads(pickle.dumps(x))]
)
def test_a_copy_of_a_robot_that_has_solved_solves(again):
    """So does a copy of its solutions."""
    robot = Robot.from_dh("puma560")
    T = poses(robot, 2)[1]
    robot.ik(T)
    first = robot.ik(T)
    np.testing.assert_array_equal(again(robot).ik(T).q, first.q)
    np.testing.assert_array_equal(again(first).q, first.q)
    assert again(first).branch == first.branch


def test_answers_do_not_share_memory_and_count():
    """A later call leaves earlier answers as they are."""
    robot = Robot.from_dh("puma560")
    taken(robot)
    Ts = poses(robot, 40)[1::2]
    found = [robot.ik(T) for T in Ts]
    values = [f.q.copy() for f in found]
    for T in Ts[::-1]:
        robot.ik(T)
    assert len({len(f) for f in found}) > 1
    for f, q in zip(found, values, strict=True):
        np.testing.assert_array_equal(f.q, q)


def test_steps_that_are_no_entries_are_not_taken():
    """A function that is no compiled entry leaves everything to Python; faults are said."""
    memory = np.zeros(20)
    T = memory[:16].reshape(4, 4)
    assert engine.at_once(memory, (len, (T,), True)) is engine.nothing_at_once
    yes, no = (engine.at_once(memory, (is_pose, (T,), answer)) for answer in (True, False))
    assert yes(np.eye(4)) == np.append(np.eye(4), memory[16:]).tobytes()
    assert no(np.eye(4)) is None
    for args in ((), (T, T), (T[:3],), (5,), (T.T,)):
        with pytest.raises((TypeError, ValueError)):
            engine.at_once(memory, (is_pose, args, True))


def test_a_family_is_seen_among_the_solutions_only():
    """What lies behind the last solution of a pose is none of it."""
    free = np.array([[0, 0, 8], [0, 0, 0]])
    assert not any_family(np.array([2, 3]), free)
    assert any_family(np.array([3, 0]), free)
    assert not any_family(np.array([0, 0]), free)
