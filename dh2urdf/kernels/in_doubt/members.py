"""One of each family of solutions, and no points of a valley beside exact solutions."""

import numpy as np

from dh2urdf.kernels.certificate import look, move, same, swap
from dh2urdf.kernels.newton import POSE, STAYING, make_damped
from dh2urdf.kernels.redundant import HELD, members_among

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""

STEP, MOST_STEPS = 0.1, 200
"""Step of a walk along a family [rad or m], and how many each way."""

FLAT = 1e-5
"""Singular value, relative to the largest, of a direction in which a family goes on."""

FAMILIES, TRIALS = 4, 2
"""Families of a pose whose members are looked for at any distance, a few milliseconds each; and
after how many ways that lead nowhere this is given up."""

ALIKE = 1e-14
"""Residuals [m and rad] below which one member of a family is as good as another."""

DULL, EXACT, VALLEY = 1e-13, 1e-14, 1e-7
"""Residuals [m and rad] of a point of a valley and of a solution beside which it is none, and the
smallest singular value there: along slides a valley is straight, and may be as long as the arm."""


def _hardly_moves(chain, T, unit, q, room):
    """Whether the pose hardly changes in one direction at a configuration q (n,).

    Lengths and slides are in sizes of the arm, or of how far out slides are: partners of a pair may
    be tens of kilometres out, where they are parallel but for 1e-5.
    """
    size = unit
    for i in range(q.shape[0]):
        if chain[1][i, 0] != 0.0:
            size = max(size, abs(q[i]))
    least, _ = look(chain, (POSE, T, size), q, room)
    return room[2][least] < VALLEY


def drop_valleys(chain, T, unit, rows, count):
    """Drop what is accepted along valleys of a pose that has an exact solution; how many are left.

    Of arms with slides.
    """
    (q, residual, branch, free), n, kept = rows, rows[0].shape[1], 0
    room = make_damped(n), np.empty((n, n)), np.empty(n)
    slides, exact = False, False
    for i in range(n):
        slides = slides or chain[1][i, 0] != 0.0
    for k in range(count):
        exact = exact or residual[k] <= EXACT
    if not (slides and exact):
        return count
    for k in range(count):
        dull = residual[k] > DULL and free[k] == 0
        if not (dull and _hardly_moves(chain, T, unit, q[k], room)):
            move(q, residual, branch, free, k, kept)
            kept += 1
    return kept


def _isolated_first(rows, count, key):
    """Order solutions: isolated ones as they are, then members of families, the best first.

    Returns how many are isolated.
    """
    isolated = 0
    for k in range(count):
        alone, j = rows[3][k] == 0, k
        key[k] = -1.0 if alone else max(rows[1][k], ALIKE)
        isolated += 1 if alone else 0
        while j > 0 and key[j] < key[j - 1]:
            swap(rows, key, j, j - 1)
            j -= 1
    return isolated


def dimensions(chain, goal, q, mask, room):
    """In how many directions a family by the joints of a mask leaves a solution q (n,)."""
    _, largest = look(chain, goal, q, room)
    directions = 0
    for i in range(q.shape[0]):
        directions += 1 if mask >> i & 1 and room[2][i] <= FLAT * largest else 0
    return directions


def _mark_members(chain, T, unit, rows, k, count, trials, room):
    """Note which solutions after row k are on its family, by its free joints, as ``gone``."""
    (q, _, _, free), (walk, _, gone, asked) = rows, room
    n, mask, some = q.shape[1], free[k], False
    for j in range(asked.shape[0]):
        asked[j] = k < j < count and not gone[j] and free[j] == mask
        asked[j] = asked[j] and same(chain[1], q[k], q[j], SAME, mask)
        some = some or asked[j]
    if not some:
        return
    looked = make_damped(n), np.empty((n, n)), np.empty(n)
    goal = POSE + STAYING * ((1 << n) - 1 - mask), T, unit
    straight = trials if dimensions(chain, goal, q[k], mask, looked) > 1 else 0
    members_among(chain, goal, STEP, HELD, q[k], q, straight, asked, walk)
    for j in range(k + 1, count):
        gone[j] = gone[j] or asked[j]


def one_of_each_family(chain, T, unit, rows, count, room):
    """Keep the best member of each family of a pose, isolated solutions first; how many are left.

    ``room`` is scratch: a walk (2, steps, n), and what orders rows (k,), and notes of them, twice.
    """
    (_, key, gone, _), families = room, 0
    for k in range(count):
        gone[k] = False
        families += 1 if rows[3][k] != 0 else 0
    if families < 2:
        return count
    kept = _isolated_first(rows, count, key)
    isolated = kept
    for k in range(isolated, count):
        if gone[k]:
            continue
        trials = TRIALS if kept - isolated < FAMILIES else 0
        _mark_members(chain, T, unit, rows, k, count, trials, room)
        move(*rows, k, kept)
        kept += 1
    return kept
