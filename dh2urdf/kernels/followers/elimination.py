"""Six equations in two joints of a closed chain, at each value of a leader with followers.

The loop is cut as for six turning joints (:mod:`dh2urdf.kernels.general_6r.elimination`):

    H_2 C Z_4 H_3 C Z_5 H_4 C [e3 e4]  =  C_2^-1 Z_2^-1 C_1^-1 Z_1^-1 C_6^-1 [e3 e4]

where H are the leader and its followers, anywhere between joints 2 and 6. The right side and the
null space of its eight non-constant columns are free of them; so the six equations are worked out
for any number of values of the leader side by side, a lane each.
"""

from dh2urdf.kernels.general_6r import (
    HALF_SQRT3,
    INV_SQRT3,
    SQRT2,
    invert,
    line_functions,
    reduce_right,
    right_coefficients,
)
from dh2urdf.kernels.numbers import LANES, side_by_side
from dh2urdf.kernels.rigid import load_pose

LINE = 6 * LANES
TERMS = 9


def joint_of(arm, e, i):
    """The joint that label i stands for in elimination e."""
    n, shift = arm["motions"], arm["choices"][e, 0]
    return (shift + i) % n if arm["choices"][e, 1] == 0 else (2 * n - 1 - shift - i) % n


def close_loop(e, arm):
    """Write the transforms after each label, and what moves it, for elimination e.

    Label i is joint ``(shift + i) % n``; reversed, ``(n - 1 - shift - i) % n`` with the opposite
    angle. The target lies between the last joint and the first.
    """
    n, chain, loop = arm["motions"], arm["chain"], arm["loop"]
    reverse = arm["choices"][e, 1] != 0
    for i in range(n):
        joint = joint_of(arm, e, i)
        arm["kinds"][i] = arm["factors"][joint]
        after = (joint + n - 1) % n if reverse else joint
        if (after == n - 1) != reverse:
            invert(chain[after], loop[i])
        else:
            loop[i] = chain[after]
    arm["outer"][0], arm["outer"][1], arm["outer"][5] = loop[0], loop[1], loop[n - 1]


def eliminate(e, arm):
    """The right side of elimination e, reduced."""
    close_loop(e, arm)
    right_coefficients(arm["outer"], arm["slides"], 1.0, arm["samples"], arm["right"])
    reduce_right(arm["right"], arm["reflectors"], arm["basis"])


def turn_followers(n, arm):
    """Cosines and sines of the leader and its followers along the loop, from ``block``."""
    kinds, block, cosines, sines = (
        arm["kinds"],
        arm["block"],
        arm["loop_cosines"],
        arm["loop_sines"],
    )
    for i in range(2, arm["motions"] - 1):
        if kinds[i] == 0:
            continue
        o, sign = i * LANES, 1.0 if kinds[i] > 0 else -1.0
        for k in side_by_side(n):
            cosines[o + k], sines[o + k] = block[0, k], sign * block[1, k]
        for _ in range(abs(kinds[i]) - 1):
            for k in side_by_side(n):
                c, s, d, t = cosines[o + k], sines[o + k], block[0, k], sign * block[1, k]
                cosines[o + k], sines[o + k] = c * d - s * t, s * d + c * t


def _turn_lines(count, label, n, arm):
    """Turn lines by the angle of a label."""
    lines, o = arm["lines"], label * LANES
    cosines, sines = arm["loop_cosines"], arm["loop_sines"]
    for i in range(2 * count):
        x, y = 3 * i * LANES, (3 * i + 1) * LANES
        for k in side_by_side(n):
            c, s, u, v = cosines[o + k], sines[o + k], lines[x + k], lines[y + k]
            lines[x + k], lines[y + k] = c * u - s * v, s * u + c * v


def _spread_lines(count, n, lines):
    """Lines as they are, turned by 120 and by -120 degrees: three times as many."""
    for b in range(1, 3):
        s = HALF_SQRT3 if b == 1 else -HALF_SQRT3
        for i in range(2 * count):
            source, target = 3 * i * LANES, 3 * (2 * count * b + i) * LANES
            for k in side_by_side(n):
                u, v = lines[source + k], lines[source + LANES + k]
                lines[target + k] = -0.5 * u - s * v
                lines[target + LANES + k] = s * u - 0.5 * v
                lines[target + 2 * LANES + k] = lines[source + 2 * LANES + k]


