"""Golden answers, the same bits on every machine; ``python -m tests.translate.golden`` writes them.

A line for each arm and task: how many numbers, their digest, and the first three that are no zeros
and no NaN.
"""

import hashlib
import sys
from collections.abc import Iterable
from itertools import islice
from pathlib import Path

import numpy as np

from tests.translate import workload

FILE = Path(__file__).with_name("golden.txt")

COUNT = 24
"""Configurations of each arm."""


def line(arm: str, task: str, answer: workload.Answer) -> str:
    """One task's answers as a line of the file."""
    digest, total, first = hashlib.blake2b(digest_size=8), 0, []
    for given in answer:
        array = np.ascontiguousarray(given)
        if array.dtype.kind == "f":
            array = np.where(np.isnan(array), np.nan, array)
            seen = array[np.isfinite(array) & (array != 0.0)]
            first += [repr(float(x)) for x in seen[: 3 - len(first)]]
        total += array.size
        digest.update(f"{array.dtype.kind}{array.shape}".encode() + array.tobytes())
    return "; ".join([arm, task, str(total), digest.hexdigest(), *first])


def lines(arm: str, tasks: int | None = None) -> Iterable[str]:
    """Lines of an arm, all or the first few."""
    for task, answer in islice(workload.answers(arm, COUNT), tasks):
        yield line(arm, task, answer)


def kept() -> dict[str, list[str]]:
    """The lines of the file by arm."""
    out: dict[str, list[str]] = {}
    for text in FILE.read_text().splitlines():
        out.setdefault(text.partition(";")[0], []).append(text)
    return out


def apart(arms: Iterable[str]) -> list[str]:
    """Lines that differ from those of the file."""
    return [text for arm in arms for text in lines(arm) if text not in kept()[arm]]


if __name__ == "__main__":
    if sys.argv[1:]:  # arms, to be compared by a process with settings of its own
        sys.exit("\n".join(apart(sys.argv[1:])) or 0)
    FILE.write_text("".join(f"{text}\n" for arm in workload.arms() for text in lines(arm)))
