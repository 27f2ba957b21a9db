"""The least joint motion of an arm of seven joints along a path, by a search on a dense grid.

Written for the tests: solutions at held values of a joint, a dynamic programme over all of them,
and ever finer grids around what it finds. No code of the package's paths takes part.
"""

from itertools import pairwise

import numpy as np


def held_solutions(robot, Ts, joint, values):
    """Solutions of poses (m, 4, 4), each at its values (m, s) of a joint: q (m, s, 8, 7)."""
    m, s = values.shape
    q = robot.ik_batch(np.repeat(Ts, s, axis=0), locked={joint: values.ravel()}).q
    return q.reshape(m, s, -1, robot.n)


def cheapest_ways(cost, q, ahead, jump):
    """For each of the states ahead (k, n) of states q (f, n): its cost and predecessor."""
    square = (q**2).sum(1)[:, None] + (ahead**2).sum(1) - 2.0 * q @ ahead.T
    step = np.sqrt(np.maximum(square, 0.0))
    step[step > jump] = np.inf
    total = cost[:, None] + step
    parent = total.argmin(axis=0)
    return total[parent, np.arange(len(ahead))], parent


def through(states, start, jump):
    """The shortest way through lists of states (k_i, n), one state of each: length and q (m, n)."""
    cost = np.zeros(len(states[0])) if start is None else np.linalg.norm(states[0] - start, axis=1)
    parents = []
    for q, ahead in pairwise(states):
        cost, parent = cheapest_ways(cost, q, ahead, jump)
        parents.append(parent)
    k = int(cost.argmin())
    length, way = cost[k], [states[-1][k]]
    for q, parent in zip(states[-2::-1], parents[::-1], strict=True):
        k = parent[k]
        way.append(q[k])
    return float(length), np.array(way[::-1])


def length_of(q, start):
    """Joint motion of a path (m, n), the way from the start counted."""
    whole = q if start is None else np.concatenate([start[None], q])
    return np.linalg.norm(np.diff(whole, axis=0), axis=1).sum()


def refined(robot, Ts, q, start, joints, step, finest, jump):
    """A path (m, n) on ever finer grids of the joints around it."""
    length, offsets = length_of(q, start), np.arange(-2, 3)
    while step > finest:
        gain = 0.0
        for joint in joints:
            values = q[:, joint, None] + step * offsets
            values = np.clip(values, robot.lower[joint], robot.upper[joint])
            found = held_solutions(robot, Ts, joint, values)
            far = np.nan_to_num(np.abs(found - q[:, None, None]).max(axis=-1), nan=np.inf)
            best = np.take_along_axis(found, far.argmin(axis=2)[:, :, None, None], axis=2)[:, :, 0]
            near = far.min(axis=2) < 0.3
            states = [
                np.concatenate([own[None], some[ok]])
                for own, some, ok in zip(q, best, near, strict=True)
            ]
            after, way = through(states, start, jump)
            after = length_of(way, start)
            if after < length:
                gain += length - after
                length, q = after, way
        if gain < 1e-5 * length * step:
            step *= 0.5
    return length, q


def least_motion(robot, Ts, start=None, values=360, jump=0.5, finest=1e-3):
    """Length of the shortest continuous joint path found, from the start, and the path (m, n)."""
    joints = [held.held[0] for held in robot.solver.sweeps]
    low, high = robot.lower[joints[0]], robot.upper[joints[0]]
    low, high = max(low, -np.pi), min(high, np.pi)
    step = (high - low) / values
    grid = low + step * (np.arange(values) + 0.5)
    found = held_solutions(robot, Ts, joints[0], np.repeat(grid[None], len(Ts), axis=0))
    states = [q[np.isfinite(q[..., 0])] for q in found]
    if start is not None:
        states[0] = np.concatenate([states[0], start[None]])
    _, q = through(states, start, jump)
    return refined(robot, Ts, q, start, joints, step, finest, jump)
