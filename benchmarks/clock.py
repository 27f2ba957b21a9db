"""Interleaved timing: every contestant gets a turn in every round, in random order.

What disturbs the machine then disturbs all alike; medians and the spread are kept.
"""

from __future__ import annotations

import gc
import random
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

__all__ = ["Timing", "each", "interleaved"]

Block = Callable[[], int]
"""Does some work and returns how many units it was."""


@dataclass(frozen=True)
class Timing:
    """Seconds per unit: median, 10 % and 90 % quantiles over the rounds."""

    median: float
    low: float
    high: float
    rounds: int
    units: int

    @classmethod
    def of(cls, seconds: Sequence[float], units: int) -> Timing:
        """Summary of the seconds per unit of some rounds."""
        low, median, high = (float(v) for v in np.quantile(seconds, [0.1, 0.5, 0.9]))
        return cls(median, low, high, len(seconds), units)


def each(call: Callable[[Any], Any], items: Sequence[Any], seconds: float = 0.03) -> Block:
    """A block of single calls, one per item, going round until it lasts about so long."""
    start = time.perf_counter()
    done = 0
    while done < len(items) and time.perf_counter() - start < seconds:
        call(items[done])
        done += 1
    per_call = (time.perf_counter() - start) / done
    count = max(1, min(10 * len(items), round(seconds / per_call)))
    work = [items[i % len(items)] for i in range(count)]

    def block() -> int:
        for item in work:
            call(item)
        return count

    return block


def interleaved(
    blocks: Mapping[str, Block], budget: float, *, least: int = 5, most: int = 60
) -> dict[str, Timing]:
    """Time blocks in turn until the budget [s] is spent.

    Each runs once before it counts. At least ``least`` rounds are made, whatever the budget, but
    a block that alone would take more than the budget in three rounds gets three.
    """
    seconds: dict[str, list[float]] = {name: [] for name in blocks}
    units = {name: block() for name, block in blocks.items()}
    order = list(blocks)
    chance = random.Random(0)
    start = time.perf_counter()
    for k in range(most):
        chance.shuffle(order)
        for name in order:
            if k >= 3 and sum(seconds[name]) * units[name] > budget:
                continue
            gc.collect()
            gc.disable()
            begin = time.perf_counter()
            done = blocks[name]()
            seconds[name].append((time.perf_counter() - begin) / done)
            gc.enable()
        if k + 1 >= least and time.perf_counter() - start > budget:
            break
    return {name: Timing.of(s, units[name]) for name, s in seconds.items()}
