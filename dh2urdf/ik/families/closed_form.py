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


class ClosedForm(SolverBase):
    """A closed form, in Denavit-Hartenberg frames found from the axes.

    ``tolerance`` is what is snapped: with a larger one an arm that is nearly of the family gets
    the nominal arm's solutions as seeds, and Newton's method on the exact chain the answers.
    """

    kmax = 8

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
        self.constants = self.links, self.joints, self.form.rows, self.form.ends, slack


def not_six_revolute(chain: SerialChain, task: Task) -> str | None:
    """Say why the full pose of six revolute joints is not the question; None if it is."""
    if task is not Task.POSE:
        return f"it solves for the full pose, not for {task.value}"
    if chain.n != 6 or chain.prismatic.any():
        return "it needs 6 revolute joints"
    return None
