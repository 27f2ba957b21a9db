"""One robot and many threads: every public method answers as it does alone."""

import pickle
import sys
import threading
from functools import partial
from time import monotonic

import numpy as np
import pytest
from dh_product import dh_frames, difference

from dh2urdf import Robot

THREADS = 8

LOCKED = {
    "puma560": [{}],
    "fanuc_crx10ia": [{}],
    "planar_rrr": [{}],
    "franka_fer": [{}, {0: 0.3}, *({2: 0.01 * k} for k in range(80))],
    "kinova_gen3": [{}, {5: 0.4}],
}
"""What is held of each arm: joints of franka_fer at more values than are kept ready."""


@pytest.fixture
def _restless():
    """Threads that change as often as Python lets them."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(interval)


def crowd(work, seconds=1.0):
    """Run ``work(rng)`` again and again in many threads; raise what the first of them raises."""
    end, failures = monotonic() + seconds, []

    def run(seed):
        rng = np.random.default_rng(seed)
        try:
            while monotonic() < end and not failures:
                work(rng)
        except BaseException as failure:
            failures.append(failure)

    threads = [threading.Thread(target=run, args=(seed,)) for seed in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]


def flat(answer):
    """The numbers and words of an answer, for comparison."""
    if isinstance(answer, (str, tuple)):
        return repr(answer)
    parts = getattr(answer, "q", answer), getattr(answer, "residual", 0.0)
    return tuple(np.asarray(part).tobytes() for part in parts)


def calls(robot, locked, seed):
    """Every public method that computes, by name, at one random configuration."""
    rng = np.random.default_rng(seed)
    q = robot.random_configuration(rng)
    if locked:
        joint, value = next(iter(locked.items()))
        q[joint] = value
    T, name = robot.fk(q), "locked" if locked else "free"
    Ts = np.stack([T] * 3)
    held = {"locked": locked or None}
    jobs = {
        f"{name} ik": lambda r: r.ik(T, **held),
        f"{name} ik seed": lambda r: r.ik(T, seed=q, **held),
        f"{name} ik turns": lambda r: r.ik(T, within_limits=False, turns="all", **held),
        f"{name} ik_batch": lambda r: r.ik_batch(Ts, threads=2, **held),
        f"{name} verify": lambda r: r.ik(T, within_limits=False, **held).verify(),
        f"{name} pickle": lambda r: pickle.loads(pickle.dumps(r.ik(T, **held))),
        f"{name} solver_for": lambda r: str(r.solver_for(**held)),
    }
    if locked:
        return jobs
    far = T.copy()
    far[:3, 3] += 50.0
    return jobs | {
        "fk": lambda r: r.fk(q),
        "fk of many": lambda r: r.fk(np.stack([q, q])),
        "jacobian": lambda r: r.jacobian(q),
        "frames": lambda r: r.frames(q),
        "model_configuration": lambda r: r.model_configuration(q),
        "chain_configuration": lambda r: r.chain_configuration(q),
        "random_configuration": lambda r: r.random_configuration(seed),
        "ik position": lambda r: r.ik(T, task="position") if r.n < 5 else r.fk(q),
        "ik_path": lambda r: r.ik_path(Ts, start=q),
        "ik_numeric": lambda r: r.ik_numeric(T, seed=q, starts=3),
        "why_unreachable": lambda r: r.why_unreachable(far),
        "solver": lambda r: (str(r.solver), r.solver.explain()),
        "pickle": lambda r: pickle.loads(pickle.dumps(r)).fk(q),
    }


@pytest.mark.usefixtures("_restless")
@pytest.mark.parametrize("seconds", [2.0, pytest.param(120.0, marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize("name", LOCKED)
def test_every_method_answers_in_many_threads_as_it_does_alone(name, seconds):
    """One fresh robot, all its methods at once in eight threads: to the bit the answers of one."""
    alone = Robot.from_dh(name)
    jobs = [
        (what, call, flat(call(alone)))
        for seed, locked in enumerate([{}, {}, *LOCKED[name]])
        for what, call in calls(alone, locked, seed).items()
    ]
    shared = Robot.from_dh(name)

    def work(rng):
        for k in rng.permutation(len(jobs))[:20]:
            what, call, expected = jobs[k]
            assert flat(call(shared)) == expected, what

    crowd(work, seconds)


@pytest.mark.usefixtures("_restless")
@pytest.mark.parametrize("name", ["kinova_gen3", "franka_fer"])
def test_one_call_at_many_values_keeps_its_memory_from_other_threads(name):
    """Swept joints make many poses of one, in memory that is the call's alone while it runs."""
    robot = Robot.from_dh(name)
    rng = np.random.default_rng(0)
    seeds = [robot.random_configuration(rng) for _ in range(4)]
    jobs = [(robot.fk(q), {"seed": q}) for q in seeds] + [(robot.fk(q), {}) for q in seeds]
    alone = [flat(robot.ik(T, **given)) for T, given in jobs]

    def work(rng):
        for k in rng.permutation(len(jobs)):
            T, given = jobs[k]
            assert flat(robot.ik(T, **given)) == alone[k], f"pose {k}, {list(given)}"

    crowd(work)


@pytest.mark.usefixtures("_restless")
@pytest.mark.parametrize("name", ["ur5", "gantry_wrist"])
def test_poses_and_jacobians_of_single_configurations_keep_to_their_thread(name):
    """fk is the DH product and the Jacobian that of the kernel, however many threads ask."""
    robot = Robot.from_dh(name)
    rng = np.random.default_rng(0)
    q = np.array([robot.random_configuration(rng) for _ in range(50)])
    poses = [dh_frames(robot.table, row)[-1] for row in q]
    jacobians = robot.jacobian(q)

    def work(rng):
        for k in rng.integers(0, len(q), 50):
            assert difference(robot.fk(q[k]), poses[k]) < 1e-12
            assert difference(robot.jacobian(q[k]), jacobians[k]) < 1e-12

    crowd(work)


@pytest.mark.usefixtures("_restless")
def test_intervals_are_those_of_one_thread():
    """The intervals of a swept joint are found side by side with other work."""
    robot = Robot.from_dh("franka_fer")
    T = robot.fk([0.2, 0.3, -0.4, -1.5, 0.6, 1.7, 0.8])
    expected, numbers = robot.ik_intervals(T), partial(robot.ik, T)
    q = numbers().q.copy()

    def work(rng):
        assert np.array_equal(robot.ik_intervals(T), expected)
        assert np.array_equal(numbers().q, q)

    crowd(work)
