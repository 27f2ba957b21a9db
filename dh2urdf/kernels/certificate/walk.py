"""Whether a solution moves: a family is named when a walk along it stays within ``ACCEPT``.

The walk, of one turn, is tried by a hundredth part of it, ``LENGTHS``, which may lead off the pose
by as small a part of what is accepted. It goes in a direction in which the Jacobian says that the
tool stays, and is brought back across such directions by Newton's method. At a double root it comes
back to where it began, beside a family it ends off the pose, on one it arrives. Where two joints
are at a double root all along a family, such directions are no tangents of it: then Newton's method
goes by all directions, and where it ends tells the way.
"""

import math

import numpy as np

from dh2urdf.kernels.certificate.certify import ACCEPT, EVERY_JOINT
from dh2urdf.kernels.certificate.directions import add_step, look_at_some
from dh2urdf.kernels.newton import make_damped, pose_residual
from dh2urdf.kernels.numbers import sincos

LENGTHS = (0.05, 2e-3, 1e-4)
"""Length of the part [rad or m]: solutions on a shorter loop count as isolated. The last two are
for families that a closed form tells of: beside an arm that is stretched they are short loops."""

PART = 0.01
"""The part of ``ACCEPT`` that ``LENGTHS[0]`` may add to the residual of where it begins."""

TOLD = 0.025
"""That part where a closed form tells which joints move, and only these walk: turned all the way
round an axis that it misses by half of ``ACCEPT``, a point is off by no more than that."""

ALONE = (0.025, 0.1)
"""That part where some joints walk alone, without the help of others: first, and at least."""

FLAT = 1e-5
"""Singular value, relative to the largest, of a direction in which a walk may go."""

NOTHING = 1e-12
"""The same of a direction in which Newton's method has nothing to say."""

STEPS, MOST = 24, 0.1
"""Newton steps back to the family, and the longest of them [rad or m]."""

ANGLES, HALVINGS = 24, 10
"""Directions between two that are tried, in half a turn, and steps to the best of them."""

DONE = 1e-14
"""Residual [m and rad] at which nothing is left to gain."""

PARTS = 4
"""Parts in which the way back is looked at: on a family, and not between two solutions, it is
accepted, too."""

MOVES = (1e-5, 1e-7, 1e-10, 1e-12)
"""Motion [rad or m] of a joint over the walk that makes it free, the largest by which the joints
that move walk alone. Where singularities meet, some move by very little, but have to."""


def _come_back(chain, T, q, way, length, floor, mask, trial, room):
    """Newton's method from ``length`` along ``way``, to trial (n,); whether it ends away from q."""
    longest, last = 0.0, math.inf
    for i in range(q.shape[0]):
        trial[i] = q[i] + length * way[i]
        longest = max(longest, abs(way[i]))
    for k in range(STEPS):
        residual, away = pose_residual(chain, T, trial), 0.0
        for i in range(q.shape[0]):
            away = max(away, abs(trial[i] - q[i]))
        if away < 0.5 * length * longest:
            return False
        if residual <= DONE or (k > 2 and residual > 0.9 * last):
            break
        last = residual
        _, largest = look_at_some(chain, T, trial, mask, room)
        add_step(chain, 1.0, trial, room, floor * largest, MOST)
    return True


def _arrives(chain, T, q, way, length, added, floor, mask, trial, room):
    """Whether Newton's method, from ``length`` along ``way``, ends on the family: in trial (n,).

    There the residual is more by ``added`` at most. Not if it comes back to q (n,), as it does at
    a double root.
    """
    if not _come_back(chain, T, q, way, length, floor, mask, trial, room):
        return False
    aside = 0.0
    for i in range(q.shape[0]):
        aside = max(aside, abs(trial[i] - q[i] - length * way[i]))
    if floor < FLAT and aside > 0.5 * length:
        return False
    return pose_residual(chain, T, trial) <= min(pose_residual(chain, T, q) + added, ACCEPT)


def _walks(chain, T, q, way, length, part, floor, mask, trial, room):
    """Whether a walk from q (n,) along ``way`` arrives at all of its parts; its end in trial.

    What it may add counts for the whole: it is uneven where a valley bends.
    """
    added = part * ACCEPT * length / LENGTHS[0]
    for k in range(PARTS):
        some = length * (PARTS - k) / PARTS
        if not _arrives(chain, T, q, way, some, added, floor, mask, trial[k], room):
            return False
    return True


def _add_moved(q, end, moved):
    """Raise the motions of joints, moved (n,), to those of a walk from q (n,) to its end."""
    for i in range(q.shape[0]):
        moved[i] = max(moved[i], abs(end[i] - q[i]))


