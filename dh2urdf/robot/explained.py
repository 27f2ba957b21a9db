"""Inverse kinematics as a worked solution: what a robot asks of :mod:`dh2urdf.lessons`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.doors import integer
from dh2urdf.robot.inverse import RobotIK

if TYPE_CHECKING:
    import pinocchio as pin

    from dh2urdf.dh import DHTable
    from dh2urdf.ik.arm import Task
    from dh2urdf.ik.problem import IKSolutions
    from dh2urdf.ik.solve import Locked
    from dh2urdf.lessons import IKExplanation, Question


class RobotExplained(RobotIK):
    """What :class:`dh2urdf.Robot` says of its inverse kinematics."""

    table: DHTable | None
    model: pin.Model

    def explain_ik(
        self,
        T: ArrayLike | IKSolutions,
        solution: int | None = None,
        *,
        seed: ArrayLike | None = None,
        within_limits: bool = True,
        locked: Locked | None = None,
        task: Task | str = "pose",
        nearest: bool = False,
    ) -> IKExplanation:
        """Inverse kinematics of a pose as a worked solution, as the lecture notes do it.

        Each step has its formula, the numbers put in, the value and the reason; ``str`` of the
        answer is text, it has ``markdown`` and ``latex``, and shows itself in a notebook. The
        derivation is one of its own, that shares nothing with the solver, whose values it meets.
        Where a pose is out of reach it ends at the step that has no solution.

        Parameters
        ----------
        T : array_like, shape (4, 4), pinocchio.SE3, or IKSolutions
            ``T_base_tip``, lengths in [m]; or what :meth:`ik` answered, whose order then counts.
        solution : int, optional
            Which solution of :meth:`ik` the steps lead to, from 0; the first one without it.
        seed, within_limits, locked, task, nearest
            As for :meth:`ik`. If all solutions are outside the limits, one of them is explained.

        Returns
        -------
        IKExplanation

        Raises
        ------
        PoseError, ConfigurationError, ArgumentError, NameNotFoundError, NoSolverError
        """
        from dh2urdf.ik.problem import IKSolutions
        from dh2urdf.lessons import explain_pose

        if isinstance(T, IKSolutions):
            found = T
        else:
            ask = partial(self.ik, T, seed=seed, locked=locked, task=task, nearest=nearest)
            found = ask(within_limits=within_limits)
            if not found and within_limits:
                found = ask(within_limits=False)
        return explain_pose(question_of(self, found, solution, locked, task))


def question_of(
    robot: RobotExplained,
    found: IKSolutions,
    solution: int | None = None,
    locked: Locked | None = None,
    task: Task | str = "pose",
) -> Question:
    """What :mod:`dh2urdf.lessons` is asked: solutions of a robot, which, joints held and task."""
    from dh2urdf.ik.arm import Task
    from dh2urdf.ik.redundant import RedundantChain, SweptJoint
    from dh2urdf.lessons import Question, Values

    index = 0 if solution is None else integer(solution, "solution", 0, max(len(found) - 1, 0))
    solver, coupling = robot.solver_for(locked=locked, task=task), robot._coupling
    moved = found.q if coupling is None else robot.chain_configuration(found.q)
    held = _held(robot, locked)
    rows = np.arange(len(found))
    if found and isinstance(solver, (SweptJoint, RedundantChain)):
        spare = solver.held if isinstance(solver, RedundantChain) else (solver.joint,)
        if coupling is not None and coupling.inverse is None:  # the solver counts the values
            names = [coupling.names[v] for v in spare]
            spare = tuple(k for k, name in enumerate(robot.chain.names) if name in names)
        held |= {i: float(moved[index, i]) for i in spare}
        rows = np.flatnonzero((moved[:, spare] == moved[index, spare]).all(axis=1))
    return Question(
        name=robot.table.name if robot.table else robot.model.name,
        chain=robot.chain,
        table=robot.table,
        solver=str(solver),
        T=np.array(found.T),
        q=moved[rows],
        branches=tuple(found.branch[i] for i in rows),
        numbers=tuple(rows.tolist()),
        index=int(np.searchsorted(rows, index)),
        task=Task(task),
        details=solver.explain(),
        held=held,
        values=None if coupling is None else Values(coupling, found.q[rows]),
    )


def _held(robot: RobotExplained, locked: Locked | None) -> dict[int, float]:
    """Where joints of the chain stand that are held, by their place from 0."""
    from dh2urdf.ik.problem import held_values

    coupling = robot._coupling
    if coupling is None or not locked:
        places, values = held_values(robot.chain, locked, False)
        return dict(zip(places, values[0].tolist(), strict=True))
    q, moving = np.zeros(robot.n), np.ones(robot.n, bool)
    for name, value in locked.items():
        place = robot.joint_names.index(name) if isinstance(name, str) else name
        q[place], moving[place] = value, False
    still = ~coupling.matrix[:, moving].any(axis=1)
    joints = robot.chain_configuration(q)
    return {int(i): float(joints[i]) for i in np.flatnonzero(still)}
