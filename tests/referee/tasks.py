"""Arms of fewer joints, asked for a position, or for a position and the direction of z."""

from typing import Any, NamedTuple

import numpy as np
from ik_referee import forward, gaps
from sweep import ACCEPT, MOST, REGULAR, ROUNDING, Tally

import dh2urdf
from dh2urdf.chain import SerialChain
from dh2urdf.dh import DHTable
from tests.referee.search import search, starts, task_errors, task_jacobians

LEAST = 1e-6
"""What a solution of a search may be off by at most [rad or m]."""


class Asked(NamedTuple):
    """A task, the joints of an arm, and how many of the first are held."""

    task: str
    joints: int
    held: int


TASKS = {
    "position of three joints": Asked("position", 3, 0),
    "position of four joints, one held": Asked("position", 4, 1),
    "position of five joints, two held": Asked("position", 5, 2),
    "position and axis of five joints": Asked("position+axis", 5, 0),
    "position and axis of six joints, one held": Asked("position+axis", 6, 1),
}


def one_arm(
    tally: Tally, table: DHTable, name: str, poses: int, begins: int, seed: list[int]
) -> None:
    """Count what a search of its own finds and the solver does not, and what is no solution."""
    asked, robot = TASKS[name], dh2urdf.Robot.from_dh(table)
    chain, rng = robot.chain, np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (poses, robot.n))
    held = list(range(asked.held))
    moving = ~np.isin(np.arange(robot.n), held)
    Ts = np.ascontiguousarray(forward(chain, q))
    locked: Any = {joint: q[:, joint] for joint in held} or None
    batch = robot.ik_batch(Ts, task=asked.task, within_limits=False, locked=locked)
    tally.count["arms"] += 1
    for i, T in enumerate(Ts):
        found = batch.q[i, : batch.count[i]]
        tally.count["poses"] += 1
        tally.count["solutions"] += len(found)
        judge(tally, table, chain, found, T, asked.task)
        begin = starts(chain, q[i], begins, moving, seed[1] + i)
        own = search(chain, T, begin, moving, asked.task)
        least = smallest(chain, np.concatenate([q[i : i + 1], own]), asked.task, moving)
        tally.count["singular"] += int(least[0] < REGULAR)
        for k, p in enumerate([q[i], *own]):
            if least[k] < REGULAR:
                continue
            tally.count["searched"] += k > 0
            tolerance = max(LEAST, 1e2 * ROUNDING / least[k])
            if not len(found) or gaps(chain, found, p).min() > tolerance:
                tally.note("search lost" if k else "regular lost", table, p)


def smallest(chain: SerialChain, q: np.ndarray, task: str, moving: np.ndarray) -> np.ndarray:
    """Smallest singular value of the task that matters, of configurations (m, n)."""
    J = task_jacobians(chain, q, forward(chain, q), task)[..., moving]
    J[..., :3, :] /= chain.size
    rank = 3 if task == "position" else 5
    return np.linalg.svd(J, compute_uv=False)[..., rank - 1]


def judge(
    tally: Tally, table: DHTable, chain: SerialChain, found: np.ndarray, T: np.ndarray, task: str
) -> None:
    """Count solutions that miss the task, or are there twice."""
    if not len(found):
        return
    e = task_errors(forward(chain, found), T, task)
    off = np.linalg.norm(e.reshape(len(found), -1, 3), axis=-1)
    if off.max() > ACCEPT:
        tally.note("wrong", table, found[int(off.max(axis=1).argmax())])
    away = gaps(chain, found[:, None], found[None]) + 9.0 * np.eye(len(found))
    if (away < MOST).any():
        tally.note("twice", table, found[0])
