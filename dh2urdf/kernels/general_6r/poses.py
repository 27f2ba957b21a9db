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

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from dh2urdf.kernels.general_6r.arm import ARM_6R, MOST
from dh2urdf.kernels.general_6r.follow import SINGULAR, accounted, follow, how_many_below
from dh2urdf.kernels.general_6r.roots import eliminate, find_roots, nudge, place_target, prepare
from dh2urdf.kernels.numbers import entry_kernel, inlined

Array: TypeAlias = NDArray[np.float64]
Arm: TypeAlias = NDArray[np.void]

TURN = np.array([0.7310, -1.1170, 0.4127, 1.3019, -0.8233, 0.5171])
"""Zero of each joint's angle inside the solver [rad]: none that a user's pose would have."""

POSES = 24
"""Random poses on which each elimination is tried."""

USABLE = 0.3
"""Part of the best elimination's solutions that another must find to be kept."""

WORTH = 0.03
"""Solutions a pose that one more digit in the seeds outweighs."""

DEAREST = 6.0
"""Most digits that spans of doubt, which take time, count for."""

COARSE = 1e-2
"""Error of a seed, lengths in parts of the arm's size, above which another elimination is asked:
roots so inexact may stand for more than one each."""

CROWDED = 1e-3
"""Determinant of a solution's Jacobian below which roots of several may run together: none is
taken for the last before every root is accounted for."""

ATTEMPTS = 3
"""Rounds of all eliminations, from the second one on for a pose nearby."""

CROWDED_ATTEMPTS = 7
"""The same where solutions are close together yet apart: each round may lead to others."""


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


def _rank(arm: Arm, poses: Array) -> list[tuple[int, int]]:
    """The eliminations to keep, best first: by solutions found, then by precision."""
    eliminations = [(shift, reverse) for reverse in (0, 1) for shift in range(6)]
    outputs = np.empty((1, 16, 6)), np.empty((1, 16)), np.zeros(1, np.int64)
    found, digits = np.zeros(12), np.zeros(12)
    for k, elimination in enumerate(eliminations):
        _choose(arm, [elimination])
        for m in range(POSES):
            solve_general_6r(arm, poses[m : m + 1], *outputs)
            seeded, spans = arm["first"][0]
            found[k] += outputs[2][0] / POSES
            digits[k] -= min(math.log10(max(seeded, 1e-16)) + min(spans, DEAREST), 0.0) / POSES
    order = np.argsort(-found - digits * WORTH)
    return [eliminations[k] for k in order if found[k] >= USABLE * found.max()][:MOST]


def _choose(arm: Arm, eliminations: list[tuple[int, int]]) -> None:
    """Prepare some eliminations."""
    arm["trials"], arm["choices"][0, : len(eliminations)] = len(eliminations), eliminations
    arm["ready"] = 0
    solve_general_6r(
        arm, np.empty((0, 4, 4)), np.empty((0, 16, 6)), np.empty((0, 16)), np.empty(0, np.int64)
    )


def _place(arm: Arm, links: Array) -> None:
    """Set the links (7, 4, 4) of an arm."""
    short = _short_links(links)
    size = float(np.linalg.norm(short[1:6, :3, 3], axis=1).max()) or 1.0
    arm["links"], arm["size"], arm["ends"] = _flat(links), size, np.linalg.inv(short[[0, 6]])
    arm["turns"] = np.cos(TURN), np.sin(TURN), TURN
    arm["chain"][0, :5] = _flat(short[1:6])
    arm["chain"][0, :5, 3::4] /= size


def plan_general_6r(links: Array) -> Arm:
    """The record (1,) by which :func:`solve_general_6r` solves an arm with these links (7, 4, 4).

    ``T_base_tool = links[0] Rz(q1) links[1] ... Rz(q6) links[6]``.
    """
    arm = np.zeros(1, ARM_6R)
    _place(arm, links)
    _choose(arm, _rank(arm, _random_poses(links)))
    return arm


def replan_general_6r(arm: Arm, links: Array) -> Arm:
    """The record of an arm with other links (7, 4, 4), with the eliminations of an arm.

    Some 20 times faster than :func:`plan_general_6r`. Eliminations that are good for one arm are
    so for nearly all that differ in the value of a held joint.
    """
    other = arm.copy()
    _place(other, links)
    _choose(other, [tuple(row) for row in arm["choices"][0, : arm["trials"][0]].tolist()])
    return other


@inlined
def _solve_pose(T, out_q, out_residual, arm):
    """All solutions of one pose; their number."""
    spans, first, trials, kept = arm["spans"], arm["first"], arm["trials"], arm["kept"]
    place_target(T, arm)
    found = np.int64(0)
    first[0] = 1.0
    for trial in range(CROWDED_ATTEMPTS * trials):
        if trial == ATTEMPTS * trials and (
            how_many_below(kept, found, CROWDED) == 0 or how_many_below(kept, found, SINGULAR) > 0
        ):
            break
        e = trial % trials
        if e == 0 and trial > 0:
            nudge(arm["chain"], trial // trials)
        eliminate(e, arm)
        before, retried, seeded = found, np.int64(0), 0.0
        count = find_roots(arm)
        if count < 0:
            continue
        # a double root has a slope of 0
        simple = count - how_many_below(arm["slopes"], count, 1e-300)
        if count > 0:
            found, retried, seeded = follow(e, count, found, out_q, out_residual, arm)
            if trial == 0:
                first[0], first[1] = seeded, spans[0, 0]
        whole = retried == 0 or (trial < trials and accounted(e, count, found, out_q, arm))
        apart = before > 0 and trial >= trials and how_many_below(kept, found, CROWDED) == 0
        clear = spans[1, 0] == 0.0 and (whole or apart)
        sure = seeded < COARSE if before == 0 else found == before
        fits = found % 2 == 0 and found >= simple and found + trial > 0
        if clear and sure and fits and how_many_below(kept, found, SINGULAR) == 0:
            break
    return found


@entry_kernel
def solve_general_6r(arms, Ts, out_q, out_residual, out_count):
    """All solutions of poses Ts (m, 4, 4), by a record ``arms`` (1,) of :func:`plan_general_6r`.

    Angles in (-pi, pi] go to out_q (m, 16, 6), the larger of position error [m] and orientation
    error [rad] to out_residual (m, 16), how many there are to out_count (m,). The record is not to
    be shared between threads.
    """
    arm = arms[0]
    if arm["ready"] == 0:
        prepare(arm)
        arm["ready"] = 1
    for m in range(Ts.shape[0]):
        out_count[m] = _solve_pose(Ts[m], out_q[m], out_residual[m], arm)
