"""Self-motions walked by the referee: from a solution along a family, to a configuration or away.

Steps go along the directions in which the pose does not change, and are brought back across them
by Newton's method; only the joints that may move do. Where the Jacobian is flat in directions in
which nothing moves, as at a double root all along a family, Newton's method ends by all of them.
"""

from itertools import islice

import numpy as np
from ik_referee import error_vectors, frames, gaps, jacobians, jacobians_at, larger_of, residuals

ACCEPT = 1e-9
"""Residual [m and rad] of a point of a family."""

FLAT = 1e-5
"""Singular value, relative to the largest, of a direction in which a walk may go."""

LEAST = 1e-12
"""The same of a direction in which Newton's method has nothing to say."""

LENGTHS = (0.05, 2e-3, 1e-4)
"""How far a family is walked to be one [rad or m]; shorter where it is a short loop."""

FINE = 1e-4
"""How far Newton's method by all directions may take what is accepted as it is [rad or m]."""

STEP = 0.1
"""Steps of a walk round a family [rad or m], and their number each way, some 40 rad: curves of 31
are known. Round a short loop they are shorter, and where curves nearly cross, of which so many
times more are made."""
MOST = 400
SHORT = 0.004
SHORTER = 10

LEFT = 3.5
"""Steps after which a walk may be back where it began."""

TURN = int(2.0 * np.pi / STEP)
"""Steps of a walk of one turn."""

FLATTEST = 1e-3
"""Singular value, in parts of the next one, of the one direction of a curve among weak others."""

SHARP = 1e-13
"""Residual [m and rad] of the points of such a curve, in directions in which the tool still moves:
between two of them it is more."""

ANGLES = 24
"""Directions round a point where curves may cross that are looked at."""

REACHED = 1e-12
"""Residual [m and rad] below which it is rounding that tells two of them apart."""


def wrapped(arm, d):
    """Joint differences, angles in (-pi, pi]."""
    return np.where(arm.prismatic, d, np.arctan2(np.sin(d), np.cos(d)))


def directions(arm, p, free):
    """Singular values and right vectors (k, n) of the Jacobian of the joints that may move."""
    J = jacobians(arm, p)[:, free]
    J[:3] /= arm.size
    _, sigma, Vt = np.linalg.svd(J)
    whole = np.zeros((len(Vt), arm.n))
    whole[:, free] = Vt
    return np.append(sigma, np.zeros(len(Vt) - len(sigma))), whole


def back(arm, p, T, free, goal=1e-14):
    """The point of the family next to p, and its residual.

    Across the flat directions; by all, where these leave a residual and that ends near by.
    """
    p, off = newton(arm, p, T, free, FLAT, 8, goal)
    if off > 10.0 * goal:
        whole, rest = newton(arm, p, T, free, LEAST, 30, goal)
        if gaps(arm, whole, p) <= (0.3 * STEP if off > ACCEPT else FINE) and rest < off:
            return whole, rest
    return p, off


def newton(arm, p, T, free, least, most, goal):
    """Newton's method from p by directions of singular values above ``least`` of the largest.

    Where it comes to, and the residual there.
    """
    for k in range(most + 1):
        placed = frames(arm, p)
        error = error_vectors(placed[-1], T)
        residual = larger_of(error)
        if residual < goal or k == most:
            break
        step = np.linalg.pinv(jacobians_at(arm, placed)[:, free], rcond=least) @ error
        p = p.copy()
        p[free] += np.clip(step, -0.1, 0.1)
    return p, residual


def walks_to(arm, p, q, T, free, tolerance, accept=ACCEPT):
    """Whether going straight for q from p, along the family, arrives."""
    last = np.inf
    for _ in range(100):
        d = wrapped(arm, q - p)
        far = np.abs(d).max()
        if far <= tolerance:
            return True
        if far > 0.999 * last or np.abs(d[~free]).max(initial=0.0) > tolerance:
            return False
        last = far
        sigma, V = directions(arm, p, free)
        flat = V[sigma < FLAT * sigma[0]]
        step = flat.T @ (flat @ d)
        step *= min(1.0, STEP / max(np.abs(step).max(), 1e-300))
        if gaps(arm, p + step, q) <= tolerance and residuals(arm, p + step, T) <= accept:
            return True
        p, residual = back(arm, p + step, T, free)
        if residual > accept:
            return False
    return False


