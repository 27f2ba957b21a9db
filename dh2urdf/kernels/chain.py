"""Forward kinematics and Jacobian of a serial chain, one configuration and many.

The chain is ``T = links[0] Z_1(q_1) links[1] ... Z_n(q_n) links[n]`` with ``Z_i = Rot_z(q_i)``,
or ``Trans_z(q_i)`` where ``prismatic[i]``.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from dh2urdf.kernels.chain_lanes import BLOCK, ROWS, fits, lanes_fk
from dh2urdf.kernels.compiled import helper_kernel

__all__ = ["chain_fk", "chain_fk_batch", "chain_frames_batch", "chain_jacobian_batch"]


@helper_kernel
def _times_joint(r, slides, q):
    """``R Z(q)`` of a pose held in twelve scalars (rows of the 3 x 4 matrix)."""
    r00, r01, r02, r03, r10, r11, r12, r13, r20, r21, r22, r23 = r
    if slides:
        return (
            r00,
            r01,
            r02,
            r03 + r02 * q,
            r10,
            r11,
            r12,
            r13 + r12 * q,
            r20,
            r21,
            r22,
            r23 + r22 * q,
        )
    c, s = math.cos(q), math.sin(q)
    return (
        r00 * c + r01 * s,
        r01 * c - r00 * s,
        r02,
        r03,
        r10 * c + r11 * s,
        r11 * c - r10 * s,
        r12,
        r13,
        r20 * c + r21 * s,
        r21 * c - r20 * s,
        r22,
        r23,
    )


@helper_kernel
def _times_link(r, link):
    """``R link`` of a pose held in twelve scalars."""
    r00, r01, r02, r03, r10, r11, r12, r13, r20, r21, r22, r23 = r
    a00, a01, a02, a03 = link[0, 0], link[0, 1], link[0, 2], link[0, 3]
    a10, a11, a12, a13 = link[1, 0], link[1, 1], link[1, 2], link[1, 3]
    a20, a21, a22, a23 = link[2, 0], link[2, 1], link[2, 2], link[2, 3]
    return (
        r00 * a00 + r01 * a10 + r02 * a20,
        r00 * a01 + r01 * a11 + r02 * a21,
        r00 * a02 + r01 * a12 + r02 * a22,
        r00 * a03 + r01 * a13 + r02 * a23 + r03,
        r10 * a00 + r11 * a10 + r12 * a20,
        r10 * a01 + r11 * a11 + r12 * a21,
        r10 * a02 + r11 * a12 + r12 * a22,
        r10 * a03 + r11 * a13 + r12 * a23 + r13,
        r20 * a00 + r21 * a10 + r22 * a20,
        r20 * a01 + r21 * a11 + r22 * a21,
        r20 * a02 + r21 * a12 + r22 * a22,
        r20 * a03 + r21 * a13 + r22 * a23 + r23,
    )


@helper_kernel
def _joint_times_link(r, slides, q, link):
    """``R Z(q) link`` of a pose held in twelve scalars."""
    return _times_link(_times_joint(r, slides, q), link)


@helper_kernel
def _load(link):
    """The twelve scalars of a pose."""
    return (
        link[0, 0],
        link[0, 1],
        link[0, 2],
        link[0, 3],
        link[1, 0],
        link[1, 1],
        link[1, 2],
        link[1, 3],
        link[2, 0],
        link[2, 1],
        link[2, 2],
        link[2, 3],
    )


@helper_kernel
def _store(r, T):
    """Write twelve scalars as a homogeneous matrix."""
    T[0, 0], T[0, 1], T[0, 2], T[0, 3] = r[0], r[1], r[2], r[3]
    T[1, 0], T[1, 1], T[1, 2], T[1, 3] = r[4], r[5], r[6], r[7]
    T[2, 0], T[2, 1], T[2, 2], T[2, 3] = r[8], r[9], r[10], r[11]
    T[3, 0], T[3, 1], T[3, 2], T[3, 3] = 0.0, 0.0, 0.0, 1.0


@njit(cache=True, nogil=True)
def chain_fk(links, prismatic, q, T):
    """``T_base_tool`` of one configuration q (n,), written to T (4, 4)."""
    r = _load(links[0])
    for i in range(q.shape[0]):
        r = _joint_times_link(r, prismatic[i], q[i], links[i + 1])
    _store(r, T)


@njit(cache=True, nogil=True)
def chain_fk_batch(links, prismatic, q, T):
    """``T_base_tool`` of configurations q (m, n), written to T (m, 4, 4).

    Whole blocks go side by side; the rest, and angles of a thousand turns, one by one.
    """
    m = q.shape[0]
    x, S = np.empty(BLOCK), np.empty(ROWS * BLOCK)
    for first in range(0, m, BLOCK):
        last = min(first + BLOCK, m)
        if last - first == BLOCK and fits(q[first:last]):
            lanes_fk(links, prismatic, q[first:last], T[first:last], x, S)
        else:
            for k in range(first, last):
                chain_fk(links, prismatic, q[k], T[k])


@njit(cache=True, nogil=True)
def chain_frames_batch(links, prismatic, frames, q, T):
    """Frames carried by the joints of configurations q (m, n), written to T (m, n + 1, 4, 4).

    ``T[:, 0] = frames[0]`` in base; ``T[:, i] = (pose after Z_i) frames[i]``.
    """
    for k in range(q.shape[0]):
        _store(_load(frames[0]), T[k, 0])
        r = _load(links[0])
        for i in range(q.shape[1]):
            r = _times_joint(r, prismatic[i], q[k, i])
            _store(_times_link(r, frames[i + 1]), T[k, i + 1])
            r = _times_link(r, links[i + 1])


@njit(cache=True, nogil=True)
def chain_jacobian_batch(links, prismatic, q, J):
    """Geometric Jacobians at the tip in base axes of q (m, n), written to J (m, 6, n).

    Linear over angular: ``J_i = (z_i x (p_tip - p_i), z_i)`` revolute, ``(z_i, 0)`` prismatic
    (Spong, eqs. 4.57 to 4.60); Pinocchio's ``LOCAL_WORLD_ALIGNED``. The joints' points are kept
    in J until the tip is known.
    """
    n = q.shape[1]
    for k in range(q.shape[0]):
        r = _load(links[0])
        for i in range(n):
            J[k, 0, i], J[k, 1, i], J[k, 2, i] = r[3], r[7], r[11]
            J[k, 3, i], J[k, 4, i], J[k, 5, i] = r[2], r[6], r[10]
            r = _joint_times_link(r, prismatic[i], q[k, i], links[i + 1])
        for i in range(n):
            zx, zy, zz = J[k, 3, i], J[k, 4, i], J[k, 5, i]
            if prismatic[i]:
                J[k, 0, i], J[k, 1, i], J[k, 2, i] = zx, zy, zz
                J[k, 3, i], J[k, 4, i], J[k, 5, i] = 0.0, 0.0, 0.0
            else:
                x, y, z = r[3] - J[k, 0, i], r[7] - J[k, 1, i], r[11] - J[k, 2, i]
                J[k, 0, i] = zy * z - zz * y
                J[k, 1, i] = zz * x - zx * z
                J[k, 2, i] = zx * y - zy * x
