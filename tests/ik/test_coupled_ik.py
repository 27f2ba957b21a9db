"""Inverse kinematics where values move joints together: complete, certified, in the values' terms.

The brute force knows the arm without couplings, whose solutions are all of the joints up to full
turns, and goes through the turns of all joints.
"""

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from dh2urdf import DHRow, DHTable, Mimic, Robot, load_table
from dh2urdf.exceptions import ConfigurationError

TURN = 2.0 * np.pi
SEEDS = st.integers(0, 2**32 - 1)
RATIOS = st.one_of(st.sampled_from([1.0, -1.0, 0.5, 2.0, -0.25]), st.floats(-2, 2))
UNIT = {"joint_3": {"joint_2": 1.0}}
ARMS = ("puma560", "ur5", "denso_vs6556")


def named(name, couplings=(), limits=None, serial=()):
    """A shipped table whose joints are joint_1 to joint_6, coupled, with other limits."""
    rows = []
    for i, row in enumerate(load_table(name).joints):
        lower, upper = limits[i] if limits else (row.lower, row.upper)
        least, most = dict(serial).get(i, (None, None))
        own = {"lower": lower, "upper": upper, "serial_lower": least, "serial_upper": most}
        rows.append(replace(row, name=f"joint_{i + 1}", **own))
    table = load_table(name)
    return DHTable(
        tuple(rows), table.convention, name, table.base, table.tool, couplings=dict(couplings)
    )


@cache
def plain(name):
    """The arm without couplings or limits."""
    return Robot.from_dh(named(name, limits=((None, None),) * 6))


@st.composite
def couplings(draw):
    """One or two joints that add others; both ways now and then."""
    names = [f"joint_{i}" for i in range(1, 7)]
    first, second, third = draw(st.permutations(names))[:3]
    out = {second: {first: draw(RATIOS)}}
    way = draw(st.sampled_from(["pair", "both ways", "three"]))
    if way == "both ways":
        back = draw(RATIOS)
        assume(abs(1.0 - back * out[second][first]) > 0.2)
        out[first] = {second: back}
    if way == "three":
        out[third] = {first: draw(RATIOS), second: draw(RATIOS)}
    return out


def matrix_of(given):
    """The matrix from values to joints, read from the couplings."""
    C = np.eye(6)
    for name, terms in given.items():
        for other, ratio in terms.items():
            C[int(name[-1]) - 1, int(other[-1]) - 1] = ratio
    return C


def brute(robot, name, given, T):
    """For each solution of the joints, all values inside limits that put them there."""
    C, lower, upper = matrix_of(given), robot.lower, robot.upper
    back = np.linalg.inv(C)
    least, most = np.array(robot.table.joint_ranges).T
    out = []
    for joints in plain(name).ik(T, within_limits=False).q:
        spans = [
            joints[i]
            + TURN
            * np.arange(np.ceil((a - 1e-9 - joints[i]) / TURN), 1e-9 + (b - joints[i]) / TURN)
            for i, (a, b) in enumerate(zip(least, most, strict=True))
        ]
        every = np.array(list(itertools.product(*spans))).reshape(-1, 6)
        q = every @ back.T
        out.append(q[((q >= lower - 1e-12) & (q <= upper + 1e-12)).all(axis=1)])
    return out


def rows(q):
    """Configurations in an order of their own."""
    return q[np.lexsort(np.round(q, 6).T)] if len(q) else q.reshape(0, 6)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(ARMS), couplings(), SEEDS)
