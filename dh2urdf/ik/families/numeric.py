"""Numeric inverse kinematics: for chains that no solver covers, and for who asks for it.

It finds solutions one at a time, and cannot tell whether there are more, nor whether a pose
without one is out of reach.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.bounds import STARTS
from dh2urdf.chain import SerialChain
from dh2urdf.doors import choice, flag, generator, integer
from dh2urdf.exceptions import NoSolutionError
from dh2urdf.ik.arm import Task, as_configuration, in_own_unit, lengths_in, one_pose
from dh2urdf.kernels.certificate import find_solutions, measure_all
from dh2urdf.transforms import Array

USUAL_STARTS = 50
"""Starts after which the search is given up, when the caller gives no other number."""


@dataclass(frozen=True, eq=False)
class NumericSolutions:
    """Solutions that a numeric search has found; there may be more.

    Attributes
    ----------
    q : array, shape (k, n)
        Different configurations [rad] or [m]; nearest to the seed first, if there is one.
    residual : array, shape (k,)
        Larger of position error [m] and orientation error [rad] of each.
    T : array, shape (4, 4)
        The target.
    tried : int
        Starts that were used.
    slides : bool array, shape (n,)
        True where a value is a length.
    pose_change : float
        How far the given pose was from T [rad]; 0 unless ``nearest=True`` was asked for.
    """

    q: Array
    residual: Array
    T: Array
    tried: int
    slides: NDArray[np.bool_]
    pose_change: float = 0.0

    def nearest(self, q: ArrayLike) -> Array:
        """The solution with the least joint motion from q, shape (n,).

        Raises
        ------
        NoSolutionError
            The list is empty.
        ConfigurationError
        """
        goal = as_configuration(q, self.slides, "q")
        if not len(self):
            raise NoSolutionError("nearest: there is no solution to choose from")
        near: Array = self.q[np.linalg.norm(self.q - goal, axis=1).argmin()]
        return near

    def __len__(self) -> int:
        return len(self.q)

    def __getitem__(self, index: int) -> Array:
        row: Array = self.q[index]
        return row

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)

    def __str__(self) -> str:
        lines = [f"{len(self)} found from {self.tried} starts; there may be more"]
        lines += [
            f"{i}: {' '.join(f'{v:9.5f}' for v in q)}  residual {residual:.1e}"
            for i, (q, residual) in enumerate(zip(self.q + 0.0, self.residual, strict=True))
        ]
        return "\n".join(lines)


@dataclass(frozen=True, eq=False)
class NumericProblem:
    """A chain with ``joints = coupling q + offset``; which values slide, and their bounds."""

    chain: SerialChain
    coupling: Array
    offset: Array
    slides: NDArray[np.bool_]
    lower: Array
    upper: Array

    def solve(
        self,
        T: ArrayLike,
        seed: ArrayLike | None = None,
        within_limits: bool = True,
        task: Task | str = Task.POSE,
        solutions: int = 1,
        starts: int = USUAL_STARTS,
        rng: np.random.Generator | int | None = 0,
        nearest: bool = False,
    ) -> NumericSolutions:
        """Search for solutions of one pose; :meth:`dh2urdf.Robot.ik_numeric` says what is what."""
        wanted = Task(choice(task, "task", tuple(Task)))
        given, change = one_pose(T, wanted, nearest)
        starts = integer(starts, "starts", 1, STARTS)
        solutions = min(starts, integer(solutions, "solutions", 1, STARTS))
        target, inside = given, flag(within_limits, "within_limits")
        inner, scale = self._in_own_unit()
        pose = lengths_in(target, inner.chain.unit / self.chain.unit)
        first = None if seed is None else as_configuration(seed, self.slides, "seed") / scale
        bounds = np.column_stack([self.slides, inner.lower, inner.upper]).astype(float)
        if not inside:
            bounds[:, 1:] = -np.inf, np.inf
        begin = inner._starts(starts, first, bounds, generator(rng))
        q, tried = inner._search(pose, wanted, bounds, begin, solutions)
        if first is not None:
            q = q[np.argsort(np.linalg.norm(q - first, axis=1), kind="stable")]
        q, residual, one = q * scale, np.empty(len(q)), np.array([len(q)])
        joints = np.ascontiguousarray(q @ self.coupling.T + self.offset)
        poses, many = target[None], joints[None]
        measure_all(self.chain.tables, wanted.number, poses, many, one, residual[None])
        return NumericSolutions(q, residual, target, tried, self.slides, change)

    def _in_own_unit(self) -> "tuple[NumericProblem, Array]":
        """The problem with lengths in its chain's own unit, and that unit of each value, (n,)."""
        chain = in_own_unit(self.chain)
        unit = chain.unit / self.chain.unit
        scale, joints = (np.where(s, unit, 1.0) for s in (self.slides, chain.prismatic))
        coupling, offset = self.coupling * scale / joints[:, None], self.offset / joints
        bounds = self.lower / scale, self.upper / scale
        return NumericProblem(chain, coupling, offset, self.slides, *bounds), scale

    def _search(
        self, T: Array, task: Task, bounds: Array, starts: Array, most: int
    ) -> tuple[Array, int]:
        """Configurations (k, n) that reach a pose, and the number of starts (s, n) that it took."""
        coupling, offset = (
            np.ascontiguousarray(a, dtype=float) for a in (self.coupling, self.offset)
        )
        q = np.empty((most, len(self.lower)))
        arm, goal = (self.chain.tables, coupling, offset, bounds), (task.number, T, self.chain.size)
        count, tried = find_solutions(arm, goal, starts, q, np.empty(most))
        return q[:count], tried

    def _starts(
        self, starts: int, seed: Array | None, bounds: Array, rng: np.random.Generator
    ) -> Array:
        """The seed or the middle of the limits, then anywhere inside them, shape (starts, n)."""
        far = np.where(self.slides, self.chain.size, np.pi)
        low = np.where(np.isfinite(self.lower), self.lower, np.minimum(-far, self.upper - far))
        high = np.where(np.isfinite(self.upper), self.upper, np.maximum(far, low + far))
        out = rng.uniform(low, high, (starts, len(low)))
        out[0] = 0.5 * (low + high) if seed is None else seed
        inside: Array = np.clip(out, bounds[:, 1], bounds[:, 2])
        return inside
