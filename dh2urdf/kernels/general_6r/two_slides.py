"""Two slides among six joints: the four turns from the orientation and one equation of lengths.

The loop, cut before turn a, with what the slides do between the turns::

    Z_a D_0 Z_b D_1 Z_c D_2 Z_e D_3 = 1

Its rotations know nothing of the slides. At a value of a let ``z_b`` be the axis of b, seen after
turn e ``k = R_3 z_b``, and ``v = R_2^T e3`` that of c before it. Then, e being between them,

    A cos e + B sin e = C,   A = k.v in the plane, B = k_x v_y - k_y v_x, C = (R_1)_zz - k_z v_z

has two solutions ``(cos e, sin e) = (A C -+ B w, B C +- A w) / (A^2 + B^2)``, ``w^2 = A^2 + B^2 -
C^2``; from them the axis of c, and from that b, linearly. All directions are pairs p + q w. The way
P round the loop without the slides has to be one along their directions z_1 and z_2:

    f = (z_1 x z_2) . P = 0,   F(a) = f+ f- (k_x^2 + k_y^2)

f is linear in each of two points on the circle that become infinite where k_x^2 + k_y^2 vanishes,
all in one direction; so F, the product over the sign of w, is a trigonometric polynomial. Where
the slides are at right angles to a turn between them, its axis is in place of their product.

c must not be parallel to b nor to e. Where b and e are parallel and ``A = B = C = 0`` every e suits
the orientation, and F need not vanish. Where both slides are parallel f vanishes, too.
"""

import math

from dh2urdf.kernels.numbers import side_by_side
from dh2urdf.kernels.rigid import dot

COS_E, SIN_E, COS_B, SIN_B = 0, 2, 4, 6
B_X, B_Y, B_Z, E_X, E_Y, E_Z, AXIS_C = 8, 14, 20, 26, 32, 38, 44
WAY, FIRST, SECOND, NORMAL, F, SQUARE, TIMES, SIZE, PAIRS = 50, 56, 62, 68, 74, 76, 77, 78, 79
"""Rows of the workspace: pairs of numbers, pairs of vectors, ``w^2``, ``k_x^2 + k_y^2``, what F
is as large as where its factors are not at right angles."""

VANISHED = 1e-10
"""F, in parts of that, which is too little: if it is so all round, every a carries a solution, or
nearly."""

PARALLEL = 1e-4
"""Sine between axes below which they are taken for parallel: F loses twice as many digits."""

LOOSE = 1e-6
"""Such a sine, and distance of C from 0, below which every e is taken to suit."""

TINY = 1e-300

RIGHT = 1e-12
"""Cosine below which an angle is a right one."""


def _times(r, A, out):
    """Product of a pose (3, 4) from the left with an array (3, 4), to out, and A may be out."""
    for j in range(4):
        a, b, c = A[0, j], A[1, j], A[2, j]
        for i in range(3):
            out[i, j] = r[i, 0] * a + r[i, 1] * b + r[i, 2] * c
    for i in range(3):
        out[i, 3] += r[i, 3]


def cut_at_turns(arm):
    """What lies between the four turns of the loop, from label 3 on, and where the slides are."""
    loop, slides, segments, ways = arm["loop"], arm["loop_slides"], arm["segments"], arm["ways"]
    turning, sliding, where = arm["turning"], arm["sliding"], arm["where"]
    turn, slide, scratch = -1, 0, arm["scratch"]
    for place in range(6):
        label = (2 + place) % 6
        if slides[label] == 0:
            turn += 1
            turning[turn] = label
            segments[turn] = loop[label]
            continue
        sliding[slide], where[slide] = label, turn
        for r in range(3):
            ways[slide, r] = segments[turn, r, 2]
        scratch[:] = segments[turn]
        _times(scratch, loop[label], segments[turn])
        slide += 1
    arm["normal"] = _turn_between(arm)
    # seen from after turn e
    for i in range(2):
        if where[i] >= 2:
            D = segments[where[i]]
            x, y, z = ways[i, 0], ways[i, 1], ways[i, 2]
            for r in range(3):
                ways[i, r] = D[0, r] * x + D[1, r] * y + D[2, r] * z


