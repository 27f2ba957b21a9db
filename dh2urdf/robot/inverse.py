"""The inverse kinematics of a robot: kernels solve on the chain, Pinocchio is the referee."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.chain import CoupledChain, parted
from dh2urdf.robot.configurations import RobotConfigurations
from dh2urdf.robot.lazily import is_lazy, lazy_ik
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.ik.arm import HeldSolver, Solver, Task
    from dh2urdf.ik.families import NumericProblem, NumericSolutions
    from dh2urdf.ik.problem import IKBatch, IKPath, IKSolutions, Progress
    from dh2urdf.ik.solve import InverseKinematics, Locked


class RobotIK(RobotConfigurations):
    """What :class:`dh2urdf.Robot` knows of inverse kinematics."""

    @property
    def solver(self) -> Solver:
        """The solver of the full pose; prints as its name, ``explain()`` says why it was chosen."""
        return self._ik.solver

    def solver_for(
        self, *, task: Task | str = "pose", locked: Locked | None = None
    ) -> Solver | HeldSolver:
        """The solver of a task with joints held, see :meth:`ik`.

        Raises
        ------
        NoSolverError
        """
        return self._ik.problem(task, locked).solver

    def ik(
        self,
        T: ArrayLike,
        *,
        seed: ArrayLike | None = None,
        seed_tolerance: ArrayLike | None = None,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = "pose",
        turns: str = "nearest",
        samples: int | None = None,
        nearest: bool = False,
    ) -> IKSolutions:
        """All configurations that put the tip at a pose.

        Parameters
        ----------
        T : array_like, shape (4, 4), or pinocchio.SE3
            ``T_base_tip``, lengths in [m]; for task ``position`` a point (3,) will do.
        seed : array_like, shape (n,), optional
            Configuration to be near to: solutions are sorted by their distance from it, full
            turns and singular families are resolved towards it.
        seed_tolerance : float or array_like, shape (n,), optional
            Leave out solutions of which a joint is farther from the seed than this [rad] or [m];
            one number for all joints, or one for each. Angles are measured on the circle, so a
            full turn is no distance.
        within_limits : bool
            Leave out solutions outside the joint limits.
        locked : mapping of index or name to float, optional
            Joints held at a value [rad] or [m].
        task : {"pose", "position", "position+axis"}
            What of the pose has to be reached; axis is the tip's z.
        turns : {"nearest", "all"}
            For ranges wider than a turn: the turn nearest to the seed (to the middle of the range
            without one), or all of them as separate solutions. Without limits, the turn nearest to
            the seed of all; values that move joints together are turned inside first even then.
        samples : int, optional
            For an arm of seven joints: number of values, equally spaced in its range, of the
            joint that is swept (``solver`` names it); 16 without it. With a seed, the first
            solution is the nearest one between the samples too.

        Returns
        -------
        IKSolutions
            Empty where the pose is out of reach.

        Raises
        ------
        PoseError, ConfigurationError, ArgumentError, NameNotFoundError, NoSolverError

        Examples
        --------
        >>> from dh2urdf import Robot
        >>> robot = Robot.from_dh("denso_vs6556")
        >>> solutions = robot.ik(robot.fk([0.1, -1.2, 0.3, 0.4, 0.5, 0.6]))
        >>> bool((solutions.residual < 1e-9).all())
        True
        >>> solutions.nearest([0.1, -1.2, 0.3, 0.4, 0.5, 0.6]).round(6)
        array([ 0.1, -1.2,  0.3,  0.4,  0.5,  0.6])
        """
        asked = task, locked, within_limits, samples, nearest
        return self._ik.solve(T, seed, seed_tolerance, turns, asked)

    def ik_batch(
        self,
        Ts: ArrayLike,
        *,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = "pose",
        samples: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
        nearest: bool = False,
        on_bad: str = "raise",
        out: IKBatch | None = None,
    ) -> IKBatch:
        """All configurations for many poses, in a few arrays.

        Parameters
        ----------
        Ts : array_like, shape (m, 4, 4) or (..., 4, 4)
            ``T_base_tip``, lengths in [m]; one pose is a row of one. For an array of Dask the
            arrays of the answer are Dask's, too, in its chunks; ``dask.compute`` works them out.
        within_limits, locked, task, samples, nearest
            As for :meth:`ik`; a joint may be held at a value for each pose, shape (m,).
        threads : int, optional
            Threads to use; by default one per processor.
        progress : callable, optional
            Called with the number of poses done and their total.
        on_bad : {"raise", "skip"}
            Poses that are none (NaN, no rotation): refuse them all, or leave them without
            solutions; ``batch.bad`` lists them.
        out : IKBatch, optional
            An earlier answer to as many poses, whose arrays are filled again: new memory costs a
            third of a large batch's time. Where poses are skipped, it stays as it is.

        Returns
        -------
        IKBatch
            NaN-padded; ``batch[i]`` are the solutions of pose i. Its arrays have the leading axes
            of Ts.

        Raises
        ------
        PoseError, ConfigurationError, ArgumentError, NameNotFoundError, NoSolverError

        Examples
        --------
        >>> from dh2urdf import Robot
        >>> robot = Robot.from_dh("planar_rr")
        >>> batch = robot.ik_batch(robot.fk([[0.1, 0.2], [0.3, -0.4], [0.5, 0.6]]))
        >>> batch.count
        array([1, 1, 1])
        """
        if type(Ts) is not np.ndarray and is_lazy(Ts):
            options = {
                "within_limits": within_limits,
                "locked": locked,
                "task": task,
                "samples": samples,
                "nearest": nearest,
                "on_bad": on_bad,
            }
            whole = {"out": out, "progress": progress}
            return lazy_ik(self, Ts, {**options, "threads": threads}, whole)
        asked = task, locked, within_limits, samples, nearest
        return self._ik.solve_batch(Ts, asked, threads, progress, on_bad, out)

    def ik_path(
        self,
        Ts: ArrayLike,
        *,
        start: ArrayLike | None = None,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = "pose",
        max_jump: float | None = None,
        nearest: bool = False,
        progress: Progress | None = None,
    ) -> IKPath:
        """A joint path through a sequence of poses: fewest breaks, then least joint motion.

        Joint motion is the sum of ``sqrt(dq_1^2 + ... + dq_n^2)`` over the steps. With seven joints
        the posture at each pose is chosen so as to make it small.

        Parameters
        ----------
        Ts : array_like, shape (m, 4, 4)
        start : array_like, shape (n,), optional
            Configuration before the first pose.
        within_limits, locked, task, nearest
            As for :meth:`ik`.
        max_jump : float, optional
            Motion of a joint between neighbouring poses that counts as a break [rad or m];
            0.5 without it.
        progress : callable, optional
            Called with the number of poses done and their total.
        """
        asked = task, locked, within_limits, None, nearest
        return self._ik.solve_path(Ts, start, max_jump, asked, progress)

    def ik_intervals(
        self, T: ArrayLike, *, within_limits: bool = True, nearest: bool = False
    ) -> Array:
        """Intervals of the swept joint of a seven-joint arm in which a pose is reached.

        Parameters
        ----------
        T : array_like, shape (4, 4), or pinocchio.SE3
            ``T_base_tip``.
        within_limits : bool
            The whole range of the joint, with all joints inside their limits; without it one
            turn.
        nearest : bool
            As for :meth:`ik`.

        Returns
        -------
        array, shape (k, 2)
            Lower and upper ends [rad] or [m], ascending, known to 1e-9. Half a degree apart the
            reach is tried, and shorter intervals are found by following the arm's self-motions.

        Raises
        ------
        PoseError, ConfigurationError
            Also for an arm without a joint to spare.
        """
        return self._ik.intervals(T, within_limits, nearest)

    def ik_numeric(
        self,
        T: ArrayLike,
        *,
        seed: ArrayLike | None = None,
        within_limits: bool = True,
        task: Task | str = "pose",
        solutions: int = 1,
        starts: int = 50,
        rng: np.random.Generator | int | None = 0,
        nearest: bool = False,
    ) -> NumericSolutions:
        """Search for solutions by damped Newton steps, for arms that :meth:`ik` does not cover.

        Any number of joints of any kind, mimic joints too. The search is not complete: there may
        be more solutions than it finds, and a pose without one need not be out of reach.

        Parameters
        ----------
        T : array_like, shape (4, 4), or pinocchio.SE3
            ``T_base_tip``; for task ``position`` a point (3,) will do.
        seed : array_like, shape (n,), optional
            Where to start, and what to sort by; without it the middle of the limits. Later
            starts are random.
        within_limits : bool
            Stay inside the joint limits.
        task : {"pose", "position", "position+axis"}
        solutions : int
            Number of different solutions after which the search ends.
        starts : int
            Number of starts after which it ends anyway.
        rng : numpy.random.Generator, int or None
            Of the random starts; the same ones each time unless given.
        nearest : bool
            As for :meth:`ik`.

        Returns
        -------
        NumericSolutions
            With ``q`` (k, n), ``residual`` (k,) and ``tried``, the number of starts.

        Raises
        ------
        PoseError, ConfigurationError
        """
        return self._numeric.solve(T, seed, within_limits, task, solutions, starts, rng, nearest)

    def why_unreachable(
        self,
        T: ArrayLike,
        *,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = "pose",
        nearest: bool = False,
    ) -> str:
        """Say why a pose has no solution, and by how much; empty if it has one.

        ``the wrist centre lies 1.080 m outside the reach of joints 1 to 3``

        Parameters
        ----------
        T, within_limits, locked, task, nearest
            As for :meth:`ik`.

        Examples
        --------
        >>> from dh2urdf import Robot
        >>> print(Robot.from_dh("planar_rr").why_unreachable([2.0, 0, 0], task="position"))
        the point lies 0.300 m outside the reach of the tool
        """
        return self._ik.why_none(T, (task, locked, within_limits, None, nearest))

    @cached_property
    def _numeric(self) -> NumericProblem:
        from dh2urdf.ik.families import NumericProblem

        return NumericProblem(self.chain, *self._values(), self.lower, self.upper)

    @cached_property
    def _ik(self) -> InverseKinematics:
        from dh2urdf.ik.solve import InverseKinematics

        chain, coupling = self.chain, self._coupling
        if coupling is not None and coupling.n < chain.n:
            lead, coupling = parted(chain, coupling)
            chain = CoupledChain.of(chain, lead)
        return InverseKinematics(chain, coupling, self._placements)

    def _placements(self, q: Array) -> Array:
        """Poses of the tip in the base by Pinocchio, for configurations (k, n)."""
        raise NotImplementedError
