"""Directions in which a chain moves its tool: singular values and vectors of the Jacobian, steps.

By Hestenes' one-sided rotations, which keep the small ones.
"""

import math

from dh2urdf.kernels.chain import jacobian_rows
from dh2urdf.kernels.newton import error_and_jacobian, turn_between, way_between

SWEEPS = 12
"""Most sweeps of rotations; five are usual."""


def decompose(damped, V, sigma):
    """Rows of the Jacobian J^T (n, 6) in ``damped`` to ``sigma_k u_k``, V (n, n) to its vectors.

    The rows ``V[k]`` are right singular vectors, sigma (n,) their singular values; returns the
    index of the smallest and the size of the largest.
    """
    U, n = damped[0], V.shape[0]
    for i in range(n):
        V[i] = 0.0
        V[i, i] = 1.0
    for _ in range(SWEEPS):
        turned = False
        for i in range(n - 1):
            for j in range(i + 1, n):
                a, b, c = 0.0, 0.0, 0.0
                for k in range(6):
                    a += U[i, k] * U[i, k]
                    b += U[j, k] * U[j, k]
                    c += U[i, k] * U[j, k]
                if abs(c) <= 1e-15 * math.sqrt(a * b) or c == 0.0:
                    continue
                turned = True
                z = (b - a) / (2.0 * c)
                t = math.copysign(1.0, z) / (abs(z) + math.sqrt(1.0 + z * z))
                co = 1.0 / math.sqrt(1.0 + t * t)
                si = co * t
                for k in range(6):
                    x, y = U[i, k], U[j, k]
                    U[i, k], U[j, k] = co * x - si * y, si * x + co * y
                for k in range(n):
                    x, y = V[i, k], V[j, k]
                    V[i, k], V[j, k] = co * x - si * y, si * x + co * y
        if not turned:
            break
    least, largest = 0, 0.0
    for i in range(n):
        total = 0.0
        for k in range(6):
            total += U[i, k] * U[i, k]
        sigma[i] = math.sqrt(total)
        largest = max(largest, sigma[i])
        least = i if sigma[i] < sigma[least] else least
    return least, largest


def look(chain, goal, q, room):
    """Error and decomposed Jacobian at q: index of the weak direction, largest singular value.

    Slides count in sizes of the arm, as errors of the position do.
    """
    damped, V, sigma, joints = room[0], room[1], room[2], chain[1]
    error_and_jacobian(chain, goal, q, damped)
    for i in range(q.shape[0]):
        if joints[i, 0] != 0.0:
            for k in range(6):
                damped[0][i, k] *= goal[2]
    return decompose(damped, V, sigma)


def look_at_some(chain, T, q, mask, room):
    """The same for the joints of a mask and a target T, a pose (4, 4) or a point (3,), in metres.

    The other joints stay: theirs are the unit vectors of the same index. Returned in place of the
    largest singular value is what the fastest of all joints does, where that is more.
    """
    damped, V, sigma = room[0], room[1], room[2]
    J, e = damped
    r = jacobian_rows(chain, q, J)
    e[0, 6], e[1, 6], e[2, 6] = way_between(r, T)
    e[3, 6], e[4, 6], e[5, 6] = 0.0, 0.0, 0.0
    if T.ndim == 2:
        e[3, 6], e[4, 6], e[5, 6], _ = turn_between(r, T)
    fastest = 0.0
    for i in range(q.shape[0]):
        speed = 0.0
        for k in range(6):
            J[i, k] = 0.0 if k > 2 and T.ndim == 1 else J[i, k]
            speed += J[i, k] * J[i, k]
            J[i, k] = J[i, k] if mask >> i & 1 else 0.0
        fastest = max(fastest, speed)
    least, largest = decompose(damped, V, sigma)
    return least, max(largest, math.sqrt(fastest))


def _along(U, e, k, sigma):
    """Part of the error e, column 6, along left vector k, over its singular value."""
    total = 0.0
    for i in range(6):
        total += U[k, i] * e[i, 6]
    return total / (sigma[k] * sigma[k])


def add_step(chain, unit, q, room, floor, most):
    """Newton's step by the directions above a singular value; its length, not over ``most``.

    ``unit`` is the length in which slides are measured.
    Returned too are what of the error these directions take away, and what they leave.
    """
    (J, e), V, sigma, step, joints = room[0], room[1], room[2], room[3], chain[1]
    n = q.shape[0]
    step[:] = 0.0
    total, taken = 0.0, 0.0
    for i in range(6):
        total += e[i, 6] * e[i, 6]
    for k in range(n):
        if sigma[k] > floor:
            along = _along(J, e, k, sigma)
            taken += (along * sigma[k]) * (along * sigma[k])
            step += along * V[k]
    longest = 0.0
    for i in range(n):
        longest = max(longest, abs(step[i]))
    scale = min(1.0, most / longest) if longest > 0.0 else 0.0
    for i in range(n):
        q[i] += scale * step[i] * (unit if joints[i, 0] != 0.0 else 1.0)
    return longest, math.sqrt(taken), math.sqrt(max(total - taken, 0.0))