def test_all_turns_of_all_solutions_are_found(name, given_couplings, seed):
    """As by going through all turns of the joints; each solution once, in its nearest turn too."""
    rng = np.random.default_rng(seed)
    low = -rng.uniform(0.5, 4.5, 6)
    robot = Robot.from_dh(
        named(name, given_couplings, list(np.c_[low, low + rng.uniform(3, 8, 6)]))
    )
    q = robot.random_configuration(rng)
    T = robot.fk(q)
    wanted = brute(robot, name, given_couplings, T)
    found = robot.ik(T, turns="all")
    assume(not any(found.free_joints))
    whole = np.concatenate(wanted)
    assert len(found) == len(whole)
    assert np.abs(rows(found.q) - rows(whole)).max() < 1e-7
    assert np.abs(found.q - q).max(axis=1).min() < 1e-7
    assert found.residual.max() < 1e-10
    assert np.abs(found.verify()).max() < 1e-9
    centre = 0.5 * (robot.lower + robot.upper)
    near = np.array([w[np.linalg.norm(w - centre, axis=1).argmin()] for w in wanted if len(w)])
    once = robot.ik(T)
    distance = np.linalg.norm(once.q - centre, axis=1)
    assert np.abs(np.sort(distance) - np.sort(np.linalg.norm(near - centre, axis=1))).max() < 1e-7
    batch = robot.ik_batch(np.stack([T, T]))
    assert batch.count.tolist() == [len(once)] * 2
    assert np.abs(rows(batch[1].q) - rows(once.q)).max() < 1e-12


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(ARMS), couplings(), SEEDS)
def test_a_seed_is_met_in_its_own_turn(name, given_couplings, seed):
    """With limits of several turns the first solution is the seed itself, and distances are q's."""
    rng = np.random.default_rng(seed)
    robot = Robot.from_dh(named(name, given_couplings, [(-7.0, 7.0)] * 6))
    q = robot.random_configuration(rng)
    T = robot.fk(q)
    found = robot.ik(T, seed=q)
    assume(not any(found.free_joints))
    assert np.abs(found.q[0] - q).max() < 1e-7
    every = [w for w in brute(robot, name, given_couplings, T) if len(w)]
    near = [w[np.linalg.norm(w - q, axis=1).argmin()] for w in every]
    wanted = np.sort(np.linalg.norm(np.array(near) - q, axis=1))
    assert np.abs(np.linalg.norm(found.q - q, axis=1) - wanted).max() < 1e-7
    assert np.abs(robot.ik(T).nearest(q) - q).max() < 1e-7
    one = robot.ik(T, seed=q + 1e-3, seed_tolerance=2e-3)
    assert len(one) == 1
    again = robot.ik_batch(T[None]).nearest(q)
    assert np.abs(again.q[0, 0] - q).max() < 1e-7


def test_without_limits_every_solution_is_near_zero():
    """The turn of the joints that puts the values nearest to zero."""
    robot = Robot.from_dh(named("puma560", UNIT, ((None, None),) * 6))
    T = robot.fk([0.3, 0.2, 0.4, 0.5, 0.6, 0.7])
    found = robot.ik(T)
    assert len(found) == 8
    assert np.abs(found.q).max() <= np.pi + 1e-12


def test_solutions_without_a_turn_inside_add_none_to_all_turns():
    """With all turns those within the limits are left, also where solutions outside are allowed."""
    robot = Robot.from_dh(named("puma560", UNIT))
    outside = 0
    for seed in range(10):
        T = robot.fk(robot.random_configuration(seed))
        anywhere = robot.ik(T, within_limits=False, turns="all")
        inside = robot.ik(T, turns="all")
        assert np.abs(rows(anywhere.q) - rows(inside.q)).max() < 1e-9
        outside += len(robot.ik(T, within_limits=False)) - len(robot.ik(T))
    assert outside > 0


def test_serial_limits_leave_solutions_out():
    """What the joint itself may not do, whatever the controller shows."""
    free = Robot.from_dh(named("puma560", UNIT))
    cut = Robot.from_dh(named("puma560", UNIT, serial={2: (-1.0, 1.0)}))
    rng = np.random.default_rng(0)
    kept = 0
    for _ in range(50):
        T = free.fk(free.random_configuration(rng))
        every, some = free.ik(T, turns="all"), cut.ik(T, turns="all")
        third = every.q[:, 2] + every.q[:, 1]
        inside = every.q[np.abs(third) <= 1.0]
        assert len(some) == len(inside)
        assert not len(inside) or np.abs(rows(some.q) - rows(inside)).max() < 1e-12
        kept += len(inside)
    assert 0 < kept < 200


def test_a_held_value_holds_its_joint():
    """Joint 2 is where its value is; the third value is found beside it."""
    robot = Robot.from_dh(named("puma560", UNIT))
    rng = np.random.default_rng(1)
    for _ in range(20):
        q = robot.random_configuration(rng)
        for held in ({"joint_2": q[1]}, {1: q[1], 2: q[2]}, {"joint_5": q[4]}):
            found = robot.ik(robot.fk(q), locked=held)
            index = [int(str(key)[-1]) - isinstance(key, str) for key in held]
            assert np.array_equal(found.q[:, index], np.tile(q[index], (len(found), 1)))
            turned = robot.ik(robot.fk(q), locked=held, turns="all").q
            assert np.abs(turned - q).max(axis=1).min() < 1e-7


def test_values_are_held_in_a_batch():
    """One value a pose."""
    robot = Robot.from_dh(named("puma560", UNIT))
    rng = np.random.default_rng(2)
    q = np.array([robot.random_configuration(rng) for _ in range(100)])
    batch = robot.ik_batch(robot.fk(q), locked={1: q[:, 1]})
    assert batch.count.min() > 0
    assert np.array_equal(batch.q[:, 0, 1], q[:, 1])
    for i in range(5):
        one = robot.ik(robot.fk(q[i]), locked={1: q[i, 1]})
        assert np.abs(one.q - batch[i].q).max() < 1e-12