def _move_lines(link, count, n, lines):
    """Move lines by a link (3, 4)."""
    a00, a01, a02, a03, a10, a11, a12, a13, a20, a21, a22, a23 = load_pose(link)
    for i in range(2 * count):
        o, one = 3 * i * LANES, float(i % 2)
        x, y, z = one * a03, one * a13, one * a23
        for k in side_by_side(n):
            u, v, w = lines[o + k], lines[o + LANES + k], lines[o + 2 * LANES + k]
            lines[o + k] = a00 * u + a01 * v + a02 * w + x
            lines[o + LANES + k] = a10 * u + a11 * v + a12 * w + y
            lines[o + 2 * LANES + k] = a20 * u + a21 * v + a22 * w + z


def _nine_lines(n, arm):
    """Axis 6 seen from joint 2, for three values each of joints 4 and 5, at n values of the leader.

    Line ``3 b + c`` for sample b of joint 4 and c of joint 5: its direction, then a point on it.
    """
    loop, kinds, lines, last = arm["loop"], arm["kinds"], arm["lines"], arm["motions"] - 2
    for r in range(3):
        for k in side_by_side(n):
            lines[r * LANES + k] = loop[last, r, 2]
            lines[(3 + r) * LANES + k] = loop[last, r, 3]
    count = 1
    for back in range(last - 1):
        label = last - back
        if kinds[label] == 0:
            _spread_lines(count, n, lines)
            count *= 3
        else:
            _turn_lines(count, label, n, arm)
        if label > 2:
            _move_lines(loop[label - 1], count, n, lines)


def _project(term, n, arm):
    """The fourteen functions of one of the nine lines, on the null space: one term of six."""
    lines, functions, equations = arm["lines"], arm["functions"], arm["equations"]
    o, basis = term * LINE, arm["basis"]
    for k in side_by_side(n):
        way = lines[o + k], lines[o + LANES + k], lines[o + 2 * LANES + k]
        p = o + 3 * LANES
        point = lines[p + k], lines[p + LANES + k], lines[p + 2 * LANES + k]
        line_functions((way, point), functions, k)
    for r in range(6):
        e, w0 = (TERMS * r + term) * LANES, basis[8 + r, 0]
        for k in side_by_side(n):
            equations[e + k] = w0 * functions[0, k]
        for f in range(1, 14):
            w = basis[8 + r, f]
            for k in side_by_side(n):
                equations[e + k] += w * functions[f, k]


def _powers(equations, e, stride, scale, n):
    """Three samples in ``(1, 2 t / scale, t^2)``, t the tangent of the half, times 1 + t^2."""
    one, two = e + stride * LANES, e + 2 * stride * LANES
    for k in side_by_side(n):
        y0, y1, y2 = equations[e + k], equations[one + k], equations[two + k]
        equations[one + k] = (y1 - y2) * scale * INV_SQRT3
        equations[two + k] = (2.0 * (y1 + y2) - y0) / 3.0


def six_equations(n, arm):
    """Six equations in powers of joints 4 and 5 at n values of the leader, in ``block``.

    Entry ``9 r + 3 i + j`` of ``equations``, a run of lanes each: equation r, x^i, y^j.
    """
    equations, right, basis = arm["equations"], arm["right"], arm["basis"]
    turn_followers(n, arm)
    _nine_lines(n, arm)
    for term in range(TERMS):
        _project(term, n, arm)
    for r in range(6):
        row, constant = TERMS * r * LANES, 0.0
        for f in range(14):
            constant += basis[8 + r, f] * right[8, f]
        for j in range(3):
            _powers(equations, row + j * LANES, 3, 2.0, n)
        for i in range(3):
            _powers(equations, row + 3 * i * LANES, 1, SQRT2, n)
            if i != 1:
                for k in side_by_side(n):
                    equations[row + 3 * i * LANES + k] -= constant
                    equations[row + (3 * i + 2) * LANES + k] -= constant
