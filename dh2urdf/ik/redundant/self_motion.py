"""What an arm with one joint to spare can do while its tool stays.

The solutions of a pose are curves in joint space, each running through many values of the swept
joint. Here they are followed: to the member nearest to a seed, into the joint limits, and to the
ends of the intervals of the swept joint in which the pose is reached.
"""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from dh2urdf.bounds import SAMPLES
from dh2urdf.chain import SerialChain
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.arm import (
    INTERVAL_END,
    LIMIT_SLACK,
    SHARP,
    TWO_PI,
    HeldSolver,
    Outputs,
    Task,
    beside_seed,
    middle,
    near_ranges,
    turned_to,
)
from dh2urdf.kernels.certificate import measure_all
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.redundant import enter_limits
from dh2urdf.kernels.redundant import nearest_members as nearest_on_curves
from dh2urdf.transforms import Array

VALUES = 128
"""Values of the swept joint at which curves are looked for."""

FEW = 32
"""The same, where a sweep at ``GRID`` values has found nothing: most such poses are out of
reach."""

APART = 0.1
"""Joint distance [rad or m] of members that are worth returning side by side."""

STARTS = 64
"""Solutions that are followed towards a seed, the nearest ones of those found inside and of those
found outside the limits. Neighbouring ones lead to the same member."""

FAR = 1.5
"""Excess over a limit [rad or m] from which a solution is not followed inwards."""

SAME = 1e-5
"""Joint distance [rad or m] at which two nearest members are one."""

GRID = 720
"""Values of the swept joint at which reach is tried; half a degree apart for a whole turn."""


