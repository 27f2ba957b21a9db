"""Five joints of which three slide: the two turning ones follow from the orientation alone."""

from __future__ import annotations

import math

from numba import njit

from dh2urdf.kernels.chain import _joint_times_link, _load

__all__ = ["three_slides"]

FLAT = 1e-7
"""Volume of three unit directions that lie in a plane, to rounding of a table's angles."""

DAMPING = 1e-10
"""Added to the normal equations of slides in a plane; Newton removes what it leaves, 1e-10."""


@njit(cache=True, nogil=True, error_model="numpy")
def three_slides(links, joints, T, q, columns):
    """The only candidate configuration, written to q (5,).

    With ``R_0 Rz(q_i) R_1 Rz(q_j) R_2 = R``: the z axis of ``B = R_0^T R R_2^T`` is that of
    ``Rz(q_i) R_1``, its last row that of ``R_1 Rz(q_j)``. The slides then solve
    ``sum z_k q_k = p - p(0)``, three linear equations.

    Parameters
    ----------
    links, joints, T
        See :func:`dh2urdf.kernels.certify.finish_pose`.
    q : array, shape (5,), out
    columns : array, shape (8, 3), scratch
        Directions of the slides and the way to go.

    Returns
    -------
    int
        1. Where the slides lie in a plane they move as little as possible.
    """
    first, second = -1, -1
    before = _load(links[0])
    between = before
    after = before
    for i in range(5):
        if joints[i, 0] != 0.0:
            turn = False
        elif first < 0:
            first, turn = i, True
            between = _load(links[i + 1])
        else:
            second, turn = i, True
            after = _load(links[i + 1])
        q[i] = 0.0
        if turn:
            continue
        if first < 0:
            before = _joint_times_link(before, False, 0.0, links[i + 1])
        elif second < 0:
            between = _joint_times_link(between, False, 0.0, links[i + 1])
        else:
            after = _joint_times_link(after, False, 0.0, links[i + 1])
    b02, b12, b20, b21 = _middle_rotation(before, T, after)
    m02, m12, m20, m21 = between[2], between[6], between[8], between[9]
    q[first] = math.atan2(b12 * m02 - b02 * m12, b02 * m02 + b12 * m12)
    q[second] = math.atan2(m21 * b20 - m20 * b21, m20 * b20 + m21 * b21)
    return _slides(links, joints, T, q, columns)


@njit(cache=True, nogil=True, error_model="numpy")
def _middle_rotation(a, T, b):
    """Entries 02, 12, 20, 21 of ``A^T R B^T`` for poses a, b of twelve scalars."""
    u0 = b[8] * T[0, 0] + b[9] * T[0, 1] + b[10] * T[0, 2]
    u1 = b[8] * T[1, 0] + b[9] * T[1, 1] + b[10] * T[1, 2]
    u2 = b[8] * T[2, 0] + b[9] * T[2, 1] + b[10] * T[2, 2]
    v0 = a[2] * T[0, 0] + a[6] * T[1, 0] + a[10] * T[2, 0]
    v1 = a[2] * T[0, 1] + a[6] * T[1, 1] + a[10] * T[2, 1]
    v2 = a[2] * T[0, 2] + a[6] * T[1, 2] + a[10] * T[2, 2]
    return (
        a[0] * u0 + a[4] * u1 + a[8] * u2,
        a[1] * u0 + a[5] * u1 + a[9] * u2,
        v0 * b[0] + v1 * b[1] + v2 * b[2],
        v0 * b[4] + v1 * b[5] + v2 * b[6],
    )


@njit(cache=True, nogil=True, error_model="numpy")
def _slides(links, joints, T, q, columns):
    """Solve for the slides with the turning joints known and the slides at zero."""
    r = _load(links[0])
    k = 0
    for i in range(5):
        if joints[i, 0] != 0.0:
            columns[k, 0], columns[k, 1], columns[k, 2] = r[2], r[6], r[10]
            k += 1
        r = _joint_times_link(r, joints[i, 0] != 0.0, q[i], links[i + 1])
    columns[3, 0], columns[3, 1], columns[3, 2] = T[0, 3] - r[3], T[1, 3] - r[7], T[2, 3] - r[11]
    out = columns[4:8]
    volume = _volume(columns[0], columns[1], columns[2])
    if abs(volume) < FLAT:
        _least_motion(columns, out)
        volume = _volume(out[0], out[1], out[2])
        columns = out
    k = 0
    for i in range(5):
        if joints[i, 0] != 0.0:
            a, b, c = columns[0], columns[1], columns[2]
            if k == 0:
                a = columns[3]
            elif k == 1:
                b = columns[3]
            else:
                c = columns[3]
            q[i] = _volume(a, b, c) / volume
            k += 1
    return 1


@njit(cache=True, nogil=True, error_model="numpy")
def _least_motion(columns, out):
    """Normal equations of the slides, damped by ``DAMPING``: least squares, least motion."""
    for j in range(4):
        for i in range(3):
            out[j, i] = DAMPING if i == j else 0.0
            for k in range(3):
                out[j, i] += columns[i, k] * columns[j, k]


@njit(cache=True, nogil=True, error_model="numpy")
def _volume(a, b, c):
    """Determinant of three vectors."""
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
