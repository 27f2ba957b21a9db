"""What must hold of every solver, through ``Robot.ik``: seven points, over robots and seeds.

Every third configuration is drawn near a singularity. Pinocchio is the referee.
"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from ik_referee import GAP, RESIDUAL, by_pinocchio, distances, gaps, misses, rows_of
from margins import assert_apart, assert_margin

import dh2urdf
from dh2urdf.exceptions import ConfigurationError, NameNotFoundError, NoSolverError, PoseError
from dh2urdf.transforms import rotation_angle

CLOSED = ("denso_vs6556", "puma560", "ur5", "stanford", "gantry_wrist")
SHORT = ("planar_rrr", "rpr_new_frame", "rpr_by_inspection")
ARMS = CLOSED + SHORT
SEEDS = (0, 1)

REACHED = [25, pytest.param(100, marks=pytest.mark.exhaustive)]
"""Poses with a joint at a value where solutions form a family, or nearly."""


@cache
def robot_of(name):
    return dh2urdf.Robot.from_dh(name)


def configurations(name, seed, count=150):
    """Configurations within the limits, every third with a joint near a quarter turn or zero."""
    robot = robot_of(name)
    rng = np.random.default_rng(seed)
    out = []
    for k in range(count):
        q = robot.random_configuration(rng)
        if k % 3 == 2:
            j = rng.integers(robot.n)
            if not robot.slides[j]:
                q[j] = round(q[j] / (math.pi / 2)) * math.pi / 2 + rng.choice([0, 1e-9, 1e-5])
                q[j] = np.clip(q[j], robot.lower[j], robot.upper[j])
        out.append(q)
    return np.array(out)


def pinocchio_residual(robot, q, T):
    """Position and orientation error by the model that Pinocchio owns."""
    found = robot.fk(q)
    turn = rotation_angle(T[:3, :3].T @ found[:3, :3])
    return max(np.linalg.norm(found[:3, 3] - T[:3, 3]), float(turn))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ARMS)
def test_1_every_solution_reaches_the_pose(name, seed):
    """Pinocchio measures at most 1e-9 for every solution, and verify() says the same."""
    robot = robot_of(name)
    measured, said, held = [], [], []
    for q in configurations(name, seed):
        T = robot.fk(q)
        found = robot.ik(T)
        measured += [pinocchio_residual(robot, s, T) for s in found]
        said += found.verify().tolist()
        held += found.residual.tolist()
    assert_margin(measured, RESIDUAL)
    assert_margin(held, RESIDUAL)
    assert said == pytest.approx(measured, abs=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ARMS)
def test_2_the_generating_configuration_is_among_the_solutions(name, seed):
    """The configuration that made the pose is found, or the family that it is on."""
    robot, q = robot_of(name), configurations(name, seed)
    near = np.array([gaps(robot.chain, robot.ik(robot.fk(x), seed=x).q, x).min() for x in q])
    regular = np.linalg.svd(robot.jacobian(q), compute_uv=False)[:, -1] >= 1e-4
    assert_margin(near[regular], GAP)
    assert_margin(near, 1e-3)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ARMS)
def test_2_no_solution_is_there_twice(name, seed):
    """Any two solutions of a pose differ by more than 1e-6 in some joint."""
    robot = robot_of(name)
    found = robot.ik_batch(by_pinocchio(robot, configurations(name, seed)))
    assert_apart(distances(robot.chain, found), GAP)


EDGES = [
    ("ur5", [0, -math.pi / 2, 0, -math.pi / 2, 0, 0]),
    ("ur5", [0.3, -1.0, 0.0, 0.4, 1.0, 0.2]),
    ("ur5", [0.3, -1.0, 1.2, 0.4, 0.0, 0.2]),
    ("puma560", [0.3, -1.0, 0.2, 0.4, 0.0, 0.2]),
    ("puma560", [0.3, -1.0, 0.2, 0.4, 1e-6, 0.2]),
    ("planar_rrr", [0.3, 0.0, 0.2]),
    ("rpr_new_frame", [0.3, 0.5, 0.0]),
]


@pytest.mark.parametrize(("name", "q"), EDGES)
def test_3_edges_are_exact(name, q):
    """Home, straight elbows and wrists in line: found, at 1e-12, with the generating q."""
    robot = robot_of(name)
    T = robot.fk(q)
    found = robot.ik(T, seed=q, within_limits=False)
    assert len(found) > 0
    assert_margin(found.verify(), RESIDUAL, 1000)
    assert_margin(gaps(robot.chain, found[0], np.array(q)), GAP)


def test_4_families_are_named_and_nearest_to_the_seed():
    """A wrist in line names joints 4 and 6 and returns the member that the seed asks for."""
    robot = robot_of("puma560")
    q = np.array([0.3, 0.5, 0.2, 0.4, 0.0, 0.2])
    T = robot.fk(q)
    free = {f for f in robot.ik(T).free_joints if f}
    assert free == {(3, 5)}
    seeds = q + np.linspace(-1.0, 1.5, 200)[:, None] * np.array([0, 0, 0, 1, 0, -1])
    nearest = np.array([robot.ik(T, seed=seed)[0] for seed in seeds])
    assert_margin(np.abs(nearest - seeds), 1e-9)
    assert_margin([pinocchio_residual(robot, x, T) for x in nearest], RESIDUAL, 1000)


def test_4_a_family_is_entered_within_the_limits():
    """Where the representative is outside the limits, a member inside is returned."""
    table = dh2urdf.load_table("puma560")
    rows = (*table.rows[:5], replace(table.rows[5], lower=-0.5, upper=0.5))
    robot = dh2urdf.Robot.from_dh(replace(table, rows=rows))
    q = np.array([0.3, 0.5, 0.2, 1.7, 0.0, 0.3])
    T = robot.fk(q)
    found = robot.ik(T)
    families = [s for s, f in zip(found, found.free_joints, strict=True) if f]
    assert len(families) == 1
    assert (families[0] >= robot.lower).all()
    assert (families[0] <= robot.upper).all()
    assert families[0][3] + families[0][5] == pytest.approx(2.0)
    assert_margin(pinocchio_residual(robot, families[0], T), RESIDUAL)
    assert np.array_equal(robot.ik_batch(T[None])[0].q, found.q)


@pytest.mark.parametrize("name", ["denso_vs6556", "ur5", "planar_rrr"])
def test_5_out_of_reach_is_empty(name):
    """Far away and 1e-6 m beyond a stretched arm: no solution, no exception."""
    robot = robot_of(name)
    T = np.eye(4)
    T[0, 3] = 100.0
    found = robot.ik(T, within_limits=False)
    assert not found
    assert found.q.shape == (0, robot.n)
    assert len(found.verify()) == 0
    assert "outside the reach" in robot.why_unreachable(T, within_limits=False)


@pytest.mark.parametrize("name", ["ur5", "puma560", "kinova_jaco2"])
@pytest.mark.parametrize("distance", [1e3, 1e9, 1e200, 1e308])
def test_5_out_of_reach_is_explained_at_any_distance(name, distance):
    """A target as far as floats go gives the distance, and no overflow."""
    robot = robot_of(name)
    T = robot.fk(np.zeros(6))
    T[1, 3] = -distance
    assert not robot.ik(T)
    assert "outside the reach" in robot.why_unreachable(T)
    assert f"{distance:.0e}"[-3:] in robot.why_unreachable(T) or distance < 1e4


@pytest.mark.parametrize("within_limits", [True, False])
@pytest.mark.parametrize("name", ["puma560", "ur5", "stanford"])
def test_4_no_sample_of_a_family_is_nearer_to_a_seed(name, within_limits):
    """Walking along the free joints in small steps finds no member nearer than the one returned."""
    robot, rng = robot_of(name), np.random.default_rng(7)
    checked = 0
    for _ in range(6):
        q = robot.random_configuration(rng)
        q[4] = 0.0
        T, seed = robot.fk(q), rng.uniform(-3.0, 3.0, 6)
        found = robot.ik(T, seed=seed, within_limits=within_limits)
        for member, free in zip(found, found.free_joints, strict=True):
            if free != (3, 5):
                continue
            checked += 1
            others = np.repeat(member[None], 4001, axis=0)
            steps = np.linspace(-2 * np.pi, 2 * np.pi, 4001)
            others[:, 3] += steps
            with_sum = others.copy()
            with_sum[:, 5] += steps
            others[:, 5] -= steps
            lines = [x for x in (others, with_sum) if pinocchio_residual(robot, x[99], T) < 1e-9]
            assert len(lines) == 1
            inside = ((lines[0] >= robot.lower) & (lines[0] <= robot.upper)).all(axis=1)
            rivals = lines[0][inside] if within_limits else lines[0]
            nearest = np.linalg.norm(rivals - seed, axis=1).min()
            assert np.linalg.norm(member - seed) <= nearest + 1e-9
    assert checked >= 3 or name == "ur5"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ARMS)
def test_6_solutions_keep_the_limits(name, seed):
    """Every angle is inside its range; without limits there are at least as many solutions."""
    robot = robot_of(name)
    for q in configurations(name, seed, 12):
        T = robot.fk(q)
        kept = robot.ik(T)
        assert (kept.q >= robot.lower).all()
        assert (kept.q <= robot.upper).all()
        assert len(robot.ik(T, within_limits=False)) >= len(kept)


def test_6_the_turn_is_the_one_nearest_to_the_seed():
    """Ranges of two turns: each solution is in the turn nearest to the seed, or in all of them."""
    robot = robot_of("ur5")
    for q in configurations("ur5", 3, 6):
        T = robot.fk(q)
        near = robot.ik(T, seed=q)
        assert (np.abs(near.q - q)[:, [0, 1, 3, 4, 5]] <= 2 * math.pi).all()
        plain = robot.ik(T)
        assert (np.abs(plain.q) <= math.pi + 1e-12).all()
        turned = robot.ik(T, turns="all")
        assert len(turned) > len(plain)
        assert (turned.q >= robot.lower).all()
        assert (turned.q <= robot.upper).all()
        assert_margin(turned.verify(), RESIDUAL)
        again = {tuple(np.round(np.mod(s + 1e-7, 2 * math.pi), 5)) for s in turned.q}
        assert len(again) == len(plain)


def test_7_fewer_than_six_joints_take_the_full_pose_only_when_it_is_feasible():
    """The RPR arm of the notes: the pose of a configuration yes, turned by 1e-6 no."""
    turn = dh2urdf.transforms.rot_x(1e-6)
    for name in ("rpr_new_frame", "rpr_by_inspection"):
        robot = robot_of(name)
        q = np.random.default_rng(0).uniform((-2.0, 0.3, -2.0), (2.0, 0.9, 2.0), (300, 3))
        Ts = robot.fk(q)
        assert_margin(misses(robot.chain, robot.ik_batch(Ts), q), 1e-12)
        assert not robot.ik_batch(Ts @ turn).count.any()


def test_batches_equal_single_calls():
    """One array out, NaN after the last solution, the same numbers as pose by pose."""
    for name in ("denso_vs6556", "rpr_new_frame"):
        robot = robot_of(name)
        q = configurations(name, 5, 40)
        Ts = robot.fk(q)
        done = []
        batch = robot.ik_batch(Ts, threads=2, progress=lambda *state, done=done: done.append(state))
        assert done[-1] == (40, 40)
        assert len(batch) == 40
        for i, T in enumerate(Ts):
            single = robot.ik(T)
            assert batch.count[i] == len(single)
            assert np.array_equal(batch[i].q, single.q)
            assert batch[i].branch == single.branch
            assert np.isnan(batch.q[i, len(single) :]).all()
            assert np.isnan(batch.residual[i, len(single) :]).all()


def test_threads_do_not_change_a_batch():
    """3,000 poses in one thread and in three: the same arrays."""
    robot = robot_of("denso_vs6556")
    Ts = robot.fk(np.random.default_rng(6).uniform(robot.lower, robot.upper, (3000, 6)))
    one, three = robot.ik_batch(Ts, threads=1), robot.ik_batch(Ts, threads=3)
    assert np.array_equal(one.q, three.q, equal_nan=True)
    assert np.array_equal(one.count, three.count)


def test_empty_batch():
    """No poses, no solutions."""
    batch = robot_of("denso_vs6556").ik_batch(np.empty((0, 4, 4)))
    assert len(batch) == 0
    assert batch.q.shape == (0, 8, 6)


def test_results_behave_like_sequences():
    """len, bool, index, slice, iteration, nearest, repr and str."""
    robot = robot_of("denso_vs6556")
    q = np.array([0.1, -1.2, 0.5, 0.3, 0.4, 0.5])
    found = robot.ik(robot.fk(q))
    assert bool(found)
    assert len(list(found)) == len(found) == len(found.branch) == len(found.free_joints)
    assert np.array_equal(found[0], found.q[0])
    assert len(found[1:]) == len(found) - 1
    assert_margin(np.abs(found.nearest(q) - q), 1e-12)
    assert np.array_equal(found.T, robot.fk(q))
    assert "of 6 joints" in repr(found)
    assert str(found).count("residual") == len(found)
    with pytest.raises(ValueError, match="read-only"):
        found.q[0, 0] = 1.0
    assert all("shoulder" in name for name in found.branch)
    with pytest.raises(LookupError):
        robot.ik(dh2urdf.transforms.trans(9, 9, 9)).nearest(q)


def test_a_held_joint_keeps_its_value():
    """locked by index and by name: the value in every solution, the rest solved."""
    robot = robot_of("denso_vs6556")
    q = np.array([0.1, -1.2, 0.5, 0.3, 0.4, 0.5])
    T = robot.fk(q)
    by_index, by_name = robot.ik(T, locked={5: 0.5}), robot.ik(T, locked={"joint_6": 0.5})
    assert np.array_equal(by_index.q, by_name.q)
    assert (by_index.q[:, 5] == 0.5).all()
    assert_margin(np.abs(by_index.q - q).max(axis=1).min(), 1e-9)
    assert not robot.ik(T, locked={5: 0.6})
    qs = np.random.default_rng(7).uniform(robot.lower, robot.upper, (300, 6))
    batch = robot.ik_batch(robot.fk(qs), locked={5: qs[:, 5]})
    assert_margin(misses(robot.chain, batch, qs), 1e-9)


def test_six_digit_poses_are_accepted_and_measured_as_given():
    """Poses typed with six digits are solved; the residual is against those poses."""
    robot = robot_of("denso_vs6556")
    q = np.random.default_rng(8).uniform(0.9 * robot.lower, 0.9 * robot.upper, (400, 6))
    Ts = np.round(robot.fk(q), 6)
    skew = np.abs(Ts[:, :3, :3].swapaxes(1, 2) @ Ts[:, :3, :3] - np.eye(3)).max(axis=(1, 2))
    Ts = Ts[skew < 9e-7]
    found = robot.ik_batch(Ts)
    assert len(Ts) > 200
    assert found.solved.mean() > 0.99
    solutions, owner = rows_of(found)
    away = by_pinocchio(robot, solutions)[:, :3, 3] - Ts[owner, :3, 3]
    assert_margin(np.linalg.norm(away, axis=1), RESIDUAL)


BAD = {
    "shape": (np.eye(3), "shape"),
    "scaled": (np.diag([2.0, 2, 2, 1]), "orthonormal"),
    "nan": (np.full((4, 4), np.nan), "NaN"),
    "infinite": (np.diag([1.0, 1, 1, np.inf]), "infinity"),
    "reflection": (np.diag([1.0, 1, -1, 1]), "reflection"),
    "skewed": (np.eye(4) + 1e-5 * np.eye(4, k=1) * [0, 1, 1, 0], "orthonormal"),
    "last row": (np.eye(4) + 1e-6 * np.eye(4)[[3, 3, 3, 0]].T, "last row"),
    "text": ("pose", "numbers"),
    "many": (np.stack([np.eye(4)] * 2), "ik_batch"),
    "ragged": ([[1, 0], [1]], "numbers"),
    "complex": (np.eye(4) * (1 + 0j), "numbers"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_poses_are_one_clear_exception(case):
    """A pose that is none raises PoseError, whose text says what is wrong."""
    T, message = BAD[case]
    with pytest.raises(PoseError, match=message):
        robot_of("denso_vs6556").ik(T)


def test_a_bad_pose_in_a_batch_is_named():
    """The message says which pose of the batch is bad."""
    Ts = np.stack([np.eye(4)] * 5)
    Ts[3, 0, 0] = 2.0
    with pytest.raises(PoseError, match=r"poses\[3\]"):
        robot_of("denso_vs6556").ik_batch(Ts)


WRONG = {
    "seed": ({"seed": [1, 2]}, ConfigurationError, r"\(6,\)"),
    "seed complex": ({"seed": [1j] * 6}, ConfigurationError, "numbers"),
    "seed nan": ({"seed": [math.nan] * 6}, ConfigurationError, "NaN"),
    "index": ({"locked": {6: 0.0}}, ConfigurationError, "0 to 5"),
    "name": ({"locked": {"joint_7": 0.0}}, NameNotFoundError, "joint_6"),
    "value": ({"locked": {0: "x"}}, ConfigurationError, "number"),
    "outside": ({"locked": {0: 9.0}}, ConfigurationError, "within_limits=False"),
    "all": ({"locked": dict.fromkeys(range(6), 0.0)}, ConfigurationError, "none is left"),
    "twice": ({"locked": {0: 0.0, "joint_1": 0.0}}, ConfigurationError, "twice"),
    "many values": ({"locked": {0: [0.0, 0.1]}}, ConfigurationError, "one pose"),
    "task": ({"task": "wish"}, ConfigurationError, "position"),
    "turns": ({"turns": "some"}, ConfigurationError, "nearest"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_arguments_are_one_clear_exception(case):
    """A wrong seed, held joint, task or turn raises an error that says what is allowed."""
    options, error, message = WRONG[case]
    robot = robot_of("denso_vs6556")
    with pytest.raises(error, match=message):
        robot.ik(robot.fk(np.zeros(6)), **options)


def test_poses_come_in_every_dress():
    """Lists, Fortran order, float32 and pin.SE3 give the same solutions."""
    import pinocchio as pin

    robot = robot_of("denso_vs6556")
    T = robot.fk([0.1, -1.2, 0.5, 0.3, 0.4, 0.5])
    expected = robot.ik(T).q
    for dress in (T.tolist(), np.asfortranarray(T), pin.SE3(T)):
        assert_margin(np.abs(robot.ik(dress).q - expected), 1e-12)
    assert len(robot.ik_batch([pin.SE3(T), pin.SE3(T)])) == 2
    assert len(robot.ik_batch(T)) == 1
    assert robot_of("planar_rr").ik([1.0, 0.5, 0.0], task="position").q.shape == (2, 2)


def test_the_target_is_kept_as_it_was():
    """Writing to the caller's array afterwards does not change the result."""
    robot = robot_of("denso_vs6556")
    T = robot.fk([0.1, -1.2, 0.5, 0.3, 0.4, 0.5])
    found = robot.ik(T)
    T[:] = 0.0
    assert_margin(found.verify(), RESIDUAL, 1000)


