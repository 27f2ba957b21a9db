"""One joint of a chain held at a value: the links, the pose and the configurations of the rest.

The held joint k disappears into one link, ``links[k] Z_k(v) links[k + 1]``; where it is the first
or the last of the chain, into the pose, and the rest is the same arm for every value.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.chain.forward import joint_times_link, load_pose, store_pose
from dh2urdf.kernels.numbers import inner_kernel, kernel

__all__ = ["held_links", "held_pose", "held_poses", "insert_held", "insert_held_batch"]


@inner_kernel
def held_links(links, slides, k, value, out):
    """Links (n, 4, 4) of the chain without joint k, from those with it, (n + 1, 4, 4)."""
    n = out.shape[0]
    for i in range(n):
        source = i if i < k else i + 1
        for a in range(4):
            for b in range(4):
                out[i, a, b] = links[source, a, b]
    store_pose(joint_times_link(load_pose(links[k]), slides, value, links[k + 1]), out[k])


@inner_kernel
def held_pose(links, slides, k, value, T, out):
    """The pose that the chain without its first (k = 0) or last joint has to reach.

    ``Z_1(v)^-1 links[0]^-1 T`` of the chain from ``links[1]`` on, or ``T links[n]^-1 Z_n(v)^-1``
    of the chain up to ``links[n - 1]``.
    """
    end = links[0] if k == 0 else links[links.shape[0] - 1]
    c, s, slide = (1.0, 0.0, -value) if slides else (math.cos(value), -math.sin(value), 0.0)
    if k == 0:
        for j in range(4):
            x, y, z = 0.0, 0.0, 0.0
            for i in range(3):
                t = T[i, j] - end[i, 3] if j == 3 else T[i, j]
                x += end[i, 0] * t
                y += end[i, 1] * t
                z += end[i, 2] * t
            out[0, j], out[1, j] = c * x - s * y, s * x + c * y
            out[2, j] = z + slide if j == 3 else z
    else:
        for i in range(3):
            x = T[i, 0] * end[0, 0] + T[i, 1] * end[0, 1] + T[i, 2] * end[0, 2]
            y = T[i, 0] * end[1, 0] + T[i, 1] * end[1, 1] + T[i, 2] * end[1, 2]
            z = T[i, 0] * end[2, 0] + T[i, 1] * end[2, 1] + T[i, 2] * end[2, 2]
            out[i, 0], out[i, 1], out[i, 2] = c * x + s * y, c * y - s * x, z
            t = T[i, 3] - x * end[0, 3] - y * end[1, 3] - z * end[2, 3]
            out[i, 3] = t + z * slide
    out[3, 0], out[3, 1], out[3, 2], out[3, 3] = 0.0, 0.0, 0.0, 1.0


@kernel
def held_poses(links, slides, k, values, Ts, out):
    """:func:`held_pose` for poses Ts (m, 4, 4), each with its value."""
    for i in range(Ts.shape[0]):
        held_pose(links, slides, k, values[i], Ts[i], out[i])


@inner_kernel
def insert_held(k, value, q, free, count):
    """Make room for joint k in the first ``count`` rows of q (kmax, n), in place."""
    n = q.shape[1]
    low = (1 << k) - 1
    for r in range(count):
        for j in range(n - 1, k, -1):
            q[r, j] = q[r, j - 1]
        q[r, k] = value
        free[r] = (free[r] & low) | ((free[r] & ~low) << 1)


@kernel
def insert_held_batch(k, values, found, free_found, q, count, free):
    """Solutions of the rest, found (m, kmax, n - 1), with joint k in its place, to q."""
    n = q.shape[2]
    for i in range(q.shape[0]):
        for r in range(count[i]):
            for j in range(n - 1):
                q[i, r, j] = found[i, r, j]
            free[i, r] = free_found[i, r]
        insert_held(k, values[i], q[i], free[i], count[i])
