"""Inverse kinematics by damped Newton steps from many starts, for any chain.

``dq = J^T (J J^T + lambda)^-1 e`` with a damping ``lambda = |e|^2 / 2 + small``, which vanishes
as the target is approached (Sugihara 2011). A value at a limit that would go on outwards is left
out of the step. Each start leads to one solution or to none; nothing says how many there are.

The chain's joints follow the values q (n,) of the user: ``joint values = C q + c``, C the unit
matrix but for joints that mimic others.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate.certify import ACCEPT, is_known
from dh2urdf.kernels.newton import add_transposed, error_and_jacobian, make_damped, solve_damped
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import Chain, Configuration, Floats, Goal, Sizes

MOST_STEPS = 60
"""Steps from one start; a good one takes ten to twenty."""

STUCK = 12
"""Steps without a better residual after which a start is given up."""

LONGEST = 0.6
"""Longest step of one value [rad], or relative to the arm's size."""

DAMPING = 1e-3
"""Part of the trace of ``J J^T`` by which the first steps are damped, besides ``|e|^2 / 2``."""

DONE = 1e-14
"""Residual [m and rad] at which nothing is left to gain."""


def _look(arm, goal, q, scratch):
    """Residual of values q (n,); its error and the Jacobian of the values go to ``part``."""
    (chain, coupling, offset, _), (work, _, whole, part) = arm, scratch
    for k in range(offset.shape[0]):
        total = offset[k]
        for v in range(q.shape[0]):
            total += coupling[k, v] * q[v]
        work[k] = total
    residual = error_and_jacobian(chain, goal, work, whole)
    for a in range(6):
        part[1][a, 6] = whole[1][a, 6]
        for v in range(q.shape[0]):
            total = 0.0
            for k in range(offset.shape[0]):
                total += coupling[k, v] * whole[0][k, a]
            part[0][v, a] = total
    return residual


def _step(bounds, damping, unit, q, dq, part):
    """Damped step of the values into dq (n,), without those at a limit that would go beyond it."""
    n = q.shape[0]
    for _ in range(n + 1):
        solve_damped(part, damping)
        dq[:] = 0.0
        add_transposed(part, 1.0, dq)
        again = False
        for i in range(n):
            out = (q[i] >= bounds[i, 2] and dq[i] > 0.0) or (q[i] <= bounds[i, 1] and dq[i] < 0.0)
            if out:
                again = True
                part[0][i] = 0.0
        if not again:
            break
    longest = 0.0
    for i in range(n):
        longest = max(longest, abs(dq[i]) / (unit if bounds[i, 0] != 0.0 else 1.0))
    scale = min(1.0, LONGEST / longest) if longest > 0.0 else 0.0
    for i in range(n):
        q[i] = min(max(q[i] + scale * dq[i], bounds[i, 1]), bounds[i, 2])


def _from_start(arm, goal, q, best, scratch):
    """Follow the steps from q (n,); the residual of the best values, which go to best (n,)."""
    (_, _, _, bounds), (_, dq, _, part) = arm, scratch
    least, since = math.inf, 0
    for _ in range(MOST_STEPS):
        residual = _look(arm, goal, q, scratch)
        if residual < least:
            since = since if residual > 0.9 * least else 0
            least = residual
            best[:] = q
        since += 1
        if residual <= DONE or since > STUCK or (least <= ACCEPT and since > 2):
            break
        square = 0.0
        for a in range(6):
            square += part[1][a, 6] * part[1][a, 6]
        _step(bounds, square * (0.5 + DAMPING), goal[2], q, dq, part)
    return least


class Coupled(NamedTuple):
    """A chain, how its joints follow the values, and these: sliding, lower, upper bound."""

    chain: Chain
    coupling: Annotated[Floats, "n", "values"]
    offset: Configuration
    bounds: Annotated[Floats, "values", 3]


@entry()
def find_solutions(
    arm: Coupled,
    goal: Goal,
    starts: Annotated[Floats, "starts", "values"],
    q: Annotated[Floats, "solutions", "values"],
    residual: Sizes,
):
    """Different solutions of one pose, values from one start (s, n) after the other.

    Solutions go to q (k, n) and ``residual`` (k,); the search ends when these are full. The starts
    are overwritten. Returns the number of solutions and of starts that were used.
    """
    bounds, n, m = arm[3], starts.shape[1], arm[2].shape[0]
    scratch = np.empty(m), np.empty(n), make_damped(m), make_damped(n)
    best = np.empty(n)
    count = 0
    for s in range(starts.shape[0]):
        least = _from_start(arm, goal, starts[s], best, scratch)
        if least <= ACCEPT and not is_known(bounds, q, count, best):
            q[count] = best
            residual[count] = least
            count += 1
            if count == q.shape[0]:
                return count, s + 1
    return count, starts.shape[0]