def tangent_at(arm, p, free, before):
    """Unit direction of the family at p, nearest to that before; None where nothing is flat.

    And the least singular value of the others: it is small where two curves nearly cross.
    """
    sigma, V = directions(arm, p, free)
    flat = sigma < FLAT * sigma[0]
    if not flat.any():
        return None, 0.0
    ahead = V[flat].T @ (V[flat] @ before)
    size = np.linalg.norm(ahead)
    return ahead / size if size > 1e-3 else None, sigma[~flat].min(initial=np.inf)


def round_walk(arm, p, T, free, ahead, step=STEP, careful=False):
    """Points of the family through p, on a walk that starts in a direction.

    Carefully, steps are shorter where another curve comes near, which a walk would go on by.
    """
    start, gone = p, 0.0
    for _ in range(SHORTER * MOST if careful else MOST):
        ahead, apart = tangent_at(arm, p, free, ahead)
        if ahead is None:
            return
        whole = min(step, max(apart, SHORT)) if careful else step
        for part in (whole, 0.2 * whole):  # where the curve bends, a shorter one
            next_, residual = back(arm, p + part * ahead, T, free)
            way = wrapped(arm, next_ - p)
            if residual <= ACCEPT and 0.1 * part < np.linalg.norm(way) < 2.0 * part:
                break
        else:
            return
        p, ahead, gone = next_, way, gone + np.linalg.norm(way)
        yield p
        if gone > LEFT * step and np.abs(wrapped(arm, p - start)).max() < 0.6 * step:
            return


def goes_on(arm, p, T, free):
    """Whether a walk from p by these joints, both ways, is accepted for a turn, or comes round."""
    sigma, V = directions(arm, p, free)
    for way in V[sigma < FLAT * max(sigma[0], 1e-300)]:
        steps = 0
        for side in (1.0, -1.0):
            points = list(islice(round_walk(arm, p, T, free, side * way), TURN))
            steps += len(points)
            round_ = len(points) > 4 and gaps(arm, points[-1], p) < 0.6 * STEP
            if round_ or steps >= TURN:
                return True
    return False


def on_family(arm, p, q, T, free, tolerance):
    """Whether the family of p, of which the joints ``free`` (n,) move, contains q."""
    if np.abs(wrapped(arm, q - p)[~free]).max(initial=0.0) > tolerance:
        return False
    if walks_to(arm, p, q, T, free, tolerance):
        return True
    sigma, V = directions(arm, p, free)
    flat = V[sigma < FLAT * sigma[0]]
    rng = np.random.default_rng(0)
    ways = flat if len(flat) == 1 else [v @ flat for v in rng.normal(size=(6, len(flat)))]
    walks = [(STEP, False)]
    walks += [(SHORT, False)] if gaps(arm, p, q) < MOST * SHORT else []
    walks += [(STEP, True)] if len(flat) == 1 else []
    for step, careful in walks:
        for way in (side * way for way in ways for side in (1.0, -1.0)):
            for k, point in enumerate(round_walk(arm, p, T, free, way, step, careful)):
                near = gaps(arm, point, q) < 3 * step or (len(flat) > 1 and k % 10 == 0)
                if near and walks_to(arm, point, q, T, free, tolerance):
                    return True
    return len(flat) > 1 and on_curve(arm, p, q, T, free, tolerance)


