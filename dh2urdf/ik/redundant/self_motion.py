"""What an arm with one joint to spare can do while its tool stays.

The solutions of a pose are curves in joint space, each running through many values of the swept
joint. Here they are followed: to the member nearest to a seed, into the joint limits, and to the
ends of the intervals of the swept joint in which the pose is reached.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Protocol

import numpy as np

from dh2urdf.bounds import ANGLE, LENGTH, SAMPLES
from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.exceptions import ArgumentError
from dh2urdf.ik.arm import (
    INTERVAL_END,
    LIMIT_SLACK,
    SHARP,
    TWO_PI,
    HeldSolver,
    Outputs,
    coupled,
    inside,
    middle,
    near_ranges,
)
from dh2urdf.kernels.certificate import measure_all
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.redundant import (
    INNER,
    MEMBERS,
    MOST_STARTS,
    WALKED,
    Starts,
    arrange_members,
    enter_all,
    find_starts,
    nearest_of,
    repeat_pose,
    spread,
    start_beside,
)
from dh2urdf.transforms import Array

VALUES = 128
"""Values of the swept joint at which curves are looked for."""

FEW = 32
"""The same, where a sweep at ``GRID`` values has found nothing: most such poses are out of
reach."""

APART = 0.1
"""Joint distance [rad or m] of members that are worth returning side by side."""

PARTS = 16
"""Parts that what an end lies in is divided into."""

GRID = 720
"""Values of the swept joint at which reach is tried; half a degree apart for a whole turn."""

MOST_MEMBERS = MOST_STARTS + 1
"""Members that are returned with a seed."""


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


@lru_cache(maxsize=64)
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
    if not len(q):
        q = members(solver, T, middle(chain), within_limits, FEW)
    q = q.copy()
    return _measured(solver, T, q[: min(spread(APART, q), most)])


def _measured(solver: Sweep, T: Array, q: Array) -> tuple[Array, Array]:
    """Solutions (k, n) and their residuals (k,) on the exact chain."""
    q, residual, count = np.ascontiguousarray(q), np.empty(len(q)), np.array([len(q)])
    measure_all(solver.chain.tables, POSE, T[None], q[None], count, residual[None])
    return q, residual


def members(
    solver: Sweep, T: Array, goal: Array, within_limits: bool, values: int = VALUES
) -> Array:
    """Members (k, n) of the curves of a pose at some values and between, nearest to a goal first.

    At least one of each curve, and of each part of it within the limits.
    """
    steps, starts, out = _curve_steps(solver, T, goal, within_limits, values)
    run(steps)
    found = out.q[np.arange(out.q.shape[1]) < out.counts[:, None]]
    q = np.concatenate([found, starts.inner[: starts.counts[INNER]]])
    q = q[inside(solver.chain, q)] if within_limits else q
    ordered: Array = q[np.argsort(np.linalg.norm(q - goal, axis=1), kind="stable")]
    return ordered


def run(steps: Iterable[Step]) -> None:
    """Go through steps one by one."""
    for kernel, arguments, _ in steps:
        kernel(*arguments)


def _curve_steps(
    solver: Sweep, T: Array, goal: Array, within_limits: bool, values: int
) -> tuple[tuple[Step, ...], Starts, Outputs]:
    """Steps that find the curves of a pose, where they come nearest to a goal (n,), the sweeps.

    The curves are looked for in sweeps of two joints over a whole turn, limits or not, for one that
    is short in one joint is seldom short in the other. Those found outside the limits are followed
    inwards, the nearest to the goal and the limits.
    """
    chain, starts = solver.chain, Starts.of(MOST_STARTS, solver.chain.n)
    quick = [held for held in solver.sweeps if held.quick] or solver.sweeps
    each, ends = values * len(solver.sweeps) // len(quick), np.empty((len(quick), 2), np.int64)
    out, steps = Outputs.of((each + WALKED) * len(quick), solver.held.kmax, chain.n), []
    for k, held in enumerate(quick):
        joint, first = held.held[0], k * (each + WALKED)
        rows = out.rows(slice(first, first + each + WALKED))
        steps.append(held.sweep(T, sample_values(chain, joint, each, False), rows))
        ends[k] = (first + each) * (-1 if chain.prismatic[joint] else 1), -first - each - WALKED
    pose = chain.tables, (POSE, T, chain.size)
    find = find_starts, (*pose, LIMIT_SLACK, within_limits, goal, ends.ravel(), out, starts), False
    enter = enter_all, (*pose, goal, starts), False
    return (*steps, find, *((enter,) if within_limits else ())), starts, out


def _nearest_steps(
    solver: Sweep, T: Array, seed: Array, within_limits: bool
) -> tuple[tuple[Step, ...], Starts, Array]:
    """Steps that find the members nearest to a seed (n,) on all curves, their number and room."""
    chain, nearest = solver.chain, np.empty((MOST_MEMBERS, solver.chain.n))
    steps, starts, _ = _curve_steps(solver, T, seed, within_limits, VALUES)
    goal = POSE, T, chain.size
    beside = start_beside, (coupled(chain, within_limits), goal, seed, starts), False
    follow = nearest_of, (chain.tables, goal, within_limits, seed, starts, nearest), False
    return (*steps, beside, follow), starts, nearest


def nearest_members(solver: Sweep, T: Array, seed: Array, within_limits: bool) -> Array:
    """Solutions (k, n) that are nearer to a seed (n,) than their neighbours on the self-motion.

    The first is the nearest of all, on every curve that was found.
    """
    steps, starts, nearest = _nearest_steps(solver, T, seed, within_limits)
    run(steps)
    return nearest[: starts.counts[MEMBERS]]


def towards_seed(
    solver: Sweep, Ts: Array, seed: Array, within_limits: bool, found: Outputs, out: Outputs
) -> tuple[Step, ...]:
    """Steps from what was found of a pose (1, 4, 4) to all that is known of it near a seed (n,).

    The nearest members, `MOST_MEMBERS` at most, and what was found, nearest first.
    """
    chain, most = solver.chain, out.q.shape[1]
    steps, starts, nearest = _nearest_steps(solver, Ts[0], seed, within_limits)
    largest = np.where(chain.prismatic, LENGTH, ANGLE)
    known = chain.tables, Ts, within_limits, largest, LIMIT_SLACK, seed, starts, nearest, found, out
    room = np.empty(most), np.empty(most, np.int64)
    return (*steps, (arrange_members, (*known, *room), True))


def reach_intervals(solver: Sweep, T: Array, within_limits: bool) -> Array:
    """Intervals of the swept joint in which a pose is reached, shape (k, 2), ascending.

    Reach is tried at ``GRID`` values a turn and at the members of narrow curves; between a value
    that has a solution and one that has none the end is found by dividing.
    """
    values = _grid(solver, within_limits)
    reached = _reached(solver, T, values, within_limits)
    if within_limits:
        extra = members(solver, T, middle(solver.chain), True)[:, solver.joint]
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
    out, Ts = Outputs.of(m, solver.held.kmax, solver.chain.n), np.empty((m, 4, 4))
    repeat_pose(T[None], Ts)
    solver.held.solve_held(Ts, np.ascontiguousarray(values[:, None]), within_limits, out)
    out.residual[np.arange(solver.held.kmax) >= out.counts[:, None]] = np.inf
    sharp: Array = out.residual.min(axis=1) <= SHARP * max(1.0, solver.chain.size)
    return sharp


def _ends(
    solver: Sweep, T: Array, left: Array, right: Array, reached: Array, within_limits: bool
) -> Array:
    """Ends between values of which the pose is reached at one, divided until they are known."""
    parts, rows = np.arange(1.0, PARTS) / PARTS, np.arange(len(left))
    while np.any(right - left > INTERVAL_END + 4.0 * np.spacing(np.abs(right))):
        values = left[:, None] + (right - left)[:, None] * parts
        there = _reached(solver, T, values.ravel(), within_limits).reshape(values.shape)
        values = np.column_stack([left, values, right])
        first = np.argmin(np.column_stack([there == reached[:, None], np.zeros(len(left))]), axis=1)
        left, right = values[rows, first], values[rows, first + 1]
    return np.where(reached, left, right)
