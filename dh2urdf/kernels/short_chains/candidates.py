"""From the null space of a loop's matrix to candidate configurations.

A vector w of eight holds two products, slots 0 to 3 ``(u_a, v_a) x (u_b, v_b)`` and slots 4 to 7
the same of joints c and d. A slot that the loop does not have (an absent joint, or the product of
two slides) is zero in every vector.
"""

import math

from dh2urdf.kernels.numbers import atan2, sincos

VANISHING = 1e-9
"""Size, of vectors with a largest entry of 1, at which a condition is no condition: rounding."""

DEFECT = 1e-2
"""Determinant of the 2 x 2 slots of a vector, largest entry about 1, that is no product any more:
even a double root of the loop's determinant leaves less than 1e-4."""

SLACK = 1e-6
"""Relative negative discriminant that is clamped to a double root; the residual decides."""


def add_candidates(basis, nullity, shape, joints, x, rest, unit, q, count):
    """Append the configurations that a null space holds to q; the new count of its rows.

    The first ``nullity`` (1, 2 or 3) rows of ``basis`` (6, 8) are null vectors, largest entry about
    1; the rest is scratch. ``shape`` (7,): joints a, b, x, c, d (-1: absent), and whether the left
    and the right pair have all four slots. ``x`` is ``(u_x, v_x)``. A joint is held at rest to pick
    a member of a singular family.
    """
    if nullity == 1:
        return _append(basis[0], shape, joints, x, unit, q, count)
    if nullity == 2:
        before = count
        count, conditions = _meet_line(basis, 0, shape, joints, x, unit, q, count)
        if conditions or count > before:
            return count
    for k in range(5):
        joint = shape[k]
        if joint >= 0 and k != 2:
            left = _hold(basis, nullity, shape, k, joints[joint, 0] != 0.0, rest[joint], unit)
            if left == 1:
                count = _append(basis[3], shape, joints, x, unit, q, count)
            elif left == 2:
                count, _ = _meet_line(basis, 3, shape, joints, x, unit, q, count)
    return count


def _append(w, shape, joints, x, unit, q, count):
    """Append the configuration of one null vector, if it is one and there is room."""
    if count >= q.shape[0]:
        return count
    for side in range(2):
        if shape[5 + side] != 0 and abs(_mixed(w, w, 4 * side)) > DEFECT:
            return count
    row = q[count]
    ok = _split(w, 0, shape[0], shape[1], joints, unit, row)
    ok = ok and _split(w, 4, shape[3], shape[4], joints, unit, row)
    if ok and shape[2] >= 0:
        ok = _write(x[0], x[1], shape[2], joints, unit, row)
    return count + 1 if ok else count


def _split(w, at, first, second, joints, unit, row):
    """Take a product apart: the larger column is the first joint's, the larger row the other's.

    Two slides lack the slot ``v v``; theirs is always ``u u``, or they are at infinity.
    """
    a, b, c, d = w[at], w[at + 1], w[at + 2], w[at + 3]
    whole = first < 0 or second < 0 or joints[first, 0] == 0.0 or joints[second, 0] == 0.0
    if first >= 0:
        across = whole and abs(b) + abs(d) > abs(a) + abs(c)
        u, v = (b, d) if across else (a, c)
        if not _write(u, v, first, joints, unit, row):
            return False
    if second >= 0:
        below = whole and abs(c) + abs(d) > abs(a) + abs(b)
        u, v = (c, d) if below else (a, b)
        if not _write(u, v, second, joints, unit, row):
            return False
    return True


def _write(u, v, joint, joints, unit, row):
    """The joint value of (u : v); False where there is none."""
    if joints[joint, 0] == 0.0:
        row[joint] = 2.0 * atan2(v, u)
        return abs(u) + abs(v) > VANISHING
    if abs(u) <= VANISHING * abs(v) or u == 0.0:
        return False
    row[joint] = 2.0 * unit * v / u
    return True


def _mixed(p, r, at):
    """Half of the mixed determinant of the 2 x 2 slots of two vectors."""
    return 0.5 * (
        p[at] * r[at + 3] + r[at] * p[at + 3] - p[at + 1] * r[at + 2] - r[at + 1] * p[at + 2]
    )


def _meet_line(basis, at, shape, joints, x, unit, q, count):
    """Append the points of the line between basis rows ``at`` and ``at + 1`` that are products.

    Each pair with four slots gives ``det W = 0``, a quadratic equation on the line; the roots of
    both are appended, the residual tells which satisfy both. Returned are the count and the number
    of pairs whose determinant does not vanish on the whole line.
    """
    p, r, point = basis[at], basis[at + 1], basis[at + 2]
    conditions = 0
    for side in range(2):
        if shape[5 + side] == 0:
            continue
        square, half = _mixed(p, p, 4 * side), _mixed(p, r, 4 * side)
        constant = _mixed(r, r, 4 * side)
        scale = abs(square) + abs(half) + abs(constant)
        if scale <= VANISHING:
            continue
        conditions += 1
        discriminant = half * half - square * constant
        if discriminant < -SLACK * scale * scale:
            continue
        big = -half - math.copysign(math.sqrt(max(discriminant, 0.0)), half)
        for root in range(2):
            s, t = (big, square) if root == 0 else (constant, big)
            if abs(s) + abs(t) <= VANISHING * scale:
                continue
            size = 1.0 / (abs(s) + abs(t))
            point[:] = size * (s * p + t * r)
            count = _append(point, shape, joints, x, unit, q, count)
    return count, conditions


def _hold(basis, nullity, shape, place, slides, value, unit):
    """Vectors of the null space with one joint at a value, to rows 3, 4, 5 of the basis; how many.

    ``place`` is 0, 1, 3 or 4: joint a, b, c or d.
    """
    v, u = sincos(0.5 * value)
    if slides:
        u, v = 1.0, 0.5 * value / unit
    at = 0 if place < 2 else 4
    second = place == 1 or place == 4
    partner = shape[place - 1] if second else shape[place + 1]
    full = shape[5 if place < 2 else 6] != 0
    step, along = (1, 2) if second else (2, 1)
    for i in range(nullity):
        basis[3 + i] = basis[i]
    left = nullity
    for equation in range(2):
        if equation == 1 and (partner < 0 or not full):
            break
        start = at + equation * along
        pivot, largest = -1, VANISHING
        for k in range(left):
            size = abs(v * basis[3 + k, start] - u * basis[3 + k, start + step])
            if size > largest:
                pivot, largest = k, size
        if pivot < 0:
            continue
        left -= 1
        for i in range(8):
            basis[3 + pivot, i], basis[3 + left, i] = basis[3 + left, i], basis[3 + pivot, i]
        known = v * basis[3 + left, start] - u * basis[3 + left, start + step]
        for k in range(left):
            factor = (v * basis[3 + k, start] - u * basis[3 + k, start + step]) / known
            basis[3 + k] -= factor * basis[3 + left]
    return left
