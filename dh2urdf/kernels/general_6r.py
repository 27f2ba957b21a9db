"""All real solutions of any arm of six revolute joints.

Elimination after Raghavan & Roth (1993): cut the loop that arm and target form, eliminate five
joints, and find the sixth as the roots of a trigonometric polynomial of degree 8, whose values
are determinants. Each root gives a seed for Newton's method on the exact chain; what is returned
carries the residual of that chain, tool included.

An elimination can fail for an arm (parallel axes make the determinant vanish) or lose precision
for a pose. So the arm's plan holds several, best first, chosen by trying all twelve on random
poses; and a pose for which one leaves doubt is looked at again, first with new samples where the
polynomial is small, then with the next elimination.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from dh2urdf.kernels.elimination import close_loop, left_coefficients
from dh2urdf.kernels.general_6r_passes import (
    eliminate,
    find_roots,
    follow,
    inner_target,
    isolated,
    nudge,
    rate_elimination,
    simple_roots,
)
from dh2urdf.kernels.general_6r_work import make_work_6r
from dh2urdf.kernels.lanes import vector_kernel

__all__ = ["Plan", "make_work_6r", "plan_general_6r", "solve_general_6r", "solve_general_6r_batch"]

Array: TypeAlias = NDArray[np.float64]
Plan: TypeAlias = tuple[Array, Array, Array, Array, float, Array, NDArray[np.int64], Array]

TURN = np.array([0.7310, -1.1170, 0.4127, 1.3019, -0.8233, 0.5171])
"""Zero of each joint's angle inside the solver [rad]: none that a user's pose would have."""

POSES = 24
"""Random poses on which each elimination is tried."""

USABLE = 0.3
"""Part of the best elimination's solutions that another must find to be kept."""

WORTH = 0.03
"""Solutions a pose that one more digit in the seeds outweighs."""

MOST = 3
"""Eliminations kept."""

ATTEMPTS = 3
"""Rounds of all eliminations, from the second one on for a pose nearby."""