class Sweep(Protocol):
    """A chain that can be solved at values of one joint or, roughly, of another."""

    chain: SerialChain
    links: Array
    joints: Array
    held: HeldSolver
    joint: int

    @property
    def sweeps(self) -> Sequence[HeldSolver]:
        """Solvers of the chain with either joint held."""

    def solve_at(self, values: Array, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses (m, 4, 4) at values (s,) of the joint."""


def sample_values(chain: SerialChain, joint: int, samples: int, within_limits: bool) -> Array:
    """Values of a joint at the middles of equal parts of its range, shape (samples,).

    One turn at most; where the range is wider or has no bound, the turn about its middle.
    """
    lower, upper = float(chain.lower[joint]), float(chain.upper[joint])
    if chain.prismatic[joint]:
        lower, upper = (float(end[joint]) for end in near_ranges(chain))
    elif not within_limits or upper - lower > 2.0 * np.pi:
        middle = 0.5 * (lower + upper) if np.isfinite(upper - lower) else 0.0
        lower, upper = middle - np.pi, middle + np.pi
    parts: Array = lower + (upper - lower) * (np.arange(samples) + 0.5) / samples
    return parts


def few_members(solver: Sweep, T: Array, within_limits: bool, most: int) -> tuple[Array, Array]:
    """Solutions (k, n) of a pose on curves that a coarse sweep has missed; their residuals."""
    chain = solver.chain
    values = sample_values(chain, solver.joint, GRID, within_limits)
    outputs = Outputs.of(1, GRID * solver.held.kmax, chain.n)
    solver.solve_at(values, np.array(T[None]), within_limits, outputs)
    q = outputs.q[0, : outputs.counts[0]]
    if not len(q) and within_limits:
        q = inside_members(solver, T, middle(chain), most, FEW)
    elif not len(q):
        q = turned_to(chain, _on_curves(solver, T, FEW), middle(chain))
    kept: list[int] = []
    for k in range(len(q)):
        if len(kept) < most and all(np.abs(q[k] - q[j]).max() > APART for j in kept):
            kept.append(k)
    return _measured(solver, T, q[kept])


def _measured(solver: Sweep, T: Array, q: Array) -> tuple[Array, Array]:
    """Solutions (k, n) and their residuals (k,) on the exact chain."""
    q, residual, count = np.ascontiguousarray(q), np.empty(len(q)), np.array([len(q)])
    measure_all(solver.chain.tables, POSE, T[None], q[None], count, residual[None])
    return q, residual


def inside_members(solver: Sweep, T: Array, goal: Array, most: int, values: int = VALUES) -> Array:
    """Members (k, n) inside the limits of the curves of a pose, those nearest to a goal first.

    The curves are looked for in sweeps of two joints over a whole turn, for one that is short in
    one joint is seldom short in the other. Those found outside the limits are followed inwards,
    at ``most`` so many, the nearest to the goal and the limits.
    """
    chain = solver.chain
    q = turned_to(chain, _on_curves(solver, T, values), goal)
    outside = (q < chain.lower - LIMIT_SLACK) | (q > chain.upper + LIMIT_SLACK)
    other_turn = np.where(outside, turned_to(chain, q, middle(chain)), q)
    q = np.concatenate([q, other_turn[np.any(other_turn != q, axis=1)]])
    clipped = np.clip(q, chain.lower, chain.upper)
    excess = np.abs(q - clipped).max(axis=1, initial=0.0)
    order = np.argsort(np.linalg.norm(clipped - goal, axis=1) + 2.0 * excess, kind="stable")
    q, excess = q[order], excess[order]
    inside = excess <= LIMIT_SLACK
    outer = np.ascontiguousarray(q[(excess > LIMIT_SLACK) & (excess < FAR)][:most])
    entered = np.zeros(len(outer), np.bool_)
    enter_limits(chain.tables, (POSE, T, chain.size), outer, entered)
    members = np.concatenate([q[inside], outer[entered]])
    order = np.argsort(np.linalg.norm(members - goal, axis=1), kind="stable")
    ordered: Array = members[order]
    return ordered


def _on_curves(solver: Sweep, T: Array, values: int) -> Array:
    """Solutions of a pose near values over a whole turn of two joints, limits or not, (k, n)."""
    return np.concatenate(
        [
            held.points_on_curves(T, sample_values(solver.chain, held.held[0], values, False))
            for held in solver.sweeps
        ]
    )


def nearest_members(solver: Sweep, T: Array, seed: Array, within_limits: bool) -> Array:
    """Solutions (k, n) that are nearer to a seed (n,) than their neighbours on the self-motion.

    The first is the nearest of all, on every curve that was found.
    """
    chain = solver.chain
    if within_limits:
        q = inside_members(solver, T, seed, STARTS)
    else:
        q = turned_to(chain, _on_curves(solver, T, VALUES), seed)
        q = q[np.argsort(np.linalg.norm(q - seed, axis=1), kind="stable")]
    beside = beside_seed(chain, Task.POSE, T, seed, within_limits)
    q = np.concatenate([q[:STARTS], beside])
    goal = POSE, T, chain.size
    nearest_on_curves(chain.tables, goal, within_limits, q, seed, np.empty(len(q)))
    distance = np.linalg.norm(q - seed, axis=1)
    from_curves = len(q) - len(beside)
    order = [
        *np.argsort(distance[:from_curves], kind="stable").tolist(),
        *range(from_curves, len(q)),
    ]
    kept: list[int] = []
    for k in order:
        if all(np.abs(q[k] - q[j]).max() > SAME for j in kept):
            kept.append(k)
    nearest: Array = q[sorted(kept, key=lambda k: float(distance[k]))]
    return nearest


def reach_intervals(solver: Sweep, T: Array, within_limits: bool) -> Array:
    """Intervals of the swept joint in which a pose is reached, shape (k, 2), ascending.

    Reach is tried at ``GRID`` values a turn and at the members of narrow curves; between a value
    that has a solution and one that has none the end is found by halving.
    """
    values = _grid(solver, within_limits)
    reached = _reached(solver, T, values, within_limits)
    if within_limits:
        extra = inside_members(solver, T, middle(solver.chain), 16 * VALUES)[:, solver.joint]
        extra = _every_turn(solver, extra[_reached(solver, T, extra, True)])
        values = np.concatenate([values, extra])
        reached = np.concatenate([reached, np.ones(len(extra), np.bool_)])
        order = np.argsort(values, kind="stable")
        values, reached = values[order], reached[order]
    change = np.flatnonzero(reached[1:] != reached[:-1])
    ends = _ends(solver, T, values[change], values[change + 1], reached[change], within_limits)
    if reached[0]:
        ends = np.concatenate([values[:1], ends])
    if reached[-1]:
        ends = np.concatenate([ends, values[-1:]])
    return ends.reshape(-1, 2)


def _every_turn(solver: Sweep, values: Array) -> Array:
    """Values of the swept joint in all turns that its limits allow, shape (k,)."""
    lower, upper = solver.joints[solver.joint, 1:]
    if solver.joints[solver.joint, 0] or not np.isfinite(upper - lower):
        return values
    most = np.ceil((upper - lower) / TWO_PI)
    turns = np.arange(-most, most + 1.0)
    every = (values[:, None] + TWO_PI * turns).ravel()
    inside: Array = every[(lower <= every) & (every <= upper)]
    return inside


def _grid(solver: Sweep, within_limits: bool) -> Array:
    """Values at which reach is tried, both bounds of the range among them."""
    one_turn = sample_values(solver.chain, solver.joint, 2, False)
    step = (one_turn[1] - one_turn[0]) * 2.0 / GRID
    lower, upper = one_turn[0] - 0.25 * GRID * step, one_turn[1] + 0.25 * GRID * step
    if within_limits:
        low, high = solver.chain.lower[solver.joint], solver.chain.upper[solver.joint]
        lower = float(low) if np.isfinite(low) else lower
        upper = float(high) if np.isfinite(high) else upper
    parts = np.ceil((upper - lower) / step) if step else 1.0
    if parts > SAMPLES:
        raise ArgumentError(
            f"intervals: the range of {solver.chain.names[solver.joint]} takes {parts:.3g} values, "
            f"at most {SAMPLES} are tried; within_limits=False tries one turn"
        )
    grid: Array = np.linspace(lower, upper, max(2, int(parts) + 1))
    return grid


def _reached(solver: Sweep, T: Array, values: Array, within_limits: bool) -> Array:
    """Whether the pose has a sharp solution at each of the values (s,), bool shape (s,)."""
    m = len(values)
    out, Ts = Outputs.of(m, solver.held.kmax, solver.chain.n), np.repeat(T[None], m, axis=0)
    solver.held.solve_held(Ts, np.ascontiguousarray(values[:, None]), within_limits, out)
    out.residual[np.arange(solver.held.kmax) >= out.counts[:, None]] = np.inf
    sharp: Array = out.residual.min(axis=1) <= SHARP * max(1.0, solver.chain.size)
    return sharp


def _ends(
    solver: Sweep, T: Array, left: Array, right: Array, reached: Array, within_limits: bool
) -> Array:
    """Ends between values of which the pose is reached at one, halved until they are known."""
    left, right = left.copy(), right.copy()
    while np.any(right - left > INTERVAL_END):
        middle = 0.5 * (left + right)
        as_left = _reached(solver, T, middle, within_limits) == reached
        left, right = np.where(as_left, middle, left), np.where(as_left, right, middle)
    return np.where(reached, left, right)