def table_robot(*rows):
    """A robot of standard rows (a, alpha, d), all revolute."""
    made = tuple(dh2urdf.DHRow(a=a, alpha=alpha, d=d) for a, alpha, d in rows)
    return dh2urdf.Robot.from_dh(dh2urdf.DHTable(made, "standard"))


@pytest.mark.parametrize("poses", REACHED)
@pytest.mark.parametrize("gap", [0.0, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5])
def test_3_an_axis_5_parallel_to_the_first_three_leaves_solutions(gap, poses):
    """Four parallel axes are a linkage that moves: a member is returned, the joints named."""
    half = math.pi / 2
    robot = table_robot(
        (0.4, 0, 0), (0.3, 0, 0), (0.1, half, 0), (0, -half, 0.1), (0, half, 0.1), (0, 0, 0.1)
    )
    free = check_reached(robot, 3, gap, True, poses)
    assert sum((0, 1, 2, 4) in joints for joints in free) > 0.75 * poses or gap > 0.0


@pytest.mark.parametrize("poses", REACHED)
@pytest.mark.parametrize("gap", [0.0, 1e-12, 1e-9, 1e-8])
def test_3_a_slide_that_puts_the_wrist_on_axis_2_leaves_solutions(gap, poses):
    """The Stanford arm with d3 = 0: joint 2 is free, and the seed is a member of its family."""
    check_reached(robot_of("stanford"), 2, gap, False, poses)


