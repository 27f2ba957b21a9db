"""The inverse kinematics of a robot for many poses: batches and paths."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from dh2urdf.ik.arm import Task
    from dh2urdf.ik.problem import IKBatch, IKPath, Progress
    from dh2urdf.ik.solve import InverseKinematics, Locked

__all__ = ["RobotPoses"]


class RobotPoses:
    """What :class:`dh2urdf.Robot` does with many poses."""

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
    ) -> IKBatch:
        """All configurations for many poses, in a few arrays.

        Parameters
        ----------
        Ts : array_like, shape (m, 4, 4) or (..., 4, 4)
            ``T_base_tip``, lengths in [m]; one pose is a row of one.
        within_limits, locked, task, samples, nearest
            As for :meth:`Robot.ik`; a joint may be held at a value for each pose, shape (m,).
        threads : int, optional
            Threads to use; by default one per processor.
        progress : callable, optional
            Called with the number of poses done and their total.
        on_bad : {"raise", "skip"}
            Poses that are none (NaN, no rotation): refuse them all, or leave them without
            solutions; ``batch.bad`` lists them.

        Returns
        -------
        IKBatch
            NaN-padded; ``batch[i]`` are the solutions of pose i. Its arrays have the leading axes
            of Ts.

        Raises
        ------
        PoseError, ConfigurationError, ArgumentError, NameNotFoundError, NoSolverError
        """
        return self._ik.solve_batch(
            Ts,
            within_limits=within_limits,
            locked=locked,
            task=task,
            samples=samples,
            threads=threads,
            progress=progress,
            nearest=nearest,
            on_bad=on_bad,
        )

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
            As for :meth:`Robot.ik`.
        max_jump : float, optional
            Motion of a joint between neighbouring poses that counts as a break [rad or m];
            0.5 without it.
        """
        return self._ik.solve_path(
            Ts,
            start=start,
            within_limits=within_limits,
            locked=locked,
            task=task,
            max_jump=max_jump,
            nearest=nearest,
        )

    @cached_property
    def _ik(self) -> InverseKinematics:
        raise NotImplementedError
