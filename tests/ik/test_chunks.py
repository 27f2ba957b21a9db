"""A batch in chunks on threads that stay: each pose once, errors and progress where they belong."""

import os
import threading
import time

import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.problem import chunks

ARM = Robot.from_dh("puma560")


def poses(m, seed=0):
    q = np.random.default_rng(seed).uniform(ARM.lower, ARM.upper, (m, 6))
    return ARM.fk(q)


@pytest.mark.parametrize("threads", [1, 2, 5, None])
@pytest.mark.parametrize("m", [0, 1, 63, 64, 65, 129, 700, 5000])
@pytest.mark.parametrize("pause", [0.0, 1e-3])
def test_each_pose_is_worked_on_once(m, threads, pause):
    """By whatever thread, quick or slow; progress is told here, grows and ends with all."""
    times, told, here = np.zeros(m, int), [], threading.current_thread()

    def work(rows):
        times[rows] += 1
        time.sleep(pause)

    def tell(done):
        assert threading.current_thread() is here
        told.append(done)

    chunks.in_chunks(work, m, threads, tell)
    assert (times == 1).all()
    assert told == sorted(told)
    assert told[-1:] == [m][:m]


def test_slow_work_is_shared_and_quick_work_is_not():
    """A thread is woken where it is worth it."""
    seen = set()

    def slowly(rows):
        seen.add(threading.current_thread())
        time.sleep(0.002)

    chunks.in_chunks(slowly, 2000, 3, lambda done: None)
    assert len(seen) == 3
    seen.clear()
    chunks.in_chunks(lambda rows: seen.add(threading.current_thread()), 2000, 3, lambda done: None)
    assert seen == {threading.current_thread()}


@pytest.mark.parametrize("where", ["here", "there"])
def test_an_error_of_any_thread_is_raised_and_ends_the_work(where):
    """No chunk is begun after it, and the next batch is solved as ever."""
    here, count = threading.current_thread(), []

    def work(rows):
        count.append(rows)
        time.sleep(0.001)
        if rows.start and (threading.current_thread() is here) == (where == "here"):
            raise KeyError("broken")

    with pytest.raises(KeyError, match="broken"):
        chunks.in_chunks(work, 100_000, 2, lambda done: None)
    assert len(count) < 20
    assert ARM.ik_batch(poses(3000)).count.sum() > 3000


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_a_forked_process_has_a_pool_of_its_own():
    """Threads do not survive in the child."""
    chunks.in_chunks(lambda rows: time.sleep(0.001), 1000, 2, lambda done: None)
    assert chunks._pool
    child = os.fork()
    if child == 0:
        done = []
        try:
            chunks.in_chunks(lambda rows: time.sleep(0.001), 1000, 2, done.append)
        finally:
            os._exit(0 if done[-1:] == [1000] else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_a_batch_fills_the_arrays_of_an_earlier_one():
    """The same answer in the same memory, whatever was in it; in stacks of any shape."""
    first, second = poses(900, 1), poses(900, 2)
    want, earlier = ARM.ik_batch(second), ARM.ik_batch(first.reshape(30, 30, 4, 4))
    memory = earlier.q
    again = ARM.ik_batch(second, out=earlier)
    for name in ("q", "residual", "count", "branch_code", "free_mask"):
        np.testing.assert_array_equal(getattr(again, name), getattr(want, name))
    assert np.shares_memory(again.q, memory)


@pytest.mark.parametrize("what", ["other poses", "a part", "another arm", "no batch"])
def test_an_earlier_batch_that_does_not_fit_is_refused(what):
    """Nothing is written to it."""
    batch = ARM.ik_batch(poses(100))
    batch = {
        "other poses": batch[:50],
        "a part": ARM.ik_batch(poses(200))[::2],
        "another arm": Robot.from_dh("planar_rr").ik_batch(np.tile(np.eye(4), (100, 1, 1))),
        "no batch": batch.q,
    }[what]
    before = np.copy(getattr(batch, "q", batch))
    with pytest.raises(ArgumentError, match=r"^out: expected"):
        ARM.ik_batch(poses(100, 3), out=batch)
    np.testing.assert_array_equal(getattr(batch, "q", batch), before)