def test_a_value_that_moves_no_joint_alone_is_refused_when_held():
    """The message says what to hold, too."""
    robot = Robot.from_dh(named("puma560", UNIT))
    with pytest.raises(ConfigurationError, match="joint_3 alone holds no joint still") as error:
        robot.ik(np.eye(4), locked={"joint_3": 0.1})
    assert "hold joint_2, too" in str(error.value)


@pytest.mark.parametrize(("ratio", "free"), [(1.0, {3, 5}), (-1.0, {3}), (0.5, {3, 5})])
def test_free_joints_are_those_whose_values_move(ratio, free):
    """Where the wrist is stretched joints 4 and 6 turn against each other."""
    robot = Robot.from_dh(named("puma560", {"joint_6": {"joint_4": ratio}}))
    q = np.array([0.3, 0.2, 0.4, 0.5, 0.0, 0.7])
    found = robot.ik(robot.fk(q), seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-6
    assert set(found.free_joints[0]) == free
    batch = robot.ik_batch(robot.fk(q)[None])
    masks = [set(joints) for joints in batch[0].free_joints if joints]
    assert masks
    assert all(mask == free for mask in masks)


def test_families_outside_the_block_are_entered_as_without_couplings():
    """The wrist's family, of an arm whose second and third joints are coupled."""
    robot = Robot.from_dh(named("puma560", UNIT))
    q = np.array([0.3, 0.2, 0.4, 1.5, 0.0, -0.7])
    found = robot.ik(robot.fk(q), seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-6
    assert found.free_joints[0] == (3, 5)


def test_a_path_is_measured_in_values():
    """No value jumps on a straight line; joint names and motion are those of q."""
    robot = Robot.from_dh(named("puma560", UNIT))
    a, b = np.array([0.3, 0.2, -0.6, 0.5, 0.6, 0.7]), np.array([0.5, -0.3, 0.3, 0.2, 0.8, 0.1])
    q = a + (b - a) * np.linspace(0, 1, 40)[:, None]
    path = robot.ik_path(robot.fk(q), start=a)
    assert path.continuous
    assert path.joint_names == robot.joint_names
    assert np.abs(path.q - q).max() < 1e-6
    assert path.motion == pytest.approx(np.linalg.norm(b - a), rel=1e-6)


def test_why_there_is_none_speaks_of_the_values():
    """The limit that is broken is q's; what is out of reach is out of reach of the joints."""
    limits = [(-3.0, 3.0)] * 2 + [(-0.1, 0.1)] + [(-3.0, 3.0)] * 3
    robot = Robot.from_dh(named("puma560", UNIT, limits))
    wide = Robot.from_dh(named("puma560", UNIT))
    T = wide.fk([0.3, 0.2, -1.4, 0.5, 0.6, 0.7])
    assert not len(robot.ik(T))
    assert "outside the joint limits, the nearest by" in robot.why_unreachable(T)
    far = T.copy()
    far[:3, 3] *= 10
    assert "outside the reach of joints 1 to 3" in robot.why_unreachable(far)
    assert wide.why_unreachable(T) == ""


def test_controller_words_are_of_the_joints():
    """A word says which solution is meant, whatever the controller's third angle counts from."""
    coupled, joints = (Robot.from_dh(named("denso_vs6556", c)) for c in (UNIT, {}))
    T = joints.fk([0.1, -0.8, 0.3, 0.4, 0.5, 0.6])
    seen = dict(zip(coupled.ik(T).words("fanuc"), coupled.ik(T).q[:, 0], strict=True))
    wanted = dict(zip(joints.ik(T).words("fanuc"), joints.ik(T).q[:, 0], strict=True))
    assert set(wanted) <= set(seen)
    assert all(abs(seen[word] - wanted[word]) < 1e-9 for word in wanted)


def test_an_arm_of_a_kilometre_is_coupled_as_well():
    """Solved in a unit of its own, with a slide that the second joint moves along."""
    rows = [replace(row, a=row.a * 1e3, d=row.d * 1e3) for row in named("puma560").rows]
    robot = Robot.from_dh(DHTable(tuple(rows), "standard", couplings=UNIT))
    rng = np.random.default_rng(3)
    for _ in range(20):
        q = robot.random_configuration(rng)
        found = robot.ik(robot.fk(q), seed=q)
        assert np.abs(found.q[0] - q).max() < 1e-7


def test_a_leader_off_the_chain_moves_its_follower_alone(written):
    """q is the leader's value where a joint of the chain follows one beside it."""
    link = '<link name="{}"/>'
    joint = (
        '<joint name="{0}" type="revolute"><parent link="{1}"/><child link="{2}"/>'
        '<axis xyz="0 0 1"/><origin xyz="{3} 0 0"/>{4}'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
    )
    text = "".join(link.format(name) for name in ("base", "side", "a", "b", "tip"))
    text += joint.format("beside", "base", "side", 0.1, "")
    text += joint.format("one", "base", "a", 0.2, '<mimic joint="beside" multiplier="-2"/>')
    text += joint.format("two", "a", "b", 0.5, "")
    text += '<joint name="end" type="fixed"><parent link="b"/><child link="tip"/></joint>'
    robot = Robot.from_urdf(written("arm.urdf", f'<robot name="r">{text}</robot>'), "base", "tip")
    q = np.array([0.2, 0.4])
    assert robot.joint_names == ("beside", "two")
    found = robot.ik(robot.fk(q), seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-7
    assert np.abs(robot.fk(found.q) - robot.fk(q)).max() < 1e-9


def test_followers_and_couplings_go_together():
    """A hollow wrist, joint 5b at minus joint 5, of an arm whose J3 counts from the level."""
    names = [f"joint_{i}" for i in range(1, 8)]
    cells = [(0.3, 0.1, 1.5708), (0, 0.5, 0.2), (0.1, 0.1, 1.5708), (0.6, 0, 0.6), (0.1, 0, -1.2)]
    rows = [DHRow(0.1, d, a, alpha, lower=-2.5, upper=2.5) for d, a, alpha in cells]
    rows += [DHRow(0.2, 0.1, 0.05, 0.6, mimic=Mimic("joint_5", -1.0)), DHRow(d=0.1)]
    rows = [replace(row, name=name) for row, name in zip(rows, names, strict=True)]
    rows[6] = replace(rows[6], lower=-3.0, upper=3.0)
    robot = Robot.from_dh(DHTable(tuple(rows), "standard", couplings={"joint_3": {"joint_2": 1.0}}))
    assert robot.n == 6
    rng = np.random.default_rng(4)
    for _ in range(10):
        q = robot.random_configuration(rng)
        found = robot.ik(robot.fk(q), seed=q)
        assert np.abs(found.q[0] - q).max() < 1e-6
        assert (found.q >= robot.lower - 1e-9).all()
        assert (found.q <= robot.upper + 1e-9).all()
        assert found.verify().max() < 1e-9


def test_followers_by_half_turns_are_found_beside_couplings():
    """A turn of the leader is half a one of its follower: two bring both back."""
    rows = [DHRow(0.1, 0.1, 0.2, 1.0) for _ in range(6)] + [
        DHRow(a=0.1, mimic=Mimic("joint_5", 0.5))
    ]
    robot = Robot.from_dh(DHTable(tuple(rows), "standard", couplings={"joint_3": {"joint_2": 1.0}}))
    q = np.array([0.3, -0.4, 0.5, 0.6, 4.0, -0.8])
    found = robot.ik(robot.fk(q), seed=q)
    assert np.abs(found.q[0] - q).max() < 1e-7
    turn = TURN * np.eye(6)[4]
    assert found.gaps(q + 2 * turn)[0].max() < 1e-7
    assert found.gaps(q + turn)[0, 4] == pytest.approx(TURN)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize(
    "given_couplings",
    [
        UNIT,
        {"joint_3": {"joint_2": -0.5}},
        {"joint_5": {"joint_4": 1.0}, "joint_6": {"joint_4": 0.5, "joint_5": -1.0}},
        {"joint_2": {"joint_3": 0.3}, "joint_3": {"joint_2": 1.7}},
    ],
)
def test_twenty_thousand_poses_of_each_arm(name, given_couplings):
    """Each generating configuration is found up to turns of the joints, all inside their limits."""
    limits = list(np.c_[np.full(6, -3.3), [2.9, 3.4, 3.0, 4.0, 3.1, 5.0]])
    robot = Robot.from_dh(named(name, given_couplings, limits))
    rng = np.random.default_rng(5)
    q = rng.uniform(robot.lower, robot.upper, (20_000, 6))
    T = robot.fk(q)
    batch = robot.ik_batch(T)
    there = np.arange(batch.q.shape[1]) < batch.count[:, None]
    C = matrix_of(given_couplings)
    gap = np.where(there[..., None], batch.q - q[:, None], 1.0) @ C.T
    away = np.abs(np.remainder(gap + np.pi, TURN) - np.pi).max(axis=2)
    near = np.where(there, away, 9.0).min(axis=1)
    regular = np.linalg.svd(robot.jacobian(q), compute_uv=False)[:, -1] > 1e-5
    assert near[regular].max() < 1e-5
    found = batch.q[there]
    assert (found >= robot.lower).all()
    assert (found <= robot.upper).all()
    assert np.nanmax(batch.residual) < 1e-10
    assert np.abs(robot.fk(found) - T[there.nonzero()[0]]).max() < 1e-9


def test_the_solver_says_where_coupled_joints_are():
    """Beside the axes and the subproblems."""
    told = Robot.from_dh("fanuc_r1000ia80f").solver.explain()
    assert "joint_3 is at q3 + q2" in told.splitlines()
