"""Calls of the kernels' entries, recorded at their doors, and replayed by other forms of them."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from dh2urdf.engine import INTERPRETED
from dh2urdf.translate.entries import entries


@dataclass(frozen=True)
class Call:
    """An entry's arguments before, and all that may have changed after: returned, then arrays."""

    entry: str
    given: tuple[Any, ...]
    after: list[Any]


def leaves(value: Any) -> list[Any]:
    """What tuples are made of."""
    return [x for v in value for x in leaves(v)] if isinstance(value, tuple) else [value]


def copied(value: Any) -> Any:
    """A copy of an argument, of tuples all the way."""
    if isinstance(value, tuple):
        return tuple(map(copied, value))
    return value.copy(order="C") if isinstance(value, np.ndarray) else value


def changed(returned: Any, arguments: tuple[Any, ...]) -> list[Any]:
    """What a call leaves behind."""
    arrays = [x for x in leaves(arguments) if isinstance(x, np.ndarray)]
    return ([] if returned is None else leaves(returned)) + arrays


def call(function: Callable[..., Any], entry: str, given: tuple[Any, ...]) -> Call:
    """Call a form of an entry with a copy of the arguments."""
    arguments = copied(given)
    return Call(entry, given, changed(function(*arguments), arguments))


@contextmanager
def entries_as(form: Callable[[str, Any], Any]) -> Iterator[None]:
    """Other forms of the entries, from their names and what they are, wherever they are named."""
    entries()
    where = {name: name.rpartition(".") for name in INTERPRETED}
    now = {name: getattr(sys.modules[room], key) for name, (room, _, key) in where.items()}
    pairs = [(f, form(name, f)) for name, f in now.items()]
    _swap({id(old): new for old, new in pairs})
    try:
        yield
    finally:  # in modules that were imported meanwhile too
        _swap({id(new): old for old, new in pairs})


def _swap(other: dict[int, Any]) -> None:
    """Put others in the place of some functions, wherever these are named."""
    for holder in _holders():
        for key, value in list(vars(holder).items()):
            new = other.get(id(getattr(value, "__func__", value)))
            if new is not None:
                setattr(holder, key, staticmethod(new) if isinstance(holder, type) else new)


def _holders() -> list[Any]:
    """The package's modules and their classes."""
    modules = [m for name, m in list(sys.modules.items()) if name.partition(".")[0] == "dh2urdf"]
    things = [x for m in modules for x in vars(m).values() if isinstance(x, type)]
    return [*modules, *{x for x in things if x.__module__.partition(".")[0] == "dh2urdf"}]


@contextmanager
def interpreted() -> Iterator[None]:
    """All entries as they are written, calls of one by another too."""
    with np.errstate(all="ignore"), entries_as(lambda name, _: INTERPRETED[name]):
        yield


@contextmanager
def recorded(keep: Callable[[str, tuple[Any, ...]], bool]) -> Iterator[list[Call]]:
    """The calls meanwhile that are to be kept, given name and arguments."""
    calls: list[Call] = []

    def form(name: str, function: Any) -> Any:
        def door(*arguments: Any) -> Any:
            if not keep(name, arguments):
                return function(*arguments)
            given = copied(arguments)
            returned = function(*arguments)
            calls.append(Call(name, given, copied(tuple(changed(returned, arguments)))))
            return returned

        return door

    with entries_as(form):
        yield calls


def differing(a: list[Any], b: list[Any]) -> int:
    """How many numbers differ in any bit, NaN being equal to NaN."""
    assert len(a) == len(b)
    return sum(_differing(np.asarray(x), np.asarray(y)) for x, y in zip(a, b, strict=True))


def _differing(x: np.ndarray, y: np.ndarray) -> int:
    assert x.shape == y.shape
    if x.dtype.names:
        return sum(_differing(x[key], y[key]) for key in x.dtype.names)
    if x.dtype.kind != "f":
        return int((x != y).sum())
    apart = x.astype(float).view(np.uint64) != y.astype(float).view(np.uint64)
    return int((apart & ~(np.isnan(x) & np.isnan(y))).sum())
