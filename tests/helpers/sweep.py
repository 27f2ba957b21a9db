"""The referee of sweeps: what of the configurations that poses were made of is found, or lost."""

import os
import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from dh_arm import arm_of
from ik_referee import forward, gaps, jacobians, residuals, same_to_rounding
from self_motions import LENGTHS, back, goes_on, is_family, on_family
from structured import table_line

import dh2urdf

REGULAR = 1e-4
"""Smallest singular value of the Jacobian, lengths in sizes of the arm, of a regular pose."""

ACCEPT = 1e-9
"""Residual [m and rad] of a solution."""

ROUNDING = 1e-12
"""What a solution may be off by, times its smallest singular value; and bounds of that [rad]."""
LEAST, MOST = 1e-8, 1e-6

REGULAR_ALONE = os.environ.get("SWEEP_POSES") == "regular"
"""Whether singular poses are left out, whose walks take most of the time: for other processors."""

NEAR = 0.1
"""How far what is to be the same to rounding may be from a solution [rad or m]."""

SURE = 1e-11
"""Residual of a short walk along a family that has to be named: round a circle it is accepted."""


@dataclass
class Tally:
    """Figures of a class of poses, and what is wrong in words."""

    name: str
    count: Counter = field(default_factory=Counter)
    notes: list = field(default_factory=list)
    cases: list = field(default_factory=list)
    seconds: float = 0.0

    def note(self, what, table, q):
        """Count a failure and describe it."""
        self.count[what] += 1
        self.cases.append((what, table, np.array(q)))
        values = " ".join(f"{x!r}" for x in np.asarray(q).tolist())
        line = table if isinstance(table, str) else table_line(table)
        self.notes.append(f"{what}: {line} at q = {values}")

    def line(self):
        """One line of figures."""
        c = self.count
        micro = 1e6 * self.seconds / max(c["poses"], 1)
        return (
            f"{self.name}: {c['tables']} tables ({c['refused']} refused), {c['poses']} poses, "
            f"{c['regular']} regular: {c['regular lost']} lost; "
            f"{c['singular']} singular: {c['singular lost']} lost, "
            f"{c['no answer']} without answer; {c['wrong']} wrong, {c['twice']} twice, "
            f"{c['no family']} families that are none, {c['unnamed']} not named; "
            f"{c['beyond']} found by their seed alone; {micro:.0f} us"
        )

    def failures(self):
        """What may not be, in words."""
        return [note for note in self.notes if not note.startswith("beyond")]


def smallest(arm, q, moving):
    """Smallest singular value at configurations (m, n) of the joints that may move, (m,)."""
    J = jacobians(arm, q)[..., moving]
    J[..., :3, :] /= arm.size
    return np.linalg.svd(J, compute_uv=False)[..., -1]


def smallest_of_far(arm, q, moving):
    """The same in sizes of how far out slides are, where that is farther: their motions, too.

    Partners of a pair may be tens of kilometres out, where slides are parallel but for 1e-5.
    """
    size = np.maximum(arm.size, np.abs(q[:, arm.prismatic]).max(axis=1, initial=0.0))
    J = jacobians(arm, q)
    J[:, :, arm.prismatic] *= size[:, None, None]
    J[:, :3] /= size[:, None, None]
    return np.linalg.svd(J[..., moving], compute_uv=False)[..., -1]


def contains(arm, found, masks, q, T, tolerance, moving=slice(None)):
    """Whether q (n,) is a solution (k, n), on a named family, or a solution to rounding."""
    away = gaps(arm, found, q) if len(found) else np.array([np.inf])
    if away.min() <= tolerance:
        return True
    bits = (masks[:, None] >> np.arange(arm.n)) & 1 == 1
    for k in np.argsort(away):
        if masks[k] and on_family(arm, found[k], q, T, bits[k], MOST):
            return True
    if tolerance <= LEAST:
        return False
    near = [found[k] for k in np.argsort(away) if away[k] < NEAR]
    near += [p for k in np.flatnonzero(masks) for p in _members(arm, found[k], q, T, bits[k])]
    return any(same_to_rounding(arm, p, q, T, moving) for p in near)