def _z(angle: float, offset: float) -> Array:
    """Turn about z, then shift along it."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, offset], [0, 0, 0, 1.0]])


def _short_links(links: Array) -> Array:
    """The same chain with each joint's origin slid along its axis, so that the links are short.

    Minimises ``sum |t_i - a_i e3 + a_(i+1) R_i e3|^2`` over the slides a_1 ... a_6.
    """
    matrix, rhs = np.zeros((15, 6)), np.zeros(15)
    for i in range(1, 6):
        rows = slice(3 * i - 3, 3 * i)
        matrix[rows, i - 1] = [0.0, 0.0, -1.0]
        matrix[rows, i] = links[i, :3, 2]
        rhs[rows] = -links[i, :3, 3]
    slides = np.linalg.lstsq(matrix, rhs, rcond=1e-9)[0]
    short = links.copy()
    for i in range(6):
        short[i] = short[i] @ _z(0.0, slides[i])
        short[i + 1] = _z(TURN[i], -slides[i]) @ short[i + 1]
    return short


def _flat(transforms: Array) -> Array:
    """Rows (12,) of transforms (k, 4, 4)."""
    return np.ascontiguousarray(transforms[:, :3, :]).reshape(-1, 12)


def _random_poses(links: Array) -> Array:
    """Reachable poses (POSES, 4, 4), the same ones each time."""
    rng = np.random.default_rng(0)
    poses = np.empty((POSES, 4, 4))
    for m, q in enumerate(rng.uniform(-math.pi, math.pi, (POSES, 6))):
        T = links[0]
        for i in range(6):
            T = T @ _z(q[i], 0.0) @ links[i + 1]
        poses[m] = T
    return poses


def _rank(
    fixed: tuple[Array, Array, Array, Array, float, Array],
    choices: NDArray[np.int64],
    lefts: Array,
    poses: Array,
) -> NDArray[np.int64]:
    """Indices of the eliminations to keep, best first: by solutions found, then by precision."""
    rating = np.empty(POSES)
    out_q, residual = np.empty((POSES, 16, 6)), np.empty((POSES, 16))
    count = np.empty(POSES, dtype=np.int64)
    found, digits = np.empty(12), np.empty(12)
    for k, (shift, reverse) in enumerate(choices):
        one = slice(k, k + 1)
        rate_elimination(*fixed, shift, reverse, lefts[k], poses, rating)
        solve_general_6r_batch(*fixed, choices[one], lefts[one], poses, out_q, residual, count)
        found[k], digits[k] = count.mean(), -rating.mean()
    order = np.argsort(-found - digits * WORTH)
    return order[found[order] >= USABLE * found.max()][:MOST]


def plan_general_6r(links: Array) -> Plan:
    """Prepare an arm of six revolute joints.

    Parameters
    ----------
    links : (7, 4, 4)
        ``T_base_tool = links[0] Rz(q1) links[1] ... Rz(q6) links[6]``.

    Returns
    -------
    tuple
        The first arguments of `solve_general_6r` and `solve_general_6r_batch`.
    """
    links = np.asarray(links, dtype=float)
    short = _short_links(links)
    size = float(max(np.linalg.norm(short[1:6, :3, 3], axis=1).max(), 1e-300))
    chain = _flat(short[1:6])
    chain[:, 3::4] /= size
    base_inverse, tool_inverse = np.linalg.inv(short[0]), np.linalg.inv(short[6])
    turns = np.array([np.cos(TURN), np.sin(TURN)])
    fixed = (_flat(links), chain, base_inverse, tool_inverse, size, turns)
    choices = np.array([[shift, reverse] for reverse in (0, 1) for shift in range(6)])
    lefts = np.zeros((12, 14, 27))
    loop, samples = np.zeros((6, 12)), np.zeros((14, 27))
    for k, (shift, reverse) in enumerate(choices):
        close_loop(chain, np.eye(4)[:3].ravel(), shift, reverse, loop)
        left_coefficients(loop, samples, lefts[k])
    best = _rank(fixed, choices, lefts, _random_poses(links))
    return (*fixed, np.ascontiguousarray(choices[best]), np.ascontiguousarray(lefts[best]))


@vector_kernel
def solve_general_6r(
    links,
    chain,
    base_inverse,
    tool_inverse,
    size,
    turns,
    choices,
    lefts,
    T,
    out_q,
    out_residual,
    work,
):
    """All solutions of one pose.

    Parameters
    ----------
    links, chain, base_inverse, tool_inverse, size, turns, choices, lefts
        The plan of the arm, from `plan_general_6r`.
    T : (4, 4)
        Target ``T_base_tool``.
    out_q : (16, 6), out
        Joint angles in (-pi, pi] [rad].
    out_residual : (16,), out
        Larger of position error [m] and orientation error [rad].
    work : tuple of arrays
        From `make_work_6r`; not to be shared between threads.

    Returns
    -------
    int
        Number of solutions written.
    """
    spans, slopes = work[20], work[21]
    inner_target(base_inverse, tool_inverse, size, T, work[1], work[0])
    found, trials = np.int64(0), choices.shape[0]
    for trial in range(ATTEMPTS * trials):
        e = trial % trials
        if e == 0 and trial > 0:
            nudge(work[0], trial // trials)
        shift, reverse = choices[e, 0], choices[e, 1]
        eliminate(chain, shift, reverse, lefts[e], work)
        before, simple, doubt, count = found, 0, 0, 0
        for again in range(2):
            if again == 1 and spans[0, 0] == 0.0:
                break
            count = find_roots(again, work)
            if count < 0:
                break
            if again == 0:
                simple = simple_roots(count, slopes)
            if count > 0:
                found, retried = follow(
                    links, size, count, found, shift, reverse, turns, out_q, out_residual, work
                )
                doubt += retried
        fits = count >= 0 and found % 2 == 0 and found >= simple
        confirmed = doubt == 0 if before == 0 else found == before
        if fits and confirmed and found + trial > 0 and isolated(found, work[42]):
            break
    return found


@vector_kernel
def solve_general_6r_batch(
    links,
    chain,
    base_inverse,
    tool_inverse,
    size,
    turns,
    choices,
    lefts,
    Ts,
    out_q,
    out_residual,
    out_count,
):
    """`solve_general_6r` for many poses.

    Ts (m, 4, 4); out_q (m, 16, 6), out_residual (m, 16) and out_count (m,) are written.
    """
    work = make_work_6r()
    for m in range(Ts.shape[0]):
        out_count[m] = solve_general_6r(
            links,
            chain,
            base_inverse,
            tool_inverse,
            size,
            turns,
            choices,
            lefts,
            Ts[m],
            out_q[m],
            out_residual[m],
            work,
        )
