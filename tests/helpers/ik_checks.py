"""What solvers of every family have to keep, measured by the referee's own kinematics."""

import numpy as np
from ik_referee import (
    GAP,
    RESIDUAL,
    distances,
    draw,
    error_vectors,
    exists,
    forward,
    gaps,
    jacobians,
    misses,
    residuals,
    rows_of,
    search,
    solve,
)
from margins import assert_apart, assert_margin


def check_all(chain, q, found, Ts):
    """Every solution reaches its pose, none is there twice, the generating one is among them."""
    solutions, owner = rows_of(found)
    assert_margin(residuals(chain, solutions, Ts[owner]), RESIDUAL, 1000)
    assert_margin(found.residual[exists(found)], RESIDUAL, 1000)
    assert not found.free[exists(found)].any()
    assert_margin(misses(chain, found, q), GAP, quantile=0.999)
    assert_apart(distances(chain, found), GAP, quantile=0.999)


def solved(chain, T):
    """Solutions of a pose, each at it to rounding, and their free joints."""
    q, residual, _, free = solve(chain, T[None]).of(0)
    assert_margin(residual, RESIDUAL, 1000)
    return q, free


def check_random_poses(chain, m, seed=1):
    """The same at m poses of configurations drawn within the limits."""
    q = draw(chain, m, seed)
    Ts = forward(chain, q)
    check_all(chain, q, solve(chain, Ts), Ts)


def check_against_search(chain, m):
    """A search from many starts at m poses finds nothing that the closed form does not."""
    Ts = forward(chain, draw(chain, m, 7))
    found = solve(chain, Ts)
    for i in range(m):
        q = found.of(i)[0]
        for other in search(chain, Ts[i], i):
            assert_margin(gaps(chain, q, other).min(), 1e-4)


def check_kernels_agree(chain, solver, other, contract):
    """A solver's own kernel and another one find the same solutions and branches."""
    Ts, apart = forward(chain, draw(chain, 1000, 8)), []
    for within_limits in (False, True):
        fast = solve(chain, Ts, within_limits, solver)
        solver.kernel = other
        slow = solve(chain, Ts, within_limits, solver)
        del solver.kernel
        assert np.array_equal(fast.count, slow.count)
        for i in range(len(Ts)):
            q, p = fast.of(i)[0], slow.of(i)[0]
            twin = np.array([np.abs(p - row).max(axis=1).argmin() for row in q], int)
            assert len(set(twin)) == len(p)
            assert np.array_equal(fast.of(i)[2], slow.of(i)[2][twin])
            apart.append(np.abs(q - p[twin]))
    assert_margin(np.concatenate(apart), contract)


def near_one_singularity(chain, joint, value, rng):
    """A configuration with one joint at a singular value, and no other singularity near."""
    while True:
        q = rng.uniform(-2, 2, chain.n)
        q[joint] = value + 0.7
        if np.linalg.svd(jacobians(chain, q), compute_uv=False)[-1] > 0.05:
            q[joint] = value
            return q


def check_distances_from_a_singularity(chain, joint, value, rng):
    """Poses 1e-1 to 1e-12 from a singular value of a joint keep the configuration, 30 each.

    At 1e-7 two elbows are one, off by their distance; at 1e-9 a wrist's own angle is still asked
    for, and known to some roundings over its sine. Around these there is no factor of ten.
    """
    for power in range(1, 13):
        q = np.array([near_one_singularity(chain, joint, value, rng) for _ in range(30)])
        q[:, joint] += 10.0**-power
        found = solve(chain, forward(chain, q))
        assert_margin(found.residual[exists(found)], RESIDUAL, 1000)
        away = [away_but_free(chain, found.of(i)[0], found.of(i)[3], q[i]) for i in range(30)]
        rounding = 20 * np.finfo(float).eps * 10.0**power if power <= 9 else 0.0
        assert_margin(away, max(GAP, rounding), 1 if 7 <= power <= 9 else 10)


def away_but_free(chain, solutions, free, q):
    """Distance of q from the nearest solution, joints that are free left out."""
    away = np.abs(np.sin((solutions - q) / 2)) * 2
    away[:, chain.prismatic] = np.abs(solutions - q)[:, chain.prismatic]
    away[(free[:, None] >> np.arange(chain.n) & 1) == 1] = 0.0
    return away.max(axis=1).min()


def check_family(chain, q, T, mask):
    """The free joints, and only these, move along a curve of solutions through q."""
    free = [i for i in range(chain.n) if mask >> i & 1]
    J = jacobians(chain, q)
    _, sigma, Vt = np.linalg.svd(J)
    tangent = Vt[-1]
    assert_margin(sigma[-1], 1e-9)
    assert np.abs(tangent[free]).min() > 1e-9
    assert_margin(np.append(np.abs(np.delete(tangent, free)), 0.0), 1e-7)
    moved = q + 1e-3 * tangent
    for _ in range(5):
        e = error_vectors(forward(chain, moved), T)
        moved = moved + np.linalg.pinv(jacobians(chain, moved), rcond=1e-6) @ e
    assert_margin(residuals(chain, moved, T), RESIDUAL)
    assert 5e-4 < gaps(chain, moved, q) < 2e-3