def _turn_between(arm):
    """The turn, 0 to 3, that both slides are next to and at right angles with; -1: none."""
    segments, ways, where = arm["segments"], arm["ways"], arm["where"]
    first, second = where[0], where[1]
    for swap in range(2):
        if (first + 1) % 4 == second:
            i = swap
            D = segments[first]
            along = D[0, 2] * ways[i, 0] + D[1, 2] * ways[i, 1] + D[2, 2] * ways[i, 2]
            if abs(along) < RIGHT and abs(ways[1 - i, 2]) < RIGHT:
                return second
        first, second = second, first
    return -1


def _mixed(u, v, a, b):
    """Pair ``u a + v b`` of real vectors u, v and pairs a, b."""
    return (
        (u[0] * a[0] + v[0] * b[0], u[1] * a[0] + v[1] * b[0], u[2] * a[0] + v[2] * b[0]),
        (u[0] * a[1] + v[0] * b[1], u[1] * a[1] + v[1] * b[1], u[2] * a[1] + v[2] * b[1]),
    )


def _put(pairs, row, k, p, q):
    """Store a pair of vectors."""
    pairs[row, k], pairs[row + 1, k], pairs[row + 2, k] = p
    pairs[row + 3, k], pairs[row + 4, k], pairs[row + 5, k] = q


def _load(pairs, row, k):
    """A vector of the workspace."""
    return pairs[row, k], pairs[row + 1, k], pairs[row + 2, k]


def _directions(n, arm):
    """At n values of a: e, b, the frames after b and before e."""
    segments, hidden, pairs = arm["segments"], arm["hidden"], arm["pairs_of_slides"]
    D, S, R, Q = segments[0], segments[1], segments[2], segments[3]
    u = Q[0, 0], Q[0, 1], Q[0, 2]
    v = Q[1, 0], Q[1, 1], Q[1, 2]
    axis = Q[2, 0], Q[2, 1], Q[2, 2]
    vx, vy, vz = R[2, 0], R[2, 1], R[2, 2]
    sx, sy, sz = S[0, 2], S[1, 2], S[2, 2]
    d00, d10, d20, d01, d11, d21 = D[0, 0], D[1, 0], D[2, 0], D[0, 1], D[1, 1], D[2, 1]
    d02, d12, d22 = D[0, 2], D[1, 2], D[2, 2]
    r = 1.0 / (sx * sx + sy * sy + TINY)
    zero = 0.0, 0.0, 0.0
    for k in side_by_side(n):
        c, s = hidden[0, k], hidden[1, k]
        x = c * d00 - s * d10, s * d00 + c * d10, d20
        y = c * d01 - s * d11, s * d01 + c * d11, d21
        z = c * d02 - s * d12, s * d02 + c * d12, d22
        kx, ky, kz = dot(u, z), dot(v, z), dot(axis, z)
        A, B, C = kx * vx + ky * vy, kx * vy - ky * vx, sz - kz * vz
        square = A * A + B * B
        h = 1.0 / (square + TINY)
        cos_e, sin_e = (A * C * h, -B * h), (B * C * h, A * h)
        e0, e1 = _mixed(u, v, cos_e, (-sin_e[0], -sin_e[1])), _mixed(u, v, sin_e, cos_e)
        p = (
            e0[0][0] * vx + e1[0][0] * vy + axis[0] * vz,
            e0[0][1] * vx + e1[0][1] * vy + axis[1] * vz,
            e0[0][2] * vx + e1[0][2] * vy + axis[2] * vz,
        )
        q = (
            e0[1][0] * vx + e1[1][0] * vy,
            e0[1][1] * vx + e1[1][1] * vy,
            e0[1][2] * vx + e1[1][2] * vy,
        )
        nx, ny, mx, my = dot(x, p), dot(y, p), dot(x, q), dot(y, q)
        cos_b = (nx * sx + ny * sy) * r, (mx * sx + my * sy) * r
        sin_b = (ny * sx - nx * sy) * r, (my * sx - mx * sy) * r
        b0, b1 = _mixed(x, y, cos_b, sin_b), _mixed(y, x, cos_b, (-sin_b[0], -sin_b[1]))
        pairs[COS_E, k], pairs[COS_E + 1, k] = cos_e
        pairs[SIN_E, k], pairs[SIN_E + 1, k] = sin_e
        pairs[COS_B, k], pairs[COS_B + 1, k] = cos_b
        pairs[SIN_B, k], pairs[SIN_B + 1, k] = sin_b
        _put(pairs, B_X, k, b0[0], b0[1])
        _put(pairs, B_Y, k, b1[0], b1[1])
        _put(pairs, B_Z, k, z, zero)
        _put(pairs, E_X, k, e0[0], e0[1])
        _put(pairs, E_Y, k, e1[0], e1[1])
        _put(pairs, E_Z, k, axis, zero)
        _put(pairs, AXIS_C, k, p, q)
        pairs[SQUARE, k], pairs[TIMES, k] = square - C * C, kx * kx + ky * ky