def _walks_turned(chain, T, q, ways, flat, length, part, mask, trial, room, moved):
    """Whether a walk arrives that starts as Newton's method by all directions says.

    From ``ways``, ``flat`` unit vectors in which the tool stays; the row after them is scratch.
    """
    way, found = ways[flat], False
    for k in range(2 * flat):
        for i in range(q.shape[0]):
            way[i] = ways[k // 2, i] if k % 2 == 0 else -ways[k // 2, i]
        if not _come_back(chain, T, q, way, length, NOTHING, mask, trial[0], room):
            continue
        size = 0.0
        for i in range(q.shape[0]):
            way[i] = trial[0, i] - q[i]
            size += way[i] * way[i]
        way /= math.sqrt(size)
        if _walks(chain, T, q, way, length, part, NOTHING, mask, trial, room):
            found = True
            _add_moved(q, trial[0], moved)
    return found


def _off(chain, T, q, ways, angle, length, mask, trial, room):
    """How far off the pose a point is, ``length`` from q (n,) at an angle between two directions.

    They are the first two of ``ways``; the one that is gone in is left in the third.
    """
    s, c = sincos(angle)
    for i in range(q.shape[0]):
        ways[2, i] = c * ways[0, i] + s * ways[1, i]
    if not _come_back(chain, T, q, ways[2], length, FLAT, mask, trial, room):
        return math.inf
    return pose_residual(chain, T, trial)


def _walks_between(chain, T, q, ways, length, part, mask, trial, room, moved):
    """Whether a walk arrives in a direction between two in which the tool stays.

    Where curves of solutions cross, each leaves in one of them: where the pose is kept best.
    """
    found, step = False, math.pi / ANGLES
    off = np.empty(ANGLES)
    for k in range(ANGLES):
        off[k] = _off(chain, T, q, ways, k * step, length, mask, trial[0], room)
    for k in range(ANGLES):
        if off[k] > off[k - 1 if k > 0 else ANGLES - 1] or off[k] >= off[(k + 1) % ANGLES]:
            continue
        angle, best, reach = k * step, off[k], step
        for _ in range(HALVINGS):
            reach *= 0.5
            for side in range(2):
                other = angle + (reach if side == 0 else -reach)
                less = _off(chain, T, q, ways, other, length, mask, trial[0], room)
                if less < best:
                    angle, best = other, less
                    break
        for side in range(2):
            _off(chain, T, q, ways, angle + side * math.pi, length, mask, trial[0], room)
            if _walks(chain, T, q, ways[2], length, part, NOTHING, mask, trial, room):
                found = True
                _add_moved(q, trial[0], moved)
                break
    return found


def _walks_one(chain, T, q, way, length, part, floor, mask, trial, room, moved):
    """Whether a walk along ``way`` or against it arrives."""
    for _ in range(2):
        if _walks(chain, T, q, way, length, part, floor, mask, trial, room):
            _add_moved(q, trial[0], moved)
            return True
        for i in range(q.shape[0]):
            way[i] = -way[i]
    return False


def _floor_above(sigma, k, mask, largest):
    """Singular value, relative to the largest, half way from number k to the next of the mask.

    ``FLAT`` at most.
    """
    next_ = FLAT * largest
    for i in range(sigma.shape[0]):
        if mask >> i & 1 and i != k and sigma[k] <= sigma[i] < next_:
            next_ = sigma[i]
    return min(FLAT, math.sqrt(sigma[k] * next_) / largest) if largest > 0.0 else FLAT


def joints_that_move(chain, T, q, length, part, mask, moved):
    """How far joints of a mask move along a family of solutions through q (n,); if at all.

    Each direction in which the tool stays is walked both ways, unless the first arrives. If none
    does, and there are several, one at a time is, and the less flat ones lead back; then those
    between them. ``moved`` (n,) is the largest motion of each joint.
    """
    n, found = q.shape[0], False
    room = make_damped(n), np.empty((n, n)), np.empty(n), np.empty(n)
    ways, floors, trial = np.empty((n + 2, n)), np.zeros(n), np.empty((PARTS, n))
    trial[0] = q
    moved[:] = 0.0
    _, largest = look_at_some(chain, T, trial[0], mask, room)
    flat = 0
    for k in range(n):
        if mask >> k & 1 and room[2][k] <= FLAT * largest:
            ways[flat] = room[1][k]
            floors[flat] = _floor_above(room[2], k, mask, largest)
            flat += 1
    for k in range(flat):
        if _walks_one(chain, T, q, ways[k], length, part, FLAT, mask, trial, room, moved):
            found = True
    if found or flat < 2:
        return found
    for k in range(flat):
        own = floors[k]
        if own <= NOTHING or own >= FLAT:
            continue
        if _walks_one(chain, T, q, ways[k], length, part, own, mask, trial, room, moved):
            found = True
    if not found:
        found = _walks_turned(chain, T, q, ways, flat, length, part, mask, trial, room, moved)
    if not found and flat == 2:
        found = _walks_between(chain, T, q, ways, length, part, mask, trial, room, moved)
    return found


def free_of(chain, T, q, length, mask, alone):
    """Bits of the joints of a mask that walk along a family through q (n,); 0: none.

    ``alone``: the others do not move at all, which is tried.
    """
    moved, other, bits = np.empty(q.shape[0]), np.empty(q.shape[0]), 0
    part = PART if mask == EVERY_JOINT else TOLD
    if not joints_that_move(chain, T, q, length, part, mask, moved):
        return 0
    for asked in range(len(ALONE)):
        bits = 0
        for least in range(len(MOVES)):
            last, bits = bits, 0
            for i in range(q.shape[0]):
                bits |= (1 if moved[i] > MOVES[least] else 0) << i
            if not alone or bits == mask:
                return bits
            if bits != last and joints_that_move(chain, T, q, length, ALONE[asked], bits, other):
                return bits
    return 0
