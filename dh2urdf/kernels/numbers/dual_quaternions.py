"""Unit dual quaternions as rows of eight numbers: rotation ``r``, then ``t r / 2``.

A joint is linear in homogeneous unknowns (u : v): ``u + v k`` turns about z by ``2 atan(v / u)``,
``u + v e k`` slides along z by ``2 v / u`` (Husty & Schroecker, "Kinematics and algebraic
geometry", 2013). Scalar part first.
"""

import math
from typing import Annotated

from dh2urdf.engine import entry
from dh2urdf.kernels.shapes import Floats, Pose


@entry()
def dual_of_pose(T: Pose, unit: float, out: Annotated[Floats, 8]):
    """Write the dual quaternion of T (4, 4), lengths divided by ``unit``, to out (8,).

    The largest of the four components is taken from the diagonal (Shepperd 1978).
    """
    a, b, c = T[0, 0], T[1, 1], T[2, 2]
    if a + b + c > 0.0:
        w, x = 1.0 + a + b + c, T[2, 1] - T[1, 2]
        y, z = T[0, 2] - T[2, 0], T[1, 0] - T[0, 1]
    elif a >= b and a >= c:
        w, x = T[2, 1] - T[1, 2], 1.0 + a - b - c
        y, z = T[0, 1] + T[1, 0], T[0, 2] + T[2, 0]
    elif b >= c:
        w, x = T[0, 2] - T[2, 0], T[0, 1] + T[1, 0]
        y, z = 1.0 + b - a - c, T[1, 2] + T[2, 1]
    else:
        w, x = T[1, 0] - T[0, 1], T[0, 2] + T[2, 0]
        y, z = T[1, 2] + T[2, 1], 1.0 + c - a - b
    size = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / size, x / size, y / size, z / size
    half = 0.5 / unit
    tx, ty, tz = half * T[0, 3], half * T[1, 3], half * T[2, 3]
    out[0], out[1], out[2], out[3] = w, x, y, z
    out[4] = -tx * x - ty * y - tz * z
    out[5] = tx * w + ty * z - tz * y
    out[6] = ty * w + tz * x - tx * z
    out[7] = tz * w + tx * y - ty * x


def dual_conjugate(a, out):
    """Write the inverse of a unit dual quaternion: vector parts with the other sign."""
    out[0], out[1], out[2], out[3] = a[0], -a[1], -a[2], -a[3]
    out[4], out[5], out[6], out[7] = a[4], -a[5], -a[6], -a[7]


def _hamilton(a, i, b, j):
    """Hamilton's product of the quaternions at a[i:] and b[j:]."""
    p, q, r, s = a[i], a[i + 1], a[i + 2], a[i + 3]
    w, x, y, z = b[j], b[j + 1], b[j + 2], b[j + 3]
    return (
        p * w - q * x - r * y - s * z,
        p * x + q * w + r * z - s * y,
        p * y - q * z + r * w + s * x,
        p * z + q * y - r * x + s * w,
    )


def dual_product(a, b, out):
    """Write ``a b`` to out (8,), which may be a or b."""
    r0, r1, r2, r3 = _hamilton(a, 0, b, 0)
    m0, m1, m2, m3 = _hamilton(a, 0, b, 4)
    n0, n1, n2, n3 = _hamilton(a, 4, b, 0)
    out[0], out[1], out[2], out[3] = r0, r1, r2, r3
    out[4], out[5], out[6], out[7] = m0 + n0, m1 + n1, m2 + n2, m3 + n3


def dual_times_joint(a, slides, out):
    """Write ``a k`` (turning) or ``a e k`` (sliding) to out (8,): the factor of v."""
    w, x, y, z = a[0], a[1], a[2], a[3]
    if slides:
        out[4], out[5], out[6], out[7] = -z, y, -x, w
        out[0], out[1], out[2], out[3] = 0.0, 0.0, 0.0, 0.0
        return
    p, q, r, s = a[4], a[5], a[6], a[7]
    out[0], out[1], out[2], out[3] = -z, y, -x, w
    out[4], out[5], out[6], out[7] = -s, r, -q, p