def _add_along(pairs, frame, way, n, out):
    """Add a vector that is known in one of the frames to a pair of vectors."""
    x, y, z = way
    for i in range(6):
        for k in side_by_side(n):
            pairs[out + i, k] += (
                x * pairs[frame + i, k] + y * pairs[frame + 6 + i, k] + z * pairs[frame + 12 + i, k]
            )


def _add_turned(pairs, hidden, way, n, out):
    """Add a vector that is known after turn a."""
    x, y, z = way
    for k in side_by_side(n):
        c, s = hidden[0, k], hidden[1, k]
        pairs[out, k] += c * x - s * y
        pairs[out + 1, k] += s * x + c * y
        pairs[out + 2, k] += z


def _ways(n, arm):
    """The way round the loop without the slides, and the directions of these."""
    segments, hidden, pairs = arm["segments"], arm["hidden"], arm["pairs_of_slides"]
    ways, where = arm["ways"], arm["where"]
    D, S, R, Q = segments[0], segments[1], segments[2], segments[3]
    for i in range(WAY, NORMAL):
        for k in side_by_side(n):
            pairs[i, k] = 0.0
    x, y, z = Q[0, 3], Q[1, 3], Q[2, 3]
    for i in range(3):
        for k in side_by_side(n):
            pairs[WAY + i, k] = Q[0, i] * x + Q[1, i] * y + Q[2, i] * z
    _add_turned(pairs, hidden, (D[0, 3], D[1, 3], D[2, 3]), n, WAY)
    _add_along(pairs, B_X, (S[0, 3], S[1, 3], S[2, 3]), n, WAY)
    x, y, z = R[0, 3], R[1, 3], R[2, 3]
    back = (
        R[0, 0] * x + R[1, 0] * y + R[2, 0] * z,
        R[0, 1] * x + R[1, 1] * y + R[2, 1] * z,
        R[0, 2] * x + R[1, 2] * y + R[2, 2] * z,
    )
    _add_along(pairs, E_X, back, n, WAY)
    for i in range(2):
        way, out = (ways[i, 0], ways[i, 1], ways[i, 2]), FIRST + 6 * i
        if where[i] == 0:
            _add_turned(pairs, hidden, way, n, out)
        elif where[i] == 1:
            _add_along(pairs, B_X, way, n, out)
        elif where[i] == 2:
            _add_along(pairs, E_X, way, n, out)
        else:
            for r in range(3):
                for k in side_by_side(n):
                    pairs[out + r, k] = ways[i, r]


