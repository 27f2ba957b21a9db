"""Six joints whose axes give frames in which the equations come apart: closed forms."""

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import (
    NOMINAL,
    SLACK,
    SLACK_OF_NOISE,
    AxisLines,
    DHForm,
    Others,
    SolverBase,
    Task,
)

STUCK = "the arm cannot move its tool in all six directions"


class ClosedForm(SolverBase):
    """A closed form, in Denavit-Hartenberg frames found from the axes.

    ``tolerance`` is what is snapped: with a larger one an arm that is nearly of the family gets
    the nominal arm's solutions as seeds, and Newton's method on the exact chain the answers.
    """

    kmax = 8
    if_spare = STUCK

    def __init__(
        self,
        chain: SerialChain,
        task: Task = Task.POSE,
        others: Others = (),
        tolerance: float = NOMINAL,
    ) -> None:
        super().__init__(chain, task, others)
        self.lines = AxisLines(chain, tolerance)
        self.form = DHForm(self.lines)
        slack = max(SLACK, SLACK_OF_NOISE * tolerance)
        self.constants = chain.tables, self.form.rows, self.form.ends, slack


def not_six_revolute(chain: SerialChain) -> str | None:
    """Say that a chain is not one of six revolute joints; None if it is."""
    six = chain.n == 6 and not chain.prismatic.any()
    return None if six else "it needs 6 revolute joints"
