"""Inverse kinematics: one pose a call and many at once; recall and residual beside the time."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import ARMS, Arm, arm_named
from benchmarks.clock import Block, each, interleaved
from benchmarks.contestant import BatchContestant, IKContestant
from benchmarks.machine import touch_memory
from benchmarks.marker import at_work
from benchmarks.peers import contestants
from benchmarks.referee import Verdict
from benchmarks.results import Results, Row

__all__ = ["KEYS", "QUICK", "run"]

Array = NDArray[np.float64]

KEYS = tuple(arm.key for arm in ARMS)
QUICK = ("puma560", "ur5", "ur5e_calibrated", "so101", "jaco2_urdf", "franka_fer", "flexiv_rizon4")
"""Arms of the short run: one a class."""

BATCH = {"spherical wrist": 100_000, "three parallel axes": 100_000, "7R, one held": 100_000}
"""Poses of a batch; 2,000 for the other classes."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """One pose a call and many, of these arms."""
    for arm in map(arm_named, keys):
        entrants = list(contestants(arm, results))
        for c in entrants:
            if c.seconds_to_build is not None:
                results.add(Row("build", arm.key, c.name, seconds=c.seconds_to_build))
        _single(results, arm, entrants)
        _batch(results, arm, [c for c in entrants if isinstance(c, BatchContestant)])


def _single(results: Results, arm: Arm, entrants: Sequence[IKContestant]) -> None:
    """Recall on the same poses for all, then the bare and the public call, interleaved."""
    q, T = arm.draw(10 if results.quick else 200)
    verdicts = {c.name: _verdict(c, arm, T) for c in entrants}
    known = referee.truth(list(verdicts.values()), q)
    for c in entrants:
        if not verdicts[c.name].found:
            results.left_out[f"{c.name}, {arm.key}"] = f"no solution on {len(T)} poses"
    entrants = [c for c in entrants if verdicts[c.name].found]
    poses = {c.name: list(c.encode(T)) for c in entrants}
    bare = {f"{c.name}|bare": each(c.solve, poses[c.name]) for c in entrants}
    public = {f"{c.name}|public": each(c.public, poses[c.name]) for c in entrants}
    budget = 0.5 if results.quick else 12.0
    for key, timing in interleaved(bare | public, budget, most=400).items():
        name, call = key.split("|")
        own = next(c for c in entrants if c.name == name)
        results.add(
            Row.timed(
                f"ik one, {call}",
                arm.key,
                name,
                timing,
                size=1,
                **_judged(verdicts[name], known, arm, own),
            )
        )


def _verdict(own: IKContestant, arm: Arm, T: Array) -> Verdict:
    """What the referee says of a contestant's answers to poses T (m, 4, 4)."""
    at_work(own.name)
    answers = [own.configurations(own.solve(pose)) for pose in own.encode(T)]
    return referee.judge(arm.table, T, answers)


def _judged(
    verdict: Verdict, known: Sequence[Array], arm: Arm, own: IKContestant
) -> dict[str, object]:
    """Recall, wrong answers and worst residual for a row."""
    if own.keeps_limits:
        known = [_inside(arm, q) for q in known]
    return {
        "recall": verdict.recall(known),
        "wrong": verdict.wrong,
        "residual": verdict.worst,
        "extra": {
            "claimed": verdict.claimed,
            "known": sum(len(k) for k in known),
            "searches": own.searches,
        },
    }


def _inside(arm: Arm, q: Array) -> Array:
    """Rows of q (k, n) that some full turn brings into the limits."""
    low = np.array([-np.inf if r.lower is None else r.lower for r in arm.rows])
    high = np.array([np.inf if r.upper is None else r.upper for r in arm.rows])
    turned = low + np.mod(q - low, 2.0 * np.pi)
    return q[(turned <= high).all(axis=1)]


def _batch(results: Results, arm: Arm, entrants: Sequence[BatchContestant]) -> None:
    """The same batch for all, on one and on two threads."""
    m = 500 if results.quick else BATCH.get(arm.family, 2_000)
    q, T = arm.draw(m, seed=1)
    blocks: dict[str, Block] = {}
    verdicts = {}
    for c in entrants:
        at_work(c.name)
        few = min(m, 2_000)
        answer = c.solve_batch(c.encode_batch(T[:few]), c.threads[-1])
        verdicts[c.name] = referee.judge(arm.table, T[:few], c.batch_configurations(answer))
        if not verdicts[c.name].found:
            continue
        share = _affordable(c, T)
        for threads in c.threads:
            blocks[f"{c.name}|{threads}"] = _batch_block(c, T[:share], threads)
    known = referee.truth(list(verdicts.values()), q[:2_000])
    budget = 0.5 if results.quick else 15.0
    for key, timing in interleaved(blocks, budget, most=15, before=touch_memory).items():
        name, threads = key.split("|")
        own = next(c for c in entrants if c.name == name)
        judged = _judged(verdicts[name], known, arm, own)
        results.add(Row.timed("ik batch", arm.key, name, timing, threads=int(threads), **judged))


def _affordable(own: BatchContestant, T: Array) -> int:
    """As many of the poses as take a contestant about a second; at least twenty."""
    poses = own.encode_batch(T[:20])
    own.solve_batch(poses, 1)
    start = time.perf_counter()
    own.solve_batch(poses, 1)
    seconds = time.perf_counter() - start
    return int(min(len(T), max(20, 20 / seconds)))


def _batch_block(own: BatchContestant, T: Array, threads: int) -> Block:
    poses = own.encode_batch(T)

    def block() -> int:
        own.solve_batch(poses, threads)
        return len(T)

    return block