def check_reached(robot, joint, value, within_limits, poses):
    """All poses with a joint at a value are reached; the free joints at each of them."""
    plain, seeded, free = [], [], []
    for q in np.random.default_rng(1).uniform(-3.0, 3.0, (poses, 6)):
        q[joint] = value
        T = robot.fk(q)
        plain += robot.ik(T, within_limits=within_limits).verify().tolist()
        found = robot.ik(T, seed=q, within_limits=within_limits)
        assert len(found) > 0
        seeded += found.verify().tolist()
        free.append(found.free_joints)
    assert_margin(plain, RESIDUAL)
    # Along what hardly moves the tool a member goes towards the seed as far as the contract lets.
    assert_margin(seeded, RESIDUAL, 1)
    return free


def test_3_a_tool_on_axis_2_is_reached():
    """A planar arm whose second link has no length turns its tool on the spot."""
    robot = table_robot((0.4, 0, 0), (0, 0, 0))
    q = np.array([0.3, 0.5])
    assert_margin(np.abs(robot.ik(robot.fk(q))[0] - q), 1e-9)
    assert robot.ik(robot.fk(q), task="position+axis").free_joints == ((1,),)


def test_4_a_family_is_returned_once_with_a_seed():
    """Two representatives that slide to the same member are one solution."""
    robot = robot_of("ur5")
    q = np.array([0.3, 0.5, 0.0, 0.7, 0.0, 0.2])
    found = robot.ik(robot.fk(q), seed=q, within_limits=False)
    apart = np.abs(found.q[:, None] - found.q[None]).max(axis=2) + np.eye(len(found))
    assert_apart(apart, GAP)


def test_7_a_task_that_no_joint_serves_is_refused():
    """Where no joint moves the point that is asked for, the error says so."""
    with pytest.raises(NoSolverError, match="no joint moves what task position asks for"):
        table_robot((0, 1.5, 0)).ik([0, 0, 0], task="position")
