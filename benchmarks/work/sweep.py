"""7R arms with nothing held: samples along the redundant joint, time and number of solutions."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from benchmarks import referee
from benchmarks.arms import Arm, arm_named
from benchmarks.clock import each, interleaved
from benchmarks.marker import at_work
from benchmarks.peers.ours import OURS
from benchmarks.results import Results, Row
from dh2urdf import Robot

__all__ = ["KEYS", "QUICK", "run"]

Array = NDArray[np.float64]
Answer = Callable[[Array], Sequence[Array] | Array]

KEYS = QUICK = ("franka_fer", "kuka_iiwa14")
SAMPLES = 16
"""Held values a pose, evenly over the joint's range."""


def run(results: Results, keys: tuple[str, ...]) -> None:
    """Time per pose; the number of distinct solutions that hold is beside it."""
    for key in keys:
        arm = arm_named(key)
        _, T = arm.draw(2 if results.quick else 20, seed=2)
        answers = {OURS: _ours(arm), **_peers(arm, results)}
        blocks = {name: each(answer, list(T)) for name, answer in answers.items()}
        timings = interleaved(blocks, 0.2 if results.quick else 6.0, most=100)
        for name, answer in answers.items():
            at_work(name)
            verdict = referee.judge(arm.table, T, [np.array(answer(pose)) for pose in T])
            results.add(
                Row.timed(
                    "7R sweep",
                    key,
                    name,
                    timings[name],
                    size=1,
                    wrong=verdict.wrong,
                    residual=verdict.worst,
                    extra={"solutions": verdict.found / len(T)},
                )
            )


def _ours(arm: Arm) -> Answer:
    """``ik`` with nothing held: it sweeps the joint that it finds best, within limits."""
    robot = Robot.from_dh(arm.table)
    return lambda pose: robot.ik(pose, samples=SAMPLES).q


def _peers(arm: Arm, results: Results) -> dict[str, Answer]:
    """ssik's prebuilt arms and frankik, by their own sampling, within limits."""
    answers: dict[str, Answer] = {}
    for name, build in (("ssik prebuilt", _ssik), ("frankik", _frankik)):
        if name in results.excluded:
            continue
        at_work(name)
        try:
            answer = build(arm)
        except ImportError as error:
            results.left_out[name] = f"not installed ({error})"
            continue
        if answer is not None:
            answers[name] = answer
    return answers


def _ssik(arm: Arm) -> Answer:
    from benchmarks.peers.ssik import prebuilt_module

    module = prebuilt_module(arm)
    return lambda pose: [s.q for s in module.solve(pose)]


def _frankik(arm: Arm) -> Answer | None:
    if arm.key != "franka_fer":
        return None
    import frankik

    start = np.array(frankik.FrankaKinematics("panda").q_home)
    return lambda pose: frankik.ik_sample_q7(
        pose, start, sample_size=SAMPLES, sample_interval=332.0, full_ik=True
    )
