"""Three sliding joints with two or three turning ones: the orientation is solved first."""

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import Others, SolverBase, Task

SLIDES = 3


class ThreeSlides(SolverBase):
    """Turning joints from the orientation alone, then the slides from linear equations."""

    name = "three slides"
    needs = "three sliding joints and two or three turning ones"
    kmax = 2
    where = "dh2urdf.kernels.short_chains:solve_three_slides"

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        self.constants = self.links, self.joints, np.clip(0.0, chain.lower, chain.upper)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps orientation and position from being decoupled; None if nothing does."""
        if chain.n not in (5, 6) or chain.prismatic.sum() != SLIDES:
            return "it needs three sliding joints and two or three turning ones"
        return None

    def details(self) -> str:
        """Name the kinds of joints and what is solved."""
        kinds = "".join("P" if slides else "R" for slides in self.chain.prismatic)
        turning = [str(i + 1) for i in np.flatnonzero(~self.chain.prismatic)]
        return (
            f"{kinds}; joints {', '.join(turning)} from the orientation alone, "
            "the slides from three linear equations"
        )
