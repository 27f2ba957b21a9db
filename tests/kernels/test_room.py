"""Kernels run on the stack that a thread has, whatever the number of poses."""

import re
import threading

import numpy as np
import pytest
from ik_referee import shipped

from dh2urdf.kernels.certificate import measure_and_sort
from dh2urdf.kernels.redundant import shorten
from tests.translate import replay

MANY = 20_000


def sort(chain, T):
    """Sort many solutions by their distance from a seed."""
    codes = np.zeros((2, MANY), int)
    q, room = np.zeros((MANY, chain.n)), np.empty((2, MANY))
    measure_and_sort(chain.tables, 0, T, np.ones(chain.n), (q, room[0], *codes), room[1])
    return q


def straighten(chain, T):
    """Shorten a path of many poses, all the same."""
    q = np.full((MANY, chain.n), 0.5)
    room = np.empty((2, *q.shape)), np.empty((8, MANY))
    Ts, start = np.repeat(T[None], MANY, axis=0), np.empty((0, chain.n))
    shorten(chain.tables, Ts, chain.size, start, 1.0, 1e9, q, *room)
    return q


@pytest.mark.parametrize("work", [sort, straighten])
def test_many_poses_take_no_more_stack(work):
    """A thread of half a megabyte is enough for 20,000 poses or solutions."""
    chain, done = shipped("kuka_iiwa7"), []
    T = chain.fk(np.full(chain.n, 0.5))
    before = threading.stack_size(512 * 1024)
    try:
        thread = threading.Thread(target=lambda: done.append(work(chain, T)))
        thread.start()
    finally:
        threading.stack_size(before)
    thread.join()
    assert np.isfinite(done[0]).all()


def test_only_the_joints_size_arrays():
    """No array that a kernel makes grows with anything but the number of joints, at most 60."""
    made = re.findall(r"^ +(?:double|int64_t|bool) \w+((?:\[.+\])+);", replay.text(), re.M)
    assert len(made) > 50
    assert {name for sizes in made for name in re.findall(r"\b[a-z]\w*", sizes)} == {"n", "values"}