def _members(arm, p, q, T, free):
    """The member (n,) next to q of the family of p, if it is near."""
    if gaps(arm, np.where(free, q, p), q) > NEAR:
        return []
    member, _ = back(arm, np.where(free, q, p), T, free)
    return [member] if on_family(arm, p, member, T, free, MOST) else []


def judge(tally, table, q, solve, robot=None, held=()):
    """Solve the poses of configurations q (m, n) and count what is lost or wrong.

    ``solve`` takes the robot and poses (m, 4, 4) and returns a batch; some joints may be held.
    """
    arm, robot = arm_of(table), robot or dh2urdf.Robot.from_dh(table)

    def from_seed(T, p):
        found = robot.ik(T, seed=p, within_limits=False)
        return found.partial and len(found) and gaps(arm, found.q[:1], p)[0] <= MOST

    judge_arm(
        tally, (table, arm), q, lambda Ts: solve(robot, Ts), held, None if held else from_seed
    )


def judge_arm(tally, named, q, solve, held=(), from_seed=None):
    """The same of an arm, before which stands its table, or its name.

    Where two joints or more are to spare answers are members of a part, and say so: then
    ``from_seed`` tells whether a configuration (n,) as the seed finds itself.
    """
    table, arm = named
    moving = np.isin(np.arange(arm.n), held, invert=True)
    Ts = np.ascontiguousarray(forward(arm, q))
    begun = time.perf_counter()
    batch = solve(Ts)
    tally.seconds += time.perf_counter() - begun
    sigma = smallest(arm, q, moving)
    tolerance = np.clip(ROUNDING / np.maximum(sigma, 1e-300), LEAST, MOST)
    tally.count["tables"] += 1
    for i, T in enumerate(Ts):
        kind = "regular" if sigma[i] > REGULAR else "singular"
        if REGULAR_ALONE and kind == "singular":
            continue
        k = batch.count[i]
        found, masks = batch.q[i, :k], batch.free_mask[i, :k]
        tally.count["poses"] += 1
        tally.count[kind] += 1
        if k == 0:
            tally.note("no answer", table, q[i])
        if k == 0 or not contains(arm, found, masks, q[i], T, tolerance[i], moving):
            beyond = k > 0 and from_seed is not None and from_seed(T, q[i])
            tally.note("beyond" if beyond else f"{kind} lost", table, q[i])
        if k > 0:
            _check_solutions(tally, table, arm, (found, masks, moving), T, q[i])


def _check_solutions(tally, table, arm, solutions, T, q):
    """Count solutions that miss the pose, are there twice, or are wrong about families."""
    found, masks, moving = solutions
    if residuals(arm, found, T).max() > ACCEPT:
        tally.note("wrong", table, q)
    away = gaps(arm, found[:, None], found[None])
    alike = masks[:, None] == masks[None]
    if ((away + 9.0 * np.eye(len(found)) < MOST) & alike).any():
        tally.note("twice", table, q)
    sigma = smallest_of_far(arm, found, moving)
    for k, (p, mask, small) in enumerate(zip(found, masks.tolist(), sigma, strict=True)):
        if mask and not _named_rightly(arm, found, masks, k, T):
            tally.note("no family", table, q)
            break
        if not mask and small < 1e-7 and _has_no_name(arm, p, T, moving):
            tally.note("unnamed", table, q)
            break


def _has_no_name(arm, p, T, moving):
    """Whether an isolated solution is on a family: a part of a turn is sure, and the turn kept."""
    return is_family(arm, p, T, moving, SURE, LENGTHS[:1], False) and goes_on(arm, p, T, moving)


def _named_rightly(arm, found, masks, k, T):
    """Whether a walk from solution k is a family, or one from another solution that comes to it.

    Where curves cross at a solution, ways from there end on either of them.
    """
    bits = (masks[k] >> np.arange(arm.n)) & 1 == 1
    if is_family(arm, found[k], T, bits):
        return True
    others = (p for j, p in enumerate(found) if j != k and masks[j] == masks[k])
    return any(
        is_family(arm, p, T, bits) and on_family(arm, p, found[k], T, bits, MOST) for p in others
    )
