"""From roots to solutions: seeds, Newton's method on the exact chain, a list without doubles."""

import math

from dh2urdf.kernels.certificate import ACCEPT, principal
from dh2urdf.kernels.followers.elimination import joint_of
from dh2urdf.kernels.followers.roots import block_resultants
from dh2urdf.kernels.general_6r import (
    LEFT,
    at_root,
    list_solution,
    outer_joints,
    split_pairs,
    two_joints,
)
from dh2urdf.kernels.newton import factor, normal_equations, polish, pose_residual
from dh2urdf.kernels.numbers import LANES, atan2, null_vectors, side_by_side, sincos
from dh2urdf.kernels.rigid import load_pose


def _frames(n, arm):
    """What is between joint 2 and joint 6, in place at ``LEFT`` of ``frames``."""
    loop, frames, cosines, sines = (
        arm["loop"],
        arm["frames"],
        arm["loop_cosines"],
        arm["loop_sines"],
    )
    for e in range(12):
        for k in side_by_side(n):
            frames[LEFT + e * LANES + k] = loop[1, e // 4, e % 4]
    for i in range(2, arm["motions"] - 1):
        a00, a01, a02, a03, a10, a11, a12, a13, a20, a21, a22, a23 = load_pose(loop[i])
        o = i * LANES
        for row in range(3):
            f = LEFT + 4 * row * LANES
            for k in side_by_side(n):
                u, v, z = frames[f + k], frames[f + LANES + k], frames[f + 2 * LANES + k]
                c, s = cosines[o + k], sines[o + k]
                x, y = u * c + v * s, v * c - u * s
                frames[f + k] = x * a00 + y * a10 + z * a20
                frames[f + LANES + k] = x * a01 + y * a11 + z * a21
                frames[f + 2 * LANES + k] = x * a02 + y * a12 + z * a22
                frames[f + 3 * LANES + k] += x * a03 + y * a13 + z * a23


def _free_label(arm, which):
    """The label of joint 4 (which is 3) or 5 (4): the first or second free one after joint 2."""
    label = 2
    for _ in range(which - 2):
        while arm["kinds"][label] != 0:
            label += 1
        label += 1
    return label - 1


def _copy_run(source, i, target, j, n):
    """Copy run i of lanes to run j."""
    for k in side_by_side(n):
        target[j * LANES + k] = source[i * LANES + k]


def seeds(roots, first, count, copies, arm):
    """All joints of the loop at some roots, in lanes; two of each in neighbours if ``copies`` is 2.

    Returns the number of lanes in use.
    """
    b, second, block = arm["null"], arm["second"], arm["block"]
    c, s, lc, ls = arm["cosines"], arm["sines"], arm["loop_cosines"], arm["loop_sines"]
    lanes = count * copies
    n = (lanes + 7) // 8 * 8
    for k in side_by_side(n):
        root = roots[first + min(k // copies, count - 1)]
        block[0, k], block[1, k] = sincos(root)[1], sincos(root)[0]
    block_resultants(n, arm)
    for copy in range(copies):
        null_vectors(arm["W"], b, second if copy > 0 else b, copy == 0, n)
    if copies == 2:
        split_pairs(b, second, n)
    two_joints(b, n, c, s)
    for which in range(3, 5):
        label = _free_label(arm, which)
        _copy_run(c, which, lc, label, n)
        _copy_run(s, which, ls, label, n)
    _frames(n, arm)
    outer_joints(
        arm["outer"],
        arm["slides"],
        1.0,
        arm["right"],
        arm["reflectors"],
        arm["basis"],
        arm["frames"],
        n,
        c,
        s,
        arm["functions"],
        arm["pairs"],
    )
    last = arm["motions"] - 1
    for which in range(3):
        label, run = (last, 5) if which == 2 else (which, which)
        _copy_run(c, run, lc, label, n)
        _copy_run(s, run, ls, label, n)
    return lanes


def read_lane(e, root, lane, arm):
    """The values q (6,) of a lane of the loop at a root."""
    q, zeros, kinds = arm["q"], arm["zeros"], arm["kinds"]
    sign = 1.0 if arm["choices"][e, 1] == 0 else -1.0
    leader = arm["leader"]
    q[leader] = principal(sign * root + zeros[leader])
    for i in range(arm["motions"]):
        if kinds[i] == 0:
            v, o = arm["values"][joint_of(arm, e, i)], i * LANES + lane
            angle = sign * atan2(arm["loop_sines"][o], arm["loop_cosines"][o])
            q[v] = principal(angle + zeros[v])


def scaled_determinant(chain, T, q, size, work):
    """Determinant of the Jacobian at q (6,), in parts of size cubed, up to its sign.

    Where several directions are lost, the factor's entries leave the range: then it is zero.
    """
    normal_equations(chain, T, q, work)
    factor(work, 1e-300)
    product = 1.0
    for i in range(6):
        product *= work[i, 8 + i]
    return product / (size * size * size) if product < math.inf else 0.0


def keep(chain, T, found, q, residual, arm, work):
    """Bring the values in ``q`` of the record to the pose and list them, as by `list_solution`."""
    p, size = arm["q"], arm["size"]
    error = polish(chain, T, p, work)
    if not error <= ACCEPT * min(size, 1.0):
        return found, -1
    for i in range(6):
        p[i] = principal(p[i])
    determinant = scaled_determinant(chain, T, p, size, work)
    return list_solution(found, q, residual, error, determinant, arm)


def _leader_value(e, q, arm):
    """The leader's value in the loop of elimination e at a solution q (6,)."""
    value = q[arm["leader"]] - arm["zeros"][arm["leader"]]
    return value if arm["choices"][e, 1] == 0 else -value


def follow(e, count, found, chain, T, q, residual, arm, work):
    """Append the solutions that the roots lead to, as for six turning joints.

    A double root, and one that leads nowhere, to another value of the leader or where another root
    went, are taken for two solutions with the same value of it, and tried again as such. The
    leader's values at all solutions are left in ``hidden_values``. Returns the number of solutions,
    how many roots had to be tried again, and the largest error of the seeds that stood. A complex
    pair next to the real axis need not lead anywhere.
    """
    roots, slopes, seen, doubles = arm["roots"], arm["slopes"], arm["seen"], arm["doubles"]
    bends = arm["bends"]
    again, worst = 0, 0.0
    for copies in range(1, 3):
        list_of, total = roots if copies == 1 else doubles, count if copies == 1 else again
        seen[:] = 0.0
        each = LANES // copies
        for part in range((total + each - 1) // each):
            first = part * each
            lanes = seeds(list_of, first, min(each, total - first), copies, arm)
            for lane in range(lanes):
                r = first + lane // copies
                read_lane(e, list_of[r], lane, arm)
                seeded = pose_residual(chain, T, arm["q"])
                found, place = keep(chain, T, found, q, residual, arm, work)
                led = place >= 0 and seen[place] == 0.0 and copies == 1 and slopes[r] > 0.0
                if copies == 2:
                    worst = max(worst, seeded if place >= 0 or bends[r] != 0.0 else 0.0)
                elif led and at_root(roots[r], _leader_value(e, q[place], arm)):
                    worst = max(worst, seeded)
                else:
                    doubles[again], bends[again] = roots[r], slopes[r]
                    again += 1
                if place >= 0:
                    seen[place] = 1.0
    for k in range(found):
        arm["hidden_values"][k] = _leader_value(e, q[k], arm)
    return found, again, worst
