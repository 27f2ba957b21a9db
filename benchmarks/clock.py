"""Interleaved timing: every contestant gets a turn in every round, in random order.

What disturbs the machine then disturbs all alike; medians and the spread are kept.
"""

from __future__ import annotations

import gc
import random
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle, islice
from typing import Any

import numpy as np

from benchmarks.machine import worked
from benchmarks.marker import at_work

__all__ = ["Timing", "each", "interleaved"]

Block = Callable[[], int]
"""Does some work and returns how many units it was."""


@dataclass(frozen=True)
class Timing:
    """Seconds per unit: median, 10 % and 90 % quantiles over the rounds, median processor time."""

    median: float
    low: float
    high: float
    rounds: int
    units: int
    processor: float

    @classmethod
    def of(cls, seconds: Sequence[float], units: int, processor: Sequence[float] = ()) -> Timing:
        """Summary of the seconds per unit of some rounds."""
        low, median, high = (float(v) for v in np.quantile(seconds, [0.1, 0.5, 0.9]))
        return cls(median, low, high, len(seconds), units, float(np.median(processor or seconds)))


def each(call: Callable[[Any], Any], items: Sequence[Any], seconds: float = 1e-3) -> Block:
    """A block of single calls, one per item, going round until it lasts about so long.

    Short blocks, many rounds: on a busy machine most of them are not interrupted.
    """
    turn = cycle(items)
    count = 0

    def block() -> int:
        nonlocal count
        count = count or round(seconds / _per_call(call, items))
        count = max(1, min(10 * len(items), count))
        for item in islice(turn, count):
            call(item)
        return count

    return block


def _per_call(call: Callable[[Any], Any], items: Sequence[Any]) -> float:
    """Seconds of a call, roughly."""
    start = time.perf_counter()
    done = 0
    while done < len(items) and time.perf_counter() - start < 0.01:
        call(items[done])
        done += 1
    return (time.perf_counter() - start) / done


def interleaved(
    blocks: Mapping[str, Block],
    budget: float,
    *,
    least: int = 5,
    most: int = 60,
    before: Callable[[], object] = int,
) -> dict[str, Timing]:
    """Time blocks in turn until the budget [s] is spent.

    A block is named for its contestant, with more behind a bar where there are several. Each runs
    once before it counts; ``before`` precedes every turn and does not count. At least ``least``
    rounds are made, whatever the budget, but a block that alone has taken more than the budget in
    three rounds gets three.
    """
    wall: dict[str, list[float]] = {name: [] for name in blocks}
    processor: dict[str, list[float]] = {name: [] for name in blocks}
    units = {}
    for name, block in blocks.items():
        at_work(owner(name))
        units[name] = block()
    order = list(blocks)
    chance = random.Random(0)
    start = time.perf_counter()
    gc.disable()
    for k in range(most):
        chance.shuffle(order)
        for name in order:
            if k >= 3 and sum(wall[name]) * units[name] > budget:
                continue
            at_work(owner(name))
            before()
            begin, processed = time.perf_counter(), worked()
            done = blocks[name]()
            processor[name].append((worked() - processed) / done)
            wall[name].append((time.perf_counter() - begin) / done)
        if k + 1 >= least and time.perf_counter() - start > budget:
            break
    gc.enable()
    return {name: Timing.of(s, units[name], processor[name]) for name, s in wall.items()}


def owner(name: str) -> str:
    """The contestant of a block: what stands before the bar in its name."""
    return name.partition("|")[0]
