"""How the time of a batch grows from one pose to a million, on one and two threads."""

from __future__ import annotations

from benchmarks.arms import arm_named
from benchmarks.clock import Block, interleaved
from benchmarks.contestant import BatchContestant, NotCoveredError
from benchmarks.marker import at_work
from benchmarks.peers.ours import Ours
from benchmarks.results import Results, Row

__all__ = ["KEYS", "QUICK", "run"]

MOST = {"puma560": 1_000_000, "ur5": 1_000_000, "fanuc_crx10ia": 10_000}
"""Arms and their largest batch."""

KEYS = QUICK = tuple(MOST)


def run(results: Results, keys: tuple[str, ...]) -> None:
    """Ours, and EAIK where it is there, up to 100,000 poses."""
    for key in keys:
        for m in (10**k for k in range(7)):
            if m <= (100 if results.quick else MOST[key]):
                _one_size(results, key, m)


def _one_size(results: Results, key: str, m: int) -> None:
    arm = arm_named(key)
    _, T = arm.draw(m)
    blocks: dict[str, Block] = {}
    for own in _solvers(key, m, results):
        for threads in (1, 2):
            blocks[f"{own.name}|{threads}"] = _block(own, T, threads)
    budget = 0.05 if results.quick else 1.5
    for name, timing in interleaved(blocks, budget, least=3).items():
        contestant, threads = name.split("|")
        results.add(Row.timed("scaling", key, contestant, timing, size=m, threads=int(threads)))


def _solvers(key: str, m: int, results: Results) -> list[BatchContestant]:
    arm = arm_named(key)
    found: list[BatchContestant] = [Ours(arm)]
    if m > 100_000 or "EAIK" in results.excluded:
        return found
    at_work("EAIK")
    try:
        from benchmarks.peers.eaik import Eaik

        found.append(Eaik(arm))
    except NotCoveredError as reason:
        results.left_out[f"EAIK, {key}"] = str(reason)
    except ImportError as error:
        results.left_out["EAIK"] = f"not installed ({error})"
    return found


def _block(own: BatchContestant, T: object, threads: int) -> Block:
    poses = own.encode_batch(T)
    repeats = max(1, 200 // len(poses))

    def block() -> int:
        for _ in range(repeats):
            own.solve_batch(poses, threads)
        return repeats * len(poses)

    return block
