"""Levenberg's steps from a configuration to what is near a pose, a solution or not."""

import math

from dh2urdf.kernels.certificate.certify import principal
from dh2urdf.kernels.newton import add_transposed, error_and_jacobian, solve_damped

DAMPING = 0.5
"""Damping in squares of the error: it vanishes where there is a solution."""

LONGEST = 0.6
"""The longest step [rad, or in sizes of the arm]."""

SETTLED = 2
"""Steps without a better residual after which a solution is left: at a double root it falls on, by
halves."""


def approach(chain, goal, patience, q, best, dq, damped):
    """Go from q (n,); the least residual, and in q the configuration that has it.

    ``patience``: the most steps, those without a better residual after which a start is given up,
    and the residuals [m and rad] of a solution and at which nothing is left to gain.
    """
    (_, joints), (steps, stuck, solved, done) = chain, patience
    least, since = math.inf, 0
    best[:] = q
    for _ in range(steps):
        residual = error_and_jacobian(chain, goal, q, damped)
        if residual < least:
            since = since if residual > 0.9 * least else 0
            least = residual
            best[:] = q
        since += 1
        if residual <= done or since > (SETTLED if least <= solved else stuck):
            break
        square = 0.0
        for a in range(6):
            square += damped[1][a, 6] * damped[1][a, 6]
        solve_damped(damped, DAMPING * square)
        dq[:] = 0.0
        add_transposed(damped, 1.0, dq)
        longest = LONGEST
        for j in range(q.shape[0]):
            longest = max(longest, abs(dq[j]) / (goal[2] if joints[j, 0] != 0.0 else 1.0))
        q += dq * (LONGEST / longest)
    for j in range(q.shape[0]):
        q[j] = best[j] if joints[j, 0] != 0.0 else principal(best[j])
    return least
