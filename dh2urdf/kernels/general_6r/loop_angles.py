"""The remaining joints of a closed loop once its joints 3, 4, 5 are known, in lanes.

The fourteen functions of the line of axis 6, evaluated on the left side, give the cosines and
sines of joints 1 and 2 by linear equations; joint 6 is the rotation that closes the loop.
Arrays ``cosines`` and ``sines`` hold six runs of ``LANES`` doubles, one a joint.
"""

import math

from dh2urdf.kernels.certificate import chain_frames
from dh2urdf.kernels.general_6r.elimination import line_functions, move_line_back
from dh2urdf.kernels.numbers import LANES, MASK, inlined, vector_kernel

LEFT = 3 * 12 * LANES
"""Where `chain_frames` leaves ``C_2 Z_3 C_3 Z_4 C_4 Z_5 C_5``."""


@vector_kernel
def _entries(a):
    """Entries of a transform (12,) as scalars, which no writing in a loop can change."""
    return a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11]


@inlined
def _functions(loop, frames, n, out):
    """The fourteen functions of axis 6's line, to out (14, LANES)."""
    second = _entries(loop[1])
    for k in range(n):
        f = LEFT + k
        lx, ly, lz = frames[f + 2 * LANES], frames[f + 6 * LANES], frames[f + 10 * LANES]
        px, py, pz = frames[f + 3 * LANES], frames[f + 7 * LANES], frames[f + 11 * LANES]
        line_functions(move_line_back(second, (lx, ly, lz, px, py, pz)), out, k)


@vector_kernel
def _project(basis, row, constant, functions, n, out):
    """Row of Q^T times (functions - constant), to a run of out."""
    w0 = basis[row, 0]
    shift = 0.0
    for f in range(len(constant)):
        shift += basis[row, f] * constant[f]
    o = ((row - 4) * LANES) & MASK
    for k in range(n):
        out[o + k] = w0 * functions[0, k] - shift
    for f in range(1, len(constant)):
        w = basis[row, f]
        for k in range(n):
            out[o + k] += w * functions[f, k]


@inlined
def other_joints(loop, right, beta, basis, frames, n, cosines, sines, functions, y):
    """Joints 1, 2 and 6 of n lanes.

    ``right``, ``beta`` and ``basis`` as `reduce_right` leaves them; frames (7 * 144,), functions
    (14, 24) and y (96,) scratch.
    """
    chain_frames(loop[1:5], cosines[2 * LANES :], sines[2 * LANES :], n, frames)
    _functions(loop, frames, n, functions)
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
    """Joint 6: first row of ``Z_6^-1 = C_6 Z_1 C_1 Z_2 (C_2 Z_3 C_3 Z_4 C_4 Z_5 C_5)``."""
    x0, y0, z0 = loop[5, 0], loop[5, 1], loop[5, 2]
    first = _entries(loop[0])
    for k in range(n):
        c1, s1, c2, s2 = cosines[k], sines[k], cosines[LANES + k], sines[LANES + k]
        row = (x0 * c1 + y0 * s1, y0 * c1 - x0 * s1, z0, 0.0, 0.0, 0.0)
        x, y, z, _, _, _ = move_line_back(first, row)
        x, y = x * c2 + y * s2, y * c2 - x * s2
        f = LEFT + k
        c = x * frames[f] + y * frames[f + 4 * LANES] + z * frames[f + 8 * LANES]
        s = x * frames[f + LANES] + y * frames[f + 5 * LANES] + z * frames[f + 9 * LANES]
        h = 1.0 / (math.sqrt(c * c + s * s) + 1e-300)
        cosines[5 * LANES + k], sines[5 * LANES + k] = c * h, s * h