def on_curve(arm, p, q, T, free, tolerance):
    """Whether the one curve through p that keeps the pose to rounding contains q.

    Where an elbow is folded, the tool hardly moves in other directions, but by more than is
    accepted: a walk by all of them leaves the pose.
    """
    for side in (1.0, -1.0):
        ahead, at = None, p
        for k in range(4 * MOST):
            sigma, V = directions(arm, at, free)
            ahead = V[-1] * (side if ahead is None else np.sign(V[-1] @ ahead))
            at = sharpened(arm, at + 0.5 * STEP * ahead, T, free)
            if sigma[-1] > FLATTEST * sigma[-2] or not keeps(arm, at, T, free):
                break
            foot = at
            for _ in range(4 if gaps(arm, at, q) < STEP else 0):
                way = directions(arm, foot, free)[1][-1]
                foot = sharpened(arm, foot + (way @ wrapped(arm, q - foot)) * way, T, free)
                if gaps(arm, foot, q) <= tolerance and keeps(arm, foot, T, free):
                    return True
            if k > 3 and gaps(arm, at, p) < 0.3 * STEP:
                break
    return False


def sharpened(arm, p, T, free):
    """The solution next to p, across strong directions first and then by all but the flattest."""
    return newton(arm, newton(arm, p, T, free, FLAT, 8, 1e-14)[0], T, free, 1e-11, 12, 1e-15)[0]


def keeps(arm, p, T, free):
    """Whether the pose at p is accepted, and T to rounding but for where the tool hardly moves.

    Of all that moves it least the effect may be rounding itself, and no point of a curve exact.
    """
    placed = frames(arm, p)
    error, J = error_vectors(placed[-1], T), jacobians_at(arm, placed)[:, free]
    weakest = np.linalg.svd(J, full_matrices=False)[0][:, -1]
    across = error if J.shape[1] > 6 else error - weakest * (weakest @ error)
    return larger_of(error) <= ACCEPT and larger_of(across) <= SHARP


def is_family(arm, p, T, free, accept=ACCEPT, lengths=LENGTHS, crossing=True):
    """Whether a walk from p by these joints, of one of some lengths, is one.

    ``crossing``: between two flat directions, too.
    """
    sigma, V = directions(arm, p, free)
    ways = V[sigma < 1e-4 * max(sigma[0], 1e-300)] if len(V) else V
    return any(
        _walks(arm, p, T, free, side * length * way, accept * length / LENGTHS[0])
        for length in lengths
        for way in ways
        for side in (1.0, -1.0)
    ) or any(
        _walks(arm, p, T, free, length * way, accept * length / LENGTHS[0])
        for length in lengths
        for way in (crossing_ways(arm, p, T, free, length) if crossing else ())
    )


def crossing_ways(arm, p, T, free, length):
    """Directions between two flat ones in which the pose is kept best: where curves cross at p.

    Best is the point of the pose that is next; where the pose is not reached, the least residual.
    """
    sigma, V = directions(arm, p, free)
    flat = V[sigma < FLAT * sigma[0]]
    if len(flat) != 2:
        return []

    def off(angle):
        start = p + length * (np.cos(angle) * flat[0] + np.sin(angle) * flat[1])
        point, residual = newton(arm, start, T, free, FLAT, 8, 1e-14)
        return np.linalg.norm(point - start) if residual < REACHED else 1.0 + residual

    angles = np.linspace(0.0, 2.0 * np.pi, ANGLES, endpoint=False)
    least = np.array([off(angle) for angle in angles])
    ways = []
    for k in np.flatnonzero((least <= np.roll(least, 1)) & (least < np.roll(least, -1))):
        angle, reach = angles[k], angles[1]
        while reach > 1e-3:
            reach *= 0.5
            angle = min((angle, angle - reach, angle + reach), key=off)
        ways.append(np.cos(angle) * flat[0] + np.sin(angle) * flat[1])
    return ways


def _walks(arm, p, T, free, way, accept):
    """Whether a way from p and its half are on a family, but for as much as leads back to it."""
    for part in (1.0, 0.5):
        point, residual = back(arm, p + part * way, T, free)
        aside = np.linalg.norm(wrapped(arm, point - p - part * way))
        if residual > accept or aside > 0.5 * part * np.linalg.norm(way):
            return False
    return True