def _cross_pairs(n, pairs):
    """The product of the directions of the slides."""
    for i in range(3):
        j, m = (i + 1) % 3, (i + 2) % 3
        for k in side_by_side(n):
            a, b = pairs[FIRST + j, k], pairs[FIRST + m, k]
            c, d = pairs[SECOND + j, k], pairs[SECOND + m, k]
            e, f = pairs[FIRST + 3 + j, k], pairs[FIRST + 3 + m, k]
            g, h = pairs[SECOND + 3 + j, k], pairs[SECOND + 3 + m, k]
            pairs[NORMAL + i, k] = a * d - b * c + pairs[SQUARE, k] * (e * h - f * g)
            pairs[NORMAL + 3 + i, k] = a * h - b * g + e * d - f * c


def _take_axis(turn, n, pairs):
    """The axis of a turn, 0 to 3, in place of that product."""
    for i in range(6):
        for k in side_by_side(n):
            if turn == 0:
                pairs[NORMAL + i, k] = 1.0 if i == 2 else 0.0
            elif turn == 1:
                pairs[NORMAL + i, k] = pairs[B_Z + i, k]
            elif turn == 2:
                pairs[NORMAL + i, k] = pairs[AXIS_C + i, k]
            else:
                pairs[NORMAL + i, k] = pairs[E_Z + i, k]


def sample_two_slides(n, arm):
    """F at n values of turn a, in ``hidden`` of the record, to ``determinant``."""
    pairs, determinant, normal = arm["pairs_of_slides"], arm["determinant"], arm["normal"]
    _directions(n, arm)
    _ways(n, arm)
    if normal < 0:
        _cross_pairs(n, pairs)
    else:
        _take_axis(normal, n, pairs)
    # the axes of b and e are never along what becomes infinite
    finite = normal == 1 or normal == 3
    for k in side_by_side(n):
        way, other = _load(pairs, WAY, k), _load(pairs, WAY + 3, k)
        across, also = _load(pairs, NORMAL, k), _load(pairs, NORMAL + 3, k)
        square = pairs[SQUARE, k]
        p = dot(across, way) + square * dot(also, other)
        q = dot(across, other) + dot(also, way)
        pairs[F, k], pairs[F + 1, k] = p, q
        factor, w2 = 1.0 if finite else pairs[TIMES, k], abs(square)
        determinant[k] = (p * p - square * q * q) * factor
        size = (dot(across, across) + w2 * dot(also, also)) * factor
        pairs[SIZE, k] = size * (dot(way, way) + w2 * dot(other, other))


def hides_solutions(arm):
    """Whether axes are parallel, or nearly, so that F may have no root at some solutions."""
    segments, least = arm["segments"], PARALLEL * PARALLEL
    D, S, R, Q = segments[0], segments[1], segments[2], segments[3]
    before = S[0, 2] * S[0, 2] + S[1, 2] * S[1, 2]
    after = R[2, 0] * R[2, 0] + R[2, 1] * R[2, 1]
    if before < least or after < least:
        return True
    # b and e are at their least angle, or their largest one, where a turns them into one plane
    b = math.sqrt(D[0, 2] * D[0, 2] + D[1, 2] * D[1, 2])
    e = math.sqrt(Q[2, 0] * Q[2, 0] + Q[2, 1] * Q[2, 1])
    for turn in range(2):
        sign = 1.0 if turn == 0 else -1.0
        sine, k_z = b * Q[2, 2] - sign * D[2, 2] * e, Q[2, 2] * D[2, 2] + sign * b * e
        C = S[2, 2] - k_z * R[2, 2]
        if sine * sine * after + C * C < LOOSE * LOOSE:
            return True
    return False


def says_nothing(n, arm):
    """Whether F vanishes but for rounding at n samples."""
    for k in range(n):
        if abs(arm["determinant"][k]) > VANISHED * arm["pairs_of_slides"][SIZE, k]:
            return False
    return True
