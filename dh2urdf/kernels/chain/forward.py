"""Forward kinematics and Jacobian of a serial chain, one configuration and many.

The chain is ``T = links[0] Z_1(q_1) links[1] ... Z_n(q_n) links[n]`` with ``Z_i = Rot_z(q_i)``,
or ``Trans_z(q_i)`` where ``prismatic[i]``.
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.chain.lanes import BLOCK, ROWS, lanes_fk
from dh2urdf.kernels.numbers import entry, few_turns, sincos
from dh2urdf.kernels.shapes import Flags, Floats, Links, Pose, Poses


def _slid(a, b, c, d, q):
    """One row of ``R Trans_z(q)``."""
    return a, b, c, d + c * q


def _turned(a, b, c, d, cosine, sine):
    """One row of ``R Rot_z``."""
    return a * cosine + b * sine, b * cosine - a * sine, c, d


def times_joint(r, slides, q):
    """``R Z(q)`` of a pose held in twelve scalars (rows of the 3 x 4 matrix)."""
    a0, b0, c0, d0, a1, b1, c1, d1, a2, b2, c2, d2 = r
    if slides:
        return *_slid(a0, b0, c0, d0, q), *_slid(a1, b1, c1, d1, q), *_slid(a2, b2, c2, d2, q)
    s, c = sincos(few_turns(q))
    first, second = _turned(a0, b0, c0, d0, c, s), _turned(a1, b1, c1, d1, c, s)
    return *first, *second, *_turned(a2, b2, c2, d2, c, s)


def _row_times_link(a, b, c, d, link):
    """One row of ``R link``."""
    return (
        a * link[0, 0] + b * link[1, 0] + c * link[2, 0],
        a * link[0, 1] + b * link[1, 1] + c * link[2, 1],
        a * link[0, 2] + b * link[1, 2] + c * link[2, 2],
        a * link[0, 3] + b * link[1, 3] + c * link[2, 3] + d,
    )


def times_link(r, link):
    """``R link`` of a pose held in twelve scalars."""
    first = _row_times_link(r[0], r[1], r[2], r[3], link)
    second = _row_times_link(r[4], r[5], r[6], r[7], link)
    return *first, *second, *_row_times_link(r[8], r[9], r[10], r[11], link)


def joint_times_link(r, slides, q, link):
    """``R Z(q) link`` of a pose held in twelve scalars."""
    return times_link(times_joint(r, slides, q), link)


def load_pose(link):
    """The twelve scalars of a pose."""
    x, y, z = link[0], link[1], link[2]
    return x[0], x[1], x[2], x[3], y[0], y[1], y[2], y[3], z[0], z[1], z[2], z[3]


def store_pose(r, T):
    """Write twelve scalars as a homogeneous matrix."""
    T[0, 0], T[0, 1], T[0, 2], T[0, 3] = r[0], r[1], r[2], r[3]
    T[1, 0], T[1, 1], T[1, 2], T[1, 3] = r[4], r[5], r[6], r[7]
    T[2, 0], T[2, 1], T[2, 2], T[2, 3] = r[8], r[9], r[10], r[11]
    T[3, 0], T[3, 1], T[3, 2], T[3, 3] = 0.0, 0.0, 0.0, 1.0


def applied(A, v):
    """The point ``A v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[0, 1] * y + A[0, 2] * z + A[0, 3],
        A[1, 0] * x + A[1, 1] * y + A[1, 2] * z + A[1, 3],
        A[2, 0] * x + A[2, 1] * y + A[2, 2] * z + A[2, 3],
    )


def applied_inverse(A, v):
    """The point ``A^-1 v``."""
    return turned_back(A, (v[0] - A[0, 3], v[1] - A[1, 3], v[2] - A[2, 3]))


def turned(A, v):
    """The direction ``A v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[0, 1] * y + A[0, 2] * z,
        A[1, 0] * x + A[1, 1] * y + A[1, 2] * z,
        A[2, 0] * x + A[2, 1] * y + A[2, 2] * z,
    )


def turned_back(A, v):
    """The direction ``A^-1 v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[1, 0] * y + A[2, 0] * z,
        A[0, 1] * x + A[1, 1] * y + A[2, 1] * z,
        A[0, 2] * x + A[1, 2] * y + A[2, 2] * z,
    )


@entry()
def chain_fk(links: Links, prismatic: Annotated[Flags, "n"], q: Annotated[Floats, "n"], T: Pose):
    """``T_base_tool`` of a configuration q (n,), written to T (4, 4).

    Returns whether its x is finite: every joint value is in it, if only times zero.
    """
    r = load_pose(links[0])
    for i in range(q.shape[0]):
        r = joint_times_link(r, prismatic[i], q[i], links[i + 1])
    store_pose(r, T)
    return math.isfinite(r[3])


@entry()
def chain_fk_batch(
    links: Links, prismatic: Annotated[Flags, "n"], q: Annotated[Floats, "poses", "n"], T: Poses
):
    """:func:`chain_fk` of configurations q (m, n), written to T (m, 4, 4), for all of them."""
    m, finite, S = q.shape[0], True, np.empty(ROWS * BLOCK)
    for first in range(0, m, BLOCK):
        finite &= lanes_fk(links, prismatic, q, first, min(BLOCK, m - first), T, S)
    return finite


@entry()
def chain_frames_batch(
    links: Links,
    prismatic: Annotated[Flags, "n"],
    frames: Annotated[Floats, "n + 1", 4, 4],
    q: Annotated[Floats, "poses", "n"],
    T: Annotated[Floats, "poses", "n + 1", 4, 4],
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


def jacobian_rows(chain, q, J):
    """Geometric Jacobian at the tip in base axes, joint i in row i of J (n, 6 or more); the tip.

    Linear before angular: ``(z_i x (p_tip - p_i), z_i)`` revolute, ``(z_i, 0)`` prismatic (Spong,
    eqs. 4.57 to 4.60). The joints' points are kept in J until the tip is known.
    """
    links, joints = chain
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


@entry()
def chain_jacobian(
    links: Links,
    prismatic: Annotated[Flags, "n"],
    q: Annotated[Floats, "n"],
    J: Annotated[Floats, 6, "n"],
):
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
    links: Links,
    prismatic: Annotated[Flags, "n"],
    q: Annotated[Floats, "poses", "n"],
    J: Annotated[Floats, "poses", 6, "n"],
):
    """:func:`chain_jacobian` of configurations q (m, n), written to J (m, 6, n)."""
    for k in range(q.shape[0]):
        chain_jacobian(links, prismatic, q[k], J[k])
