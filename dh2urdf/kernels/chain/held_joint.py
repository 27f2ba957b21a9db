"""One joint of a chain held at a value: the links, the pose and the configurations of the rest.

The held joint k disappears into one link, ``links[k] Z_k(v) links[k + 1]``; where it is the first
or the last of the chain, into the pose, and the rest is the same arm for every value.
"""

from typing import Annotated

import numpy as np

from dh2urdf.kernels.chain.forward import (
    applied_inverse,
    joint_times_link,
    load_pose,
    store_pose,
    times_joint,
    times_link,
)
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import Codes, Counts, Floats, Integers, Poses

IDENTITY = np.eye(4)


def held_links(links, slides, k, value, out):
    """Links (n, 4, 4) of the chain without joint k, from those with it, (n + 1, 4, 4)."""
    for i in range(links.shape[0] - 1):
        out[i] = links[i if i < k else i + 1]
    store_pose(joint_times_link(load_pose(links[k]), slides, value, links[k + 1]), out[k])


def held_pose(links, slides, k, value, T, out):
    """The pose that the chain without its first (k = 0) or last joint has to reach.

    ``Z_1(v)^-1 links[0]^-1 T`` of the chain from ``links[1]`` on, or ``T links[n]^-1 Z_n(v)^-1``
    of the chain up to ``links[n - 1]``.
    """
    if k == 0:
        store_pose(times_link(inverse_pose(links[0]), T), out)
        store_pose(joint_times_link(load_pose(IDENTITY), slides, -value, out), out)
    else:
        store_pose(inverse_pose(links[links.shape[0] - 1]), out)
        store_pose(times_joint(times_link(load_pose(T), out), slides, -value), out)


def inverse_pose(A):
    """The twelve scalars of ``A^-1`` for a rigid pose (4, 4)."""
    x, y, z = applied_inverse(A, (0.0, 0.0, 0.0))
    a, b, c = A[0], A[1], A[2]
    return a[0], b[0], c[0], x, a[1], b[1], c[1], y, a[2], b[2], c[2], z


@entry()
def held_poses(
    links: Annotated[Floats, "links", 4, 4],
    slides: bool,
    k: int,
    values: Annotated[Floats, "poses"],
    Ts: Poses,
    out: Poses,
):
    """:func:`held_pose` for poses Ts (m, 4, 4), each with its value."""
    for i in range(Ts.shape[0]):
        held_pose(links, slides, k, values[i], Ts[i], out[i])


def insert_held(k, value, found, q, free, count):
    """Solutions of the rest, found (kmax, n - 1), with joint k in its place, to q (kmax, n)."""
    low = (1 << k) - 1
    for r in range(count):
        for j in range(q.shape[1]):
            q[r, j] = value if j == k else found[r, j if j < k else j - 1]
        free[r] = (free[r] & low) | ((free[r] & ~low) << 1)


@entry()
def insert_held_batch(
    k: int,
    values: Annotated[Floats, "poses"],
    found: Annotated[Floats, "poses", "solutions", "n"],
    free_found: Annotated[Integers, "poses", "solutions"],
    q: Annotated[Floats, "poses", "solutions", "n + 1"],
    count: Counts,
    free: Codes,
):
    """:func:`insert_held` for a batch."""
    for i in range(q.shape[0]):
        for r in range(count[i]):
            free[i, r] = free_found[i, r]
        insert_held(k, values[i], found[i], q[i], free[i], count[i])
