"""Kernels interpreted strictly: ``python -m tests.translate.strict [ARM...] [--count N]``.

Over the golden questions, or those of some arms: arrays refuse indices and views that are negative
or beyond their end, which C would follow; floating-point errors are told by the line where they
occur; lines that no question reaches are counted. Ends with 1 where an index was refused.
"""

import argparse
import sys
import traceback
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from dh2urdf.engine import INTERPRETED
from tests.translate import probes, workload
from tests.translate.probes import KERNELS, is_kernel, short
from tests.translate.record import entries_as


class OutsideError(IndexError):
    """An index that C would have followed out of an array."""


class Strict(np.ndarray):
    """An array that takes whole numbers from 0 below its length, and stretches inside it."""

    def __getitem__(self, index: Any) -> Any:
        self._check(index)
        return super().__getitem__(index)

    def __setitem__(self, index: Any, value: Any) -> None:
        self._check(index)
        super().__setitem__(index, value)

    def _check(self, index: Any) -> None:
        if not is_kernel(sys._getframe(2).f_code):
            return
        each = index if isinstance(index, tuple) else (index,)
        for one, length in zip(each, self.shape, strict=False):
            if isinstance(one, slice):
                start, stop = one.start or 0, length if one.stop is None else one.stop
                inside = one.step is None and 0 <= start <= stop <= length
            else:
                inside = 0 <= one < length
            if not inside:
                raise OutsideError(f"[{index}] of an array of shape {self.shape}")


def strictly(value: Any) -> Any:
    """An argument with strict arrays, in tuples too."""
    if isinstance(value, tuple):
        return tuple(map(strictly, value))
    return value.view(Strict) if isinstance(value, np.ndarray) else value


def made(make: Any) -> Any:
    """NumPy's maker of arrays, of strict ones; what was never written is NaN."""

    def strict(shape: Any, dtype: Any = float) -> Any:
        array = make(shape, dtype)
        if make is np.empty and array.dtype.kind == "f":
            array.fill(np.nan)
        return array.view(Strict)

    return strict


@contextmanager
def strict_kernels() -> Iterator[None]:
    """All kernels as they are written, on strict arrays."""
    names = [name for name in sys.modules if name.startswith("dh2urdf.kernels.")]
    rooms = [sys.modules[name] for name in names if hasattr(sys.modules[name], "np")]
    shim = SimpleNamespace(**{**vars(np), "empty": made(np.empty), "zeros": made(np.zeros)})

    def form(name: str, _: Any) -> Any:
        kernel = INTERPRETED[name]
        return lambda *given: kernel(*map(strictly, given))

    try:
        for room in rooms:
            room.np = shim
        with entries_as(form):
            yield
    finally:
        for room in rooms:
            room.np = np


def place_of(error: BaseException) -> str:
    """The line of a kernel that an error came from."""
    frames = traceback.extract_tb(error.__traceback__)
    last = [frame for frame in frames if frame.filename.startswith(KERNELS)][-1]
    return f"{short(last.filename)}:{last.lineno}"


def main() -> int:
    """Answer the questions, and tell what was seen."""
    parser = argparse.ArgumentParser(prog="python -m tests.translate.strict", description=__doc__)
    parser.add_argument("arms", nargs="*")
    parser.add_argument("--count", type=int, default=6, help="configurations of each arm")
    parser.add_argument("--tasks", type=int, help="of each arm, the first so many; default: all")
    parser.add_argument("--into", type=Path, help="file that adds up lines reached by several runs")
    parser.add_argument("--missed", action="store_true", help="list lines that were not reached")
    asked = parser.parse_args()
    errors, refused = Counter[str](), 0
    probes.mark_all()

    def told(kind: str, _: int) -> None:
        frame = sys._getframe(1)
        errors[f"{kind} at {short(frame.f_code.co_filename)}:{frame.f_lineno}"] += 1

    for arm in asked.arms or workload.arms():
        answers = islice(workload.answers(arm, asked.count), asked.tasks)
        with np.errstate(divide="call", invalid="call", over="call", call=told), strict_kernels():
            try:
                for _ in answers:
                    pass
            except OutsideError as error:
                refused += 1
                print(f"{arm}: {error} at {place_of(error)}", flush=True)
    if asked.into:
        probes.add(asked.into)
    probes.report(probes.reached(), names=asked.missed)
    for place, count in errors.most_common():
        print(f"{place}: {count} times")
    print(f"{refused} arms with an index refused")
    return int(refused > 0)


if __name__ == "__main__":
    sys.exit(main())
