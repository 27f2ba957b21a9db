"""Self-motions walked by the referee: from a solution along a family, to a configuration or away.

Steps go along the directions in which the pose does not change, and are brought back across them
by Newton's method; only the joints that may move do.
"""

import numpy as np
from ik_referee import error_vectors, forward, gaps, jacobians, residuals

ACCEPT = 1e-9
"""Residual [m and rad] of a point of a family."""

FLAT = 1e-5
"""Singular value, relative to the largest, of a direction in which a walk may go."""

LENGTH = 0.05
"""How far a family is walked to be one [rad or m]."""

STEP = 0.1
"""Steps of a walk round a family [rad or m], and their number each way."""
MOST = 150


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
    """The point of the family next to p, and its residual."""
    for _ in range(8):
        if residuals(arm, p, T) < goal:
            break
        J = jacobians(arm, p)[:, free]
        step = np.linalg.pinv(J, rcond=FLAT) @ error_vectors(forward(arm, p), T)
        p = p.copy()
        p[free] += np.clip(step, -0.1, 0.1)
    return p, residuals(arm, p, T)


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
        p, residual = back(arm, p + step, T, free)
        if residual > accept:
            return False
    return False


def tangent_at(arm, p, free, before):
    """Unit direction of the family at p, nearest to that before; None where nothing is flat."""
    sigma, V = directions(arm, p, free)
    flat = V[sigma < FLAT * sigma[0]]
    if not len(flat):
        return None
    ahead = flat.T @ (flat @ before)
    size = np.linalg.norm(ahead)
    return ahead / size if size > 1e-3 else None


def round_walk(arm, p, T, free, ahead):
    """Points of the family through p, on a walk that starts in a direction."""
    start = p
    for k in range(MOST):
        ahead = tangent_at(arm, p, free, ahead)
        if ahead is None:
            return
        p, residual = back(arm, p + STEP * ahead, T, free)
        if residual > ACCEPT:
            return
        yield p
        if k > 3 and np.abs(wrapped(arm, p - start)).max() < 0.6 * STEP:
            return


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
    for way in ways:
        for side in (way, -way):
            for k, point in enumerate(round_walk(arm, p, T, free, side)):
                near = gaps(arm, point, q) < 3 * STEP or (len(flat) > 1 and k % 10 == 0)
                if near and walks_to(arm, point, q, T, free, tolerance):
                    return True
    return False


def is_family(arm, p, T, free, accept=ACCEPT):
    """Whether a walk of ``LENGTH`` from p, one way or the other, by these joints, is accepted."""
    sigma, V = directions(arm, p, free)
    if not len(V):
        return False
    for way in V[sigma < 1e-4 * max(sigma[0], 1e-300)]:
        for side in (way, -way):
            point, residual = back(arm, p + LENGTH * side, T, free)
            if residual <= accept and gaps(arm, point, p) > 0.5 * LENGTH * np.abs(way).max():
                return True
    return False
