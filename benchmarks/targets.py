"""What was aimed at before anything was measured, and what came of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from benchmarks.arms import ARMS
from benchmarks.compare import seconds, times
from benchmarks.peers.ours import OURS
from benchmarks.results import Results
from benchmarks.target_figures import (
    CLOSED,
    Figure,
    absolute,
    batches,
    below,
    everything,
    forward,
    gain,
    held_call,
    importing,
    memory,
    non_pieper,
    one_pose,
    swept,
)
from benchmarks.work.breakdown import BUILT, PLANNED

__all__ = ["TARGETS", "Target", "target_rows"]


@dataclass(frozen=True)
class Target:
    """A bound, how it is measured, and what stands in the way where it is missed."""

    what: str
    bound: str
    measure: Callable[[Results], Iterable[Figure]]
    obstacle: Callable[[Results], str]


def target_rows(results: Results) -> Iterator[tuple[str, ...]]:
    """Target, bound, measured, met or missed and why."""
    for target in TARGETS:
        figures = list(target.measure(results))
        if not figures:
            yield target.what, target.bound, "not measured", "–"
            continue
        met = all(enough for _, enough in figures)
        verdict = "met" if met else f"**missed**: {target.obstacle(results)}"
        yield target.what, target.bound, "; ".join(words for words, _ in figures), verdict


def _part(results: Results, arm: str, name: str, work: str = "breakdown") -> str:
    """A figure that explains another."""
    rows = (r for r in results.of(work, arm) if r.contestant == name)
    return seconds(next((r.seconds for r in rows), None))


def _why_batch(results: Results) -> str:
    names = "in the cache", "batch, out", "arctangents", "memory"
    said = []
    for arm in (a.key for a in ARMS if a.family in CLOSED):
        cached, again, angles, memory = (_part(results, arm, name, "limit") for name in names)
        said.append(
            f"a pose of {arm} takes {cached} where the answers stay in the cache and {again} where "
            f"they do not, of which arctangents are {angles} and writing them {memory}"
        )
    return "; ".join((*said, "the rest is arithmetic, and fresh memory that a large batch needs"))


def _why_threads(results: Results) -> str:
    registers, filling = (_times(results, name) for name in ("registers", "filling memory"))
    cached = _part(results, "puma560", "in the cache", "limit")
    whole, waking = (
        _part(results, "puma560", OURS, "ik batch"),
        _part(results, "", "waking", "cores"),
    )
    return (
        f"two processes that calculate in registers gain {registers} on this machine, two that "
        f"fill memory {filling}: of the {whole} of a pose (puma560) what exceeds {cached}, which "
        f"it takes in the cache, is not shared; a thread that sleeps goes on after {waking}"
    )


def _times(results: Results, name: str) -> str:
    """What two processes gain over one."""
    found = {r.threads: r.seconds for r in results.of("cores") if r.contestant == name}
    one, two = found.get(1), found.get(2)
    return times(one / two) if one and two else "–"


def _why_building(results: Results) -> str:
    tried = ", ".join(f"{_part(results, arm, 'trying eliminations')} ({arm})" for arm in PLANNED)
    robots = ", ".join(
        f"{_part(results, arm, 'robot, no solver')} ({arm}), of which Pinocchio's model alone "
        f"{_part(results, arm, 'Pinocchio model')}"
        for arm in BUILT
    )
    return (
        f"a robot without a solver takes {robots}; the general solver tries twelve eliminations "
        f"on 24 poses each: {tried}; arms of seven joints look for values at which the rest has a "
        f"joint to spare: {_part(results, 'kuka_iiwa14', 'special values')} (kuka_iiwa14)"
    )


def _why_table(results: Results) -> str:
    model = _part(results, "puma560", "Pinocchio model")
    return f"Pinocchio's model takes {model} of it, the rest is checks and the chain"


def _why_one_pose(results: Results) -> str:
    whole, entry, solver = (
        _part(results, "puma560", name)
        for name in ("robot.ik", "solver, no pose", "solver, one pose")
    )
    return (
        f"of {whole} (puma560) the solver takes {solver}, {entry} of it without a pose; the rest "
        "checks the pose and makes the object of the answer"
    )


def _why_first(results: Results) -> str:
    return f"importing Pinocchio takes {_part(results, '', 'Pinocchio', 'import')} of it"


def _why_convert(results: Results) -> str:
    alone = _part(results, "ur5", "Python, NumPy, Pinocchio", "process")
    return f"Python with NumPy and Pinocchio takes {alone} of it"


def _see(words: str) -> Callable[[Results], str]:
    """An explanation that is in another table."""
    return lambda results: words


TARGETS = (
    Target(
        "closed-form 6R, bare `robot.ik`",
        "twice as fast as the bare call of any compiled solver, 1.5 µs",
        one_pose,
        _why_one_pose,
    ),
    Target(
        "closed-form 6R, batch of 100,000 poses, one thread",
        "12 times EAIK's batch",
        batches(CLOSED, 12.0, 1),
        _why_batch,
    ),
    Target(
        "the same",
        "Puma and KUKA 0.15 µs on x86-64-v3 and 0.10 on v4, UR 0.20 and 0.15",
        absolute,
        _why_batch,
    ),
    Target(
        "the same on two threads", "10 times EAIK's batch", batches(CLOSED, 10.0, 2), _why_batch
    ),
    Target("two threads against one", "1.8 times", gain, _why_threads),
    Target(
        "non-Pieper 6R, batch, one thread",
        "1.3 times `crx-kinematics` on the CRX, under 12 µs on all",
        non_pieper,
        _see("determinants and their roots are arithmetic, see the solver's times below"),
    ),
    Target(
        "7R at a held value, one call",
        "faster than EAIK with the joint held",
        held_call,
        _see("ours takes the value with the call, EAIK's robot is built for it"),
    ),
    Target(
        "7R at a held value, batch",
        "8 times EAIK with the joint held",
        batches(("7R, one held",), 8.0, 2),
        _see("see how far each is from its limit below"),
    ),
    Target(
        "7R swept in 16 samples, for each solution",
        "faster than `frankik` and any other, 1 µs",
        swept,
        _see("each sample is a closed form, see the held joints above"),
    ),
    Target(
        "every solution of every arm",
        "all that anybody finds, none wrong",
        everything,
        _see("all solvers' shares are below"),
    ),
    Target(
        "FK of a batch",
        "10 times a Python loop over Pinocchio, equal to 1e-13",
        forward,
        _see("cosines and sines are among the parts of a call below"),
    ),
    Target(
        "building robot and solver, any class",
        "under 1.5 ms",
        below(1.5e-3, "build"),
        _why_building,
    ),
    Target(
        "`robot.with_table` of a table that differs little",
        "0.3 ms",
        below(3e-4, "breakdown", "with_table"),
        _why_table,
    ),
    Target(
        "a new process: import, robot and first solutions",
        "under 0.4 s",
        below(0.4, "first call"),
        _why_first,
    ),
    Target(
        "`dh2urdf convert`, whole process",
        "under 1 s",
        below(1.0, "process", "convert"),
        _why_convert,
    ),
    Target(
        "memory of a batch",
        "its arrays and at most a tenth more",
        memory,
        _see("the rest is between the steps of the kernels"),
    ),
    Target(
        "`import dh2urdf` beyond NumPy",
        "under 0.25 s, no Pinocchio",
        importing,
        _see("see what is loaded"),
    ),
)
