"""The serial chain: forward kinematics and Jacobian, one configuration and many; one joint held.

The chain is ``T = links[0] Z_1(q_1) links[1] ... Z_n(q_n) links[n]`` with ``Z_i = Rot_z(q_i)``,
or ``Trans_z(q_i)`` where ``prismatic[i]``.

Many configurations are worked out in blocks of up to ``BLOCK``, one a lane. The pose of a lane is
twelve entries of one flat array, entry e of lane i at ``S[BLOCK * e + i]``.

A held joint k disappears into one link, ``links[k] Z_k(v) links[k + 1]``; where it is the first or
the last of the chain, into the pose, and the rest is the same arm for every value.
"""

import math
from typing import Annotated, TypeAlias

import numpy as np

from dh2urdf.kernels.counts import how_many
from dh2urdf.kernels.numbers import entry, few_turns, side_by_side, sincos
from dh2urdf.kernels.rigid import (
    inverse_pose,
    joint_times_link,
    load_pose,
    store_pose,
    times_joint,
    times_link,
)
from dh2urdf.kernels.shapes import (
    Codes,
    Configuration,
    Configurations,
    Counts,
    Floats,
    Held,
    Links,
    Pose,
    Poses,
    Slides,
    Solutions,
)

BLOCK = 64
COS, SIN, ROWS = 12, 13, 14
"""Rows of S beyond the pose, and their number."""

IDENTITY = np.eye(4)

Frames: TypeAlias = Annotated[Floats, "poses", "n + 1", 4, 4]
Whole: TypeAlias = Annotated[Floats, "poses", "solutions", "n + 1"]


def start_lanes(link, n, S):
    """All lanes at a link's pose."""
    for r in range(3):
        for c in range(4):
            value = link[r, c]
            for i in side_by_side(n):
                S[BLOCK * (4 * r + c) + i] = value


def _turn_and_step(link, n, S):
    """``T Rot_z(q) link`` in all lanes."""
    a00, a01, a02, a03 = link[0, 0], link[0, 1], link[0, 2], link[0, 3]
    a10, a11, a12, a13 = link[1, 0], link[1, 1], link[1, 2], link[1, 3]
    a20, a21, a22, a23 = link[2, 0], link[2, 1], link[2, 2], link[2, 3]
    for i in side_by_side(n):
        c, s = S[BLOCK * COS + i], S[BLOCK * SIN + i]
        for r in range(3):
            u, v = S[BLOCK * 4 * r + i], S[BLOCK * (4 * r + 1) + i]
            z, p = S[BLOCK * (4 * r + 2) + i], S[BLOCK * (4 * r + 3) + i]
            x, y = u * c + v * s, v * c - u * s
            S[BLOCK * 4 * r + i] = x * a00 + y * a10 + z * a20
            S[BLOCK * (4 * r + 1) + i] = x * a01 + y * a11 + z * a21
            S[BLOCK * (4 * r + 2) + i] = x * a02 + y * a12 + z * a22
            S[BLOCK * (4 * r + 3) + i] = x * a03 + y * a13 + z * a23 + p


def _slide(n, S):
    """``T Trans_z(q)`` in all lanes, q where its cosine is to be: as of no turn."""
    for i in side_by_side(n):
        for r in range(3):
            S[BLOCK * (4 * r + 3) + i] += S[BLOCK * (4 * r + 2) + i] * S[BLOCK * COS + i]
        S[BLOCK * COS + i], S[BLOCK * SIN + i] = 1.0, 0.0


def move_lanes(slides, link, n, S):
    """``T Z(q) link`` in all lanes, the joint's values where their cosines are to be."""
    if slides:
        _slide(n, S)
    else:
        for i in side_by_side(n):
            S[BLOCK * SIN + i], S[BLOCK * COS + i] = sincos(S[BLOCK * COS + i])
    _turn_and_step(link, n, S)


def lanes_fk(links, prismatic, q, first, n, T, S):
    """``T_base_tool`` of n configurations of q (m, joints) from the first on, to T (m, 4, 4).

    S is room for ROWS * BLOCK numbers. Returns whether all x of the tip are finite.
    """
    start_lanes(links[0], n, S)
    for j in range(q.shape[1]):
        for i in range(n):
            value = q[first + i, j]
            S[BLOCK * COS + i] = value if prismatic[j] else few_turns(value)
        move_lanes(prismatic[j], links[j + 1], n, S)
    finite = True
    for i in range(n):
        k = first + i
        for r in range(3):
            for c in range(4):
                T[k, r, c] = S[BLOCK * (4 * r + c) + i]
        T[k, 3, 0], T[k, 3, 1], T[k, 3, 2], T[k, 3, 3] = 0.0, 0.0, 0.0, 1.0
        finite &= math.isfinite(T[k, 0, 3])
    return finite


@entry()
def chain_fk(links: Links, prismatic: Slides, q: Configuration, T: Pose):
    """``T_base_tool`` of a configuration q (n,), written to T (4, 4).

    Returns whether its x is finite: every joint value is in it, if only times zero.
    """
    r = load_pose(links[0])
    for i in range(q.shape[0]):
        r = joint_times_link(r, prismatic[i], q[i], links[i + 1])
    store_pose(r, T)
    return math.isfinite(r[3])


@entry()
def chain_fk_batch(links: Links, prismatic: Slides, q: Configurations, T: Poses):
    """:func:`chain_fk` of configurations q (m, n), written to T (m, 4, 4), for all of them."""
    m, finite, S = q.shape[0], True, np.empty(ROWS * BLOCK)
    for first in range(0, m, BLOCK):
        finite &= lanes_fk(links, prismatic, q, first, min(BLOCK, m - first), T, S)
    return finite


