"""The remaining joints of a closed loop once its joints 3, 4, 5 are known, in lanes.

The fourteen functions of the line of axis 6, evaluated on the left side, give the cosines and
sines of joints 1 and 2 by linear equations; joint 6 is the rotation that closes the loop.
Arrays ``cosines`` and ``sines`` hold six runs of ``LANES`` doubles, one a joint.
"""

from __future__ import annotations

import math

from dh2urdf.kernels.numbers import LANES, MASK, inlined, vector_kernel

__all__ = ["left_frames", "other_joints"]


@vector_kernel
def _turn(c, s, x, y, z):
    """``Z v``."""
    return c * x - s * y, s * x + c * y, z


@vector_kernel
def _turn_back(c, s, x, y, z):
    """``Z^-1 v``."""
    return c * x + s * y, c * y - s * x, z


@vector_kernel
def rotation(a):
    """The rotation of a rigid transform (12,), as nine scalars row by row."""
    return a[0], a[1], a[2], a[4], a[5], a[6], a[8], a[9], a[10]


@vector_kernel
def rotation_back(a):
    """The inverse of that rotation."""
    return a[0], a[4], a[8], a[1], a[5], a[9], a[2], a[6], a[10]


@vector_kernel
def _apply(r, x, y, z):
    """``R v``."""
    return (
        r[0] * x + r[1] * y + r[2] * z,
        r[3] * x + r[4] * y + r[5] * z,
        r[6] * x + r[7] * y + r[8] * z,
    )


@inlined
def left_frames(loop, cosines, sines, n, frames):
    """``Z_3 C_3 Z_4 C_4 Z_5 C_5`` of n lanes: four columns to frames (12 runs of LANES)."""
    ra, rb = rotation(loop[2]), rotation(loop[3])
    for column in range(4):
        dx, dy, dz = loop[4, column], loop[4, 4 + column], loop[4, 8 + column]
        bx, by, bz, ax, ay, az = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        if column == 3:
            bx, by, bz = loop[3, 3], loop[3, 7], loop[3, 11]
            ax, ay, az = loop[2, 3], loop[2, 7], loop[2, 11]
        f = (3 * column * LANES) & MASK
        for k in range(n):
            x, y, z = _turn(cosines[4 * LANES + k], sines[4 * LANES + k], dx, dy, dz)
            x, y, z = _apply(rb, x, y, z)
            x, y, z = x + bx, y + by, z + bz
            x, y, z = _turn(cosines[3 * LANES + k], sines[3 * LANES + k], x, y, z)
            x, y, z = _apply(ra, x, y, z)
            x, y, z = x + ax, y + ay, z + az
            x, y, z = _turn(cosines[2 * LANES + k], sines[2 * LANES + k], x, y, z)
            frames[f + k], frames[f + LANES + k], frames[f + 2 * LANES + k] = x, y, z


@inlined
def _functions(frames, n, out):
    """The fourteen functions of axis 6's line, to out (14 runs of LANES)."""
    for k in range(n):
        lx, ly, lz = frames[6 * LANES + k], frames[7 * LANES + k], frames[8 * LANES + k]
        px, py, pz = frames[9 * LANES + k], frames[10 * LANES + k], frames[11 * LANES + k]
        pp = px * px + py * py + pz * pz
        pl2 = 2.0 * (px * lx + py * ly + pz * lz)
        out[k], out[LANES + k], out[2 * LANES + k] = px, py, pz
        out[3 * LANES + k], out[4 * LANES + k], out[5 * LANES + k] = lx, ly, lz
        out[6 * LANES + k], out[7 * LANES + k] = pp, 0.5 * pl2
        out[8 * LANES + k] = py * lz - pz * ly
        out[9 * LANES + k] = pz * lx - px * lz
        out[10 * LANES + k] = px * ly - py * lx
        out[11 * LANES + k] = pp * lx - pl2 * px
        out[12 * LANES + k] = pp * ly - pl2 * py
        out[13 * LANES + k] = pp * lz - pl2 * pz


@vector_kernel
def _project(basis, row, constant, functions, n, out):
    """Row of Q^T times (functions - constant), to a run of out."""
    w0 = basis[row, 0]
    shift = 0.0
    for f in range(len(constant)):
        shift += basis[row, f] * constant[f]
    o = ((row - 4) * LANES) & MASK
    for k in range(n):
        out[o + k] = w0 * functions[k] - shift
    for f in range(1, len(constant)):
        w = basis[row, f]
        for k in range(n):
            out[o + k] += w * functions[f * LANES + k]


@inlined
def other_joints(loop, right, beta, basis, frames, n, cosines, sines, functions, y):
    """Joints 1, 2 and 6 of n lanes.

    Parameters
    ----------
    loop : (6, 12)
    right, beta, basis
        The QR of the right side, as `reduce_right` leaves it.
    frames : (12 runs of LANES)
        From `left_frames`.
    cosines, sines : six runs of LANES, in and out
    functions : 14 runs of LANES, scratch
    y : four runs of LANES, scratch
    """
    _functions(frames, n, functions)
    for row in range(4, 8):
        _project(basis, row, right[8], functions, n, y)
    d4, d5, d6, d7 = 1.0 / beta[12], 1.0 / beta[13], 1.0 / beta[14], 1.0 / beta[15]
    r45, r46, r56 = right[5, 4], right[6, 4], right[6, 5]
    r47, r57, r67 = right[7, 4], right[7, 5], right[7, 6]
    for k in range(n):
        s2 = y[3 * LANES + k] * d7
        c2 = (y[2 * LANES + k] - r67 * s2) * d6
        s1 = (y[LANES + k] - r56 * c2 - r57 * s2) * d5
        c1 = (y[k] - r45 * s1 - r46 * c2 - r47 * s2) * d4
        h1 = 1.0 / (math.sqrt(c1 * c1 + s1 * s1) + 1e-300)
        h2 = 1.0 / (math.sqrt(c2 * c2 + s2 * s2) + 1e-300)
        cosines[k], sines[k] = c1 * h1, s1 * h1
        cosines[LANES + k], sines[LANES + k] = c2 * h2, s2 * h2
    _last_joint(loop, frames, n, cosines, sines)


@inlined
def _last_joint(loop, frames, n, cosines, sines):
    """Joint 6: first row of ``Z_6^-1 = X^T L``, X the right side's and L the left's rotation."""
    x0, y0, z0 = loop[5, 0], loop[5, 1], loop[5, 2]
    first, second = rotation_back(loop[0]), rotation_back(loop[1])
    for k in range(n):
        x, y, z = _turn_back(cosines[k], sines[k], x0, y0, z0)
        x, y, z = _apply(first, x, y, z)
        x, y, z = _turn_back(cosines[LANES + k], sines[LANES + k], x, y, z)
        x, y, z = _apply(second, x, y, z)
        c = x * frames[k] + y * frames[LANES + k] + z * frames[2 * LANES + k]
        s = x * frames[3 * LANES + k] + y * frames[4 * LANES + k] + z * frames[5 * LANES + k]
        h = 1.0 / (math.sqrt(c * c + s * s) + 1e-300)
        cosines[5 * LANES + k], sines[5 * LANES + k] = c * h, s * h
