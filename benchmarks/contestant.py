"""What a solver must do to take part: build, take a pose, answer with configurations."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm

__all__ = ["BatchContestant", "FKContestant", "IKContestant", "NotCoveredError"]

Array = NDArray[np.float64]


class NotCoveredError(Exception):
    """The solver has no way to take this arm; the message says why."""


class IKContestant(ABC):
    """One inverse-kinematics solver, built for one arm.

    ``encode`` and ``configurations`` translate between the arm's frames and joints and the
    solver's and are never timed. ``solve`` is the bare documented call; ``array`` what its user
    does to hold the solutions as an array.
    """

    name: ClassVar[str]
    distribution: ClassVar[str]
    keeps_limits: ClassVar[bool] = False
    """It leaves out what is beyond the joint limits and cannot be told not to."""
    searches: ClassVar[bool] = False
    """It looks for one solution a call: its share of all solutions is no fault of it."""
    seconds_to_build: float | None = None
    """What its building took, where that is done once a process."""

    @abstractmethod
    def __init__(self, arm: Arm) -> None:
        """Build, ready to solve; raises :class:`NotCoveredError`."""

    @abstractmethod
    def solve(self, pose: Any) -> Any:
        """The bare call for one pose."""

    @abstractmethod
    def array(self, answer: Any) -> Array:
        """The solutions of an answer, and only these, as an array (k, n) of the solver's joints."""

    def encode(self, Ts: Array) -> Sequence[Any]:
        """Poses (m, 4, 4) in the form that the solver takes, one by one."""
        return [np.ascontiguousarray(T) for T in Ts]

    def configurations(self, answer: Any) -> Array:
        """The solutions that the answer claims to be exact (k, n), in the arm's joints."""
        return self.array(answer)

    def public(self, pose: Any) -> Array:
        """The call with its conversion to an array."""
        return self.array(self.solve(pose))


class BatchContestant(IKContestant):
    """A solver that also takes many poses at once."""

    threads: ClassVar[tuple[int, ...]] = (1, 2)
    """Numbers of threads that it can be told."""

    def encode_batch(self, Ts: Array) -> Any:
        """Poses (m, 4, 4) in the form that the batch call takes."""
        return Ts

    @abstractmethod
    def solve_batch(self, poses: Any, threads: int) -> Any:
        """The batch call."""

    @abstractmethod
    def batch_configurations(self, answer: Any) -> Sequence[Array]:
        """The claimed solutions of each pose, in the arm's joints."""


@dataclass(frozen=True)
class FKContestant:
    """Forward kinematics of one arm: one configuration, many, or both.

    ``many`` takes (m, n) and returns poses; ``to_poses`` makes comparable poses (m, 4, 4) of what
    it returned, untimed.
    """

    name: str
    one: Callable[[Any], Any] | None = None
    many: Callable[[Any], Any] | None = None
    encode: Callable[[Array], Any] = lambda q: q
    to_poses: Callable[[Any], Array] = np.asarray