@entry()
def chain_frames_batch(
    links: Links, prismatic: Slides, frames: Links, q: Configurations, T: Frames
):
    """Frames carried by the joints of configurations q (m, n), written to T (m, n + 1, 4, 4).

    ``T[:, 0] = frames[0]`` in base; ``T[:, i] = (pose after Z_i) frames[i]``.
    """
    for k in range(q.shape[0]):
        store_pose(load_pose(frames[0]), T[k, 0])
        r = load_pose(links[0])
        for i in range(q.shape[1]):
            r = times_joint(r, prismatic[i], q[k, i])
            store_pose(times_link(r, frames[i + 1]), T[k, i + 1])
            r = times_link(r, links[i + 1])


def chain_pose(chain, q):
    """The tip of a configuration q (n,), of an `AnyChain`."""
    links, joints = chain
    r = load_pose(links[0])
    if joints.shape[0] == q.shape[0]:
        for i in range(q.shape[0]):
            r = joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    else:
        for i in range(links.shape[0] - 1):
            k = q.shape[0] + i
            value = joints[k, 1] * q[int(joints[k, 0])]
            r = joint_times_link(r, joints[k, 2] != 0.0, value, links[i + 1])
    return r


def jacobian_rows(chain, q, J):
    """Geometric Jacobian at the tip in base axes, joint i in row i of J (n, 6 or more); the tip.

    Linear before angular: ``(z_i x (p_tip - p_i), z_i)`` revolute, ``(z_i, 0)`` prismatic (Spong,
    eqs. 4.57 to 4.60). The joints' points are kept in J until the tip is known. Where joints follow
    values, the row of a value is the sum over its joints.
    """
    links, joints = chain
    if joints.shape[0] != q.shape[0]:
        return _rows_of_values(links, joints, q, J)
    r = load_pose(links[0])
    for i in range(q.shape[0]):
        J[i, 0], J[i, 1], J[i, 2] = r[3], r[7], r[11]
        J[i, 3], J[i, 4], J[i, 5] = r[2], r[6], r[10]
        r = joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    for i in range(q.shape[0]):
        zx, zy, zz = J[i, 3], J[i, 4], J[i, 5]
        if joints[i, 0] != 0.0:
            J[i, 0], J[i, 1], J[i, 2] = zx, zy, zz
            J[i, 3], J[i, 4], J[i, 5] = 0.0, 0.0, 0.0
        else:
            x, y, z = r[3] - J[i, 0], r[7] - J[i, 1], r[11] - J[i, 2]
            J[i, 0], J[i, 1], J[i, 2] = zy * z - zz * y, zz * x - zx * z, zx * y - zy * x
    return r


def _rows_of_values(links, joints, q, J):
    """:func:`jacobian_rows` where joints follow values: first moments about the base.

    ``f z x (p_tip - p) = f z x p_tip - f z x p``: the first term is one for all joints of a value.
    """
    n = q.shape[0]
    for v in range(n):
        for e in range(6):
            J[v, e] = 0.0
    r = load_pose(links[0])
    for i in range(links.shape[0] - 1):
        at, factor, slides = int(joints[n + i, 0]), joints[n + i, 1], joints[n + i, 2] != 0.0
        zx, zy, zz = factor * r[2], factor * r[6], factor * r[10]
        if slides:
            J[at, 0], J[at, 1], J[at, 2] = J[at, 0] + zx, J[at, 1] + zy, J[at, 2] + zz
        else:
            J[at, 0] -= zy * r[11] - zz * r[7]
            J[at, 1] -= zz * r[3] - zx * r[11]
            J[at, 2] -= zx * r[7] - zy * r[3]
            J[at, 3], J[at, 4], J[at, 5] = J[at, 3] + zx, J[at, 4] + zy, J[at, 5] + zz
        r = joint_times_link(r, slides, factor * q[at], links[i + 1])
    for v in range(n):
        zx, zy, zz = J[v, 3], J[v, 4], J[v, 5]
        J[v, 0] += zy * r[11] - zz * r[7]
        J[v, 1] += zz * r[3] - zx * r[11]
        J[v, 2] += zx * r[7] - zy * r[3]
    return r


@entry()
def chain_jacobian(links: Links, prismatic: Slides, q: Configuration, J: Annotated[Floats, 6, "n"]):
    """:func:`jacobian_rows` of q (n,), as columns to J (6, n), and whether q is finite.

    These are Pinocchio's ``LOCAL_WORLD_ALIGNED``.
    """
    n = q.shape[0]
    rows, joints = np.empty((n, 6)), np.empty((n, 1))
    for i in range(n):
        joints[i, 0] = 1.0 if prismatic[i] else 0.0
    r = jacobian_rows((links, joints), q, rows)
    for i in range(n):
        for e in range(6):
            J[e, i] = rows[i, e]
    return math.isfinite(r[3])


@entry()
def chain_jacobian_batch(
    links: Links, prismatic: Slides, q: Configurations, J: Annotated[Floats, "poses", 6, "n"]
):
    """:func:`chain_jacobian` of configurations q (m, n), written to J (m, 6, n)."""
    for k in range(q.shape[0]):
        chain_jacobian(links, prismatic, q[k], J[k])


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


@entry()
def held_poses(
    links: Annotated[Floats, "n", 4, 4], slides: bool, k: int, values: Held, Ts: Poses, out: Poses
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
    k: int, values: Held, found: Solutions, free_found: Codes, q: Whole, count: Counts, free: Codes
):
    """:func:`insert_held` for a batch."""
    for i in range(q.shape[0]):
        free[i] = free_found[i]
        insert_held(k, values[i], found[i], q[i], free[i], how_many(count[i]))
