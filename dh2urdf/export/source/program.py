"""What an arm's file has to do for a pose: kernels one after the other, and what they are given.

It is what :mod:`dh2urdf.ik.problem.one_call` does, with arguments told apart: those that are the
same for all poses, those that the caller has, and those that one kernel leaves for another.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, get_type_hints

import numpy as np

from dh2urdf import engine
from dh2urdf.chain import SerialChain
from dh2urdf.engine import Step
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import HeldSolver, Outputs, Room, Solver, SolverBase
from dh2urdf.kernels.general_6r import ARM_6R
from dh2urdf.kernels.in_doubt import (
    IN_DOUBT,
    VALLEYS,
    referee_doubtful,
    search_doubtful,
    widen_parallel,
    widen_wrists,
)
from dh2urdf.transforms import Array

RECORDS = {ARM_6R: "elimination", IN_DOUBT: "search", VALLEYS: "valleys"}
"""What an arm's workspace has, by what kernels take."""

SEARCHES = search_doubtful, referee_doubtful, widen_wrists, widen_parallel
"""Kernels that leave no pose in doubt."""


class Switch(int):
    """Whether limits count: an argument of the exported function."""


@dataclass(frozen=True)
class Call:
    """A kernel as it is defined, its arguments, and the names that its annotations have for them.

    Its arguments are numbers, arrays that are known, :class:`Named` ones, or tuples of these.
    """

    kernel: Callable[..., Any]
    arguments: tuple[Any, ...]


@dataclass(frozen=True)
class Named:
    """An argument of which the value is not known: its name, and what it is like."""

    name: str
    like: Any


@dataclass(frozen=True)
class Program:
    """The calls that solve a pose."""

    chain: SerialChain
    solver: Solver | HeldSolver
    held: tuple[int, ...]
    out: Outputs
    """Where the solutions go, by names: fields of the struct that the caller has."""
    calls: tuple[Call, ...]
    scratch: tuple[Named, ...]
    """Arrays that one kernel leaves for another."""
    records: tuple[Named, ...]
    """Structured arrays in which kernels keep what they know and what they work with, each as it is
    before the first pose."""

    @property
    def workspace(self) -> int:
        """Bytes of the records."""
        return sum(record.like.dtype.itemsize for record in self.records)

    @property
    def searches(self) -> bool:
        """Whether poses in doubt are searched, so that none is left."""
        return any(call.kernel in SEARCHES for call in self.calls)

    @classmethod
    def of(cls, chain: SerialChain, solver: Solver | HeldSolver) -> "Program":
        """The program of a solver.

        Raises
        ------
        NoSolverError
            Its poses need more than kernels.
        """
        room, held, limits = Room(solver.kmax, chain.n), np.empty(1), Switch(1)
        inside: Any = limits
        joints: tuple[int, ...] = ()
        take: Callable[[], tuple[Step, ...]] = tuple
        if isinstance(solver, HeldSolver):
            joints, take = solver.held, partial(solver.all_steps, room.Ts, held, inside, room.out)
        elif isinstance(solver, SolverBase):
            take = partial(solver.all_steps, room.Ts, inside, room.out)
        steps = take()
        if not steps:
            left = "with that joint held, what is left is a " if joints else ""
            raise NoSolverError(
                f"{left}{solver}: its solutions need more than kernels; not exported"
            )
        named: dict[str, Any] = {
            "pose": room.Ts,
            "held": held,
            "found->q": room.out.q,
            "found->residual": room.out.residual,
            "found->count": room.out.counts,
            "found->branch": room.out.branch,
            "found->free_joints": room.out.free,
        }
        work = _records(steps)
        blank = tuple(Named(x.name, x.like.copy()) for x in work)
        made = [a for a in _made(steps, take()) if not a.dtype.names]
        scratch = [Named(f"between_{k + 1}", a) for k, a in enumerate(made)]
        known = [*(Named(name, a) for name, a in named.items()), *scratch, *work]
        calls = tuple(Call(k, _told(args, limits, known)) for k, args, _ in steps)
        out = Outputs._make(_told(tuple(room.out), limits, known))
        return cls(chain, solver, joints, out, calls, tuple(scratch), blank)


def definition(kernel: Callable[..., Any]) -> Callable[..., Any]:
    """A kernel as it is written."""
    return engine.INTERPRETED.get(kernel.__name__.replace("__", "."), kernel)


def _told(argument: Any, limits: Switch, known: list[Named]) -> Any:
    """An argument with names in the place of what is not known."""
    if argument is limits:
        return Named("within_limits", True)
    if isinstance(argument, tuple):
        return tuple(_told(a, limits, known) for a in argument)
    if isinstance(argument, np.ndarray):
        return next((x for x in known if _is(x.like, argument)), np.ascontiguousarray(argument))
    return argument.item() if isinstance(argument, np.generic) else argument


def _is(a: Array, b: Array) -> bool:
    """Whether two arrays are the same memory."""
    return a.shape == b.shape and a.dtype == b.dtype and a.ctypes.data == b.ctypes.data


def _arrays(argument: Any) -> Iterator[Array]:
    """All arrays of an argument, each once."""
    found = list[Array]()
    for x in argument if isinstance(argument, tuple) else ():
        for a in [x] if isinstance(x, np.ndarray) else _arrays(x):
            if not any(_is(a, other) for other in found):
                found.append(a)
    yield from found


def _made(steps: tuple[Step, ...], again: tuple[Step, ...]) -> list[Array]:
    """Arrays that a solver makes for each of its programs: those of another are elsewhere."""
    others = list(_arrays(again))
    return [a for a in _arrays(steps) if not any(_is(a, b) for b in others)]


def _records(steps: tuple[Step, ...]) -> list[Named]:
    """Records that kernels keep something in; of a kind the second has a number, too."""
    kinds, found = list[str](), list[Named]()
    for a in _arrays(steps):
        if a.dtype.names:
            kinds.append(RECORDS[a.dtype])
            number = kinds.count(kinds[-1])
            found.append(Named(f"work.{kinds[-1]}{number if number > 1 else ''}", a))
    return found


def names_of(kernel: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """Names of a kernel's arguments, a tuple where the argument is one."""
    hints = get_type_hints(kernel, include_extras=True)
    parameters = kernel.__code__.co_varnames[: kernel.__code__.co_argcount]
    return tuple(_names(p, hints.get(p), a) for p, a in zip(parameters, arguments, strict=True))


def _names(name: str, hint: Any, argument: Any) -> Any:
    if not isinstance(argument, tuple):
        return name
    fields = get_type_hints(hint, include_extras=True) if hasattr(hint, "_fields") else {}
    inner = list(fields.items()) or [(f"{name}_{k}", None) for k in range(len(argument))]
    return tuple(_names(n, h, a) for (n, h), a in zip(inner, argument, strict=True))
