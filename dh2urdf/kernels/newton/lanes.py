"""Newton's method on the exact chain of six joints, many seeds side by side.

The chain is ``L_0 Z_1 L_1 ... Z_6 L_6 = target``. Angles are held as cosines and sines and
turned by the tangent of the step, so that no trigonometric function is called; what slides has
its length where the sine would be.
"""

import math

from dh2urdf.kernels.numbers import COLUMN, LANES, reduce_columns, side_by_side, solve_upper
from dh2urdf.kernels.rigid import load_pose

FRAME = 12 * LANES
LARGEST_STEP = 0.5
"""A Newton step [rad, or in sizes of the arm] is shortened to this."""


def chain_frames(steps, slides, cosines, sines, n, frames):
    """``F_0 = steps[0]``, ``F_i = F_(i-1) Z_i steps[i]`` for n lanes, to seven runs of twelve.

    steps (7, 3, 4); slides (6,) is 1 where a joint does; cosines, sines six runs of LANES.
    """
    for e in range(12):
        value = steps[0, e // 4, e % 4]
        f = e * LANES
        for k in side_by_side(n):
            frames[f + k] = value
    for i in range(len(steps) - 1):
        link, q = load_pose(steps[i + 1]), i * LANES
        for row in range(3):
            f = i * FRAME + 4 * row * LANES
            g = f + FRAME
            if slides[i] != 0:
                for k in side_by_side(n):
                    u, v, z, p = _row(frames, f + k)
                    x, y, z, p = _past(u, v, z, p + z * sines[q + k], link)
                    frames[g + k], frames[g + LANES + k] = x, y
                    frames[g + 2 * LANES + k], frames[g + 3 * LANES + k] = z, p
                continue
            for k in side_by_side(n):
                u, v, z, p = _row(frames, f + k)
                c, s = cosines[q + k], sines[q + k]
                x, y, z, p = _past(u * c + v * s, v * c - u * s, z, p, link)
                frames[g + k], frames[g + LANES + k] = x, y
                frames[g + 2 * LANES + k], frames[g + 3 * LANES + k] = z, p


def _row(frames, f):
    """One row of a frame, of the lane whose first entry is at f."""
    return frames[f], frames[f + LANES], frames[f + 2 * LANES], frames[f + 3 * LANES]


def _past(x, y, z, p, link):
    """A row of a pose times a link."""
    a00, a01, a02, a03, a10, a11, a12, a13, a20, a21, a22, a23 = link
    first, second = x * a00 + y * a10 + z * a20, x * a01 + y * a11 + z * a21
    return first, second, x * a02 + y * a12 + z * a22, x * a03 + y * a13 + z * a23 + p


def pose_error(target, frames, n, error, position, angle):
    """Twist from the last frame to the target (3, 4), in base axes.

    ``error`` (6 runs of LANES): linear, angular. ``position`` [length] and ``angle`` [rad] are its
    sizes; an angle beyond 90 degrees is reported as 3.
    """
    t00, t01, t02, t03, t10, t11, t12, t13, t20, t21, t22, t23 = load_pose(target)
    f = 6 * FRAME
    for k in side_by_side(n):
        r00, r01, r02 = frames[f + k], frames[f + 24 + k], frames[f + 48 + k]
        r10, r11, r12 = frames[f + 96 + k], frames[f + 120 + k], frames[f + 144 + k]
        r20, r21, r22 = frames[f + 192 + k], frames[f + 216 + k], frames[f + 240 + k]
        x = t03 - frames[f + 72 + k]
        y = t13 - frames[f + 168 + k]
        z = t23 - frames[f + 264 + k]
        u = 0.5 * (r10 * t20 - r20 * t10 + r11 * t21 - r21 * t11 + r12 * t22 - r22 * t12)
        v = 0.5 * (r20 * t00 - r00 * t20 + r21 * t01 - r01 * t21 + r22 * t02 - r02 * t22)
        w = 0.5 * (r00 * t10 - r10 * t00 + r01 * t11 - r11 * t01 + r02 * t12 - r12 * t02)
        trace = r00 * t00 + r10 * t10 + r20 * t20 + r01 * t01 + r11 * t11 + r21 * t21
        trace += r02 * t02 + r12 * t12 + r22 * t22
        error[k], error[24 + k], error[48 + k] = x, y, z
        error[72 + k], error[96 + k], error[120 + k] = u, v, w
        position[k] = math.sqrt(x * x + y * y + z * z)
        turn = math.sqrt(u * u + v * v + w * w)
        angle[k] = turn if trace > 1.0 else 3.0


def _newton_system(frames, slides, error, size, n, A):
    """``J step = error`` of n lanes, J the geometric Jacobian at the tip in base axes.

    Steps of what slides count in sizes of the arm. The right side is the seventh column of A.
    """
    e = 6 * FRAME
    for i in range(6):
        f, a = i * FRAME, i * COLUMN
        for k in side_by_side(n):
            zx, zy, zz = frames[f + 48 + k], frames[f + 144 + k], frames[f + 240 + k]
            x = frames[e + 72 + k] - frames[f + 72 + k]
            y = frames[e + 168 + k] - frames[f + 168 + k]
            z = frames[e + 264 + k] - frames[f + 264 + k]
            A[a + k] = zy * z - zz * y
            A[a + 24 + k] = zz * x - zx * z
            A[a + 48 + k] = zx * y - zy * x
            A[a + 72 + k], A[a + 96 + k], A[a + 120 + k] = zx, zy, zz
        if slides[i] != 0:
            for k in side_by_side(n):
                zx, zy, zz = A[a + 72 + k], A[a + 96 + k], A[a + 120 + k]
                A[a + k], A[a + 24 + k], A[a + 48 + k] = size * zx, size * zy, size * zz
                A[a + 72 + k], A[a + 96 + k], A[a + 120 + k] = 0.0, 0.0, 0.0
        b = 6 * COLUMN + i * LANES
        o = i * LANES
        for k in side_by_side(n):
            A[b + k] = error[o + k]


def _damped_system(J, weight, n, order, A):
    """``(J^T J + |error|^2) step = J^T error`` of a system ``J step = error``, ``order`` unknowns.

    Lengths are multiplied by ``weight``. The damping vanishes with the error, so convergence stays
    fast, also where J is singular along a family of solutions.
    """
    for j in range(order + 1):
        for r in range(3):
            q = j * COLUMN + r * LANES
            for k in side_by_side(n):
                J[q + k] *= weight
    for i in range(order):
        p = i * COLUMN
        for j in range(order + 1):
            q = j * COLUMN
            a = j * COLUMN + i * LANES
            for k in side_by_side(n):
                A[a + k] = 0.0
            for r in range(order):
                o = r * LANES
                for k in side_by_side(n):
                    A[a + k] += J[p + o + k] * J[q + o + k]
    for i in range(order):
        a = i * COLUMN + i * LANES
        for r in range(order):
            o = order * COLUMN + r * LANES
            for k in side_by_side(n):
                A[a + k] += J[o + k] * J[o + k]


def newton_step(frames, slides, error, size, damped, n, A, J, scale, V, beta, cosines, sines):
    """Move the joints of n lanes by a Newton step, shortened to half a radian or half of a size.

    A and J (7 * 144,) scratch; error is overwritten with the step. ``scale`` becomes
    the determinant of the Jacobian, up to its sign; of the damped normal matrix if ``damped`` is 1.
    """
    _newton_system(frames, slides, error, size, n, J if damped == 1 else A)
    if damped == 1:
        _damped_system(J, 1.0 / size, n, len(error) // LANES, A)
    scale[:n] = 1.0
    reduce_columns(A, 6, 7, n, scale, V, beta)
    for i in range(6):
        a = 6 * COLUMN + i * LANES
        e = i * LANES
        for k in side_by_side(n):
            error[e + k] = A[a + k]
    solve_upper(A, error, n)
    for k in side_by_side(n):
        largest = LARGEST_STEP
        for i in range(6):
            largest = max(largest, abs(error[i * LANES + k]))
        beta[k] = LARGEST_STEP / largest
    for i in range(6):
        e = i * LANES
        if slides[i] != 0:
            for k in side_by_side(n):
                sines[e + k] += size * (error[e + k] * beta[k])
            continue
        for k in side_by_side(n):
            t = error[e + k] * beta[k]
            c, s = cosines[e + k], sines[e + k]
            h = 1.0 / math.sqrt(1.0 + t * t)
            cosines[e + k] = (c - s * t) * h
            sines[e + k] = (s + c * t) * h
