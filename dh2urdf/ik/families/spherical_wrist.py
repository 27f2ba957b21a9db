"""Six joints, the last three with axes through one point: lecture notes 8.3, any first three."""

from functools import cached_property

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.ik.arm import REGULAR, BatchKernel, DHForm, form_of, lines_of, plain_ranges
from dh2urdf.ik.families.closed_form import ClosedForm
from dh2urdf.kernels.chain import chain_jacobian_batch
from dh2urdf.kernels.in_doubt import widen_wrists
from dh2urdf.kernels.spherical_wrist import solve_common_wrist, solve_wrist_arm


class SphericalWrist(ClosedForm):
    """Closed form by kinematic decoupling."""

    name = "spherical wrist"
    needs = "six joints, the last three revolute with axes through one point"

    widen = staticmethod(widen_wrists)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps decoupling from covering the chain; None if nothing does."""
        if chain.n != 6:
            return f"it needs 6 joints, the chain has {chain.n}"
        lines = lines_of(chain, tolerance)
        if not lines.spherical(3):
            return "axes 4, 5 and 6 do not meet in one point"
        if not _places_wrist(form_of(chain, tolerance)):
            return "joints 1, 2 and 3 cannot move the wrist centre in all directions"
        return None

    @property
    def doubts(self) -> bool:  # type: ignore[override]
        """Not where all joints turn and the geometry is common."""
        return self.kernel is solve_wrist_arm or bool(self.chain.prismatic[2])

    def details(self) -> str:
        """Name the subproblems of the position arm and of the wrist."""
        rows = self.form.rows
        orthogonal = rows[3, 1] == rows[4, 1] == 0.0
        wrist = "ZYZ angles" if orthogonal else "subproblem 4 for joint 5, 1 for joints 4 and 6"
        return (
            f"axes 4, 5, 6 meet ({self.lines.describe()}); the wrist centre fixes joints 1, 2, 3 "
            f"({self._position_arm()}), the orientation the wrist ({wrist})"
        )

    def _position_arm(self) -> str:
        """The equations that the first three joints are found from."""
        kinds = "".join("P" if slides else "R" for slides in self.chain.prismatic[:3])
        if kinds == "PPP":
            return "three slides: linear equations"
        if kinds.count("P") == 2:
            return f"{kinds}: subproblem 4 for the joint that turns, then linear equations"
        if kinds != "RRR":
            return f"{kinds}: the slide eliminated, one equation in an angle, then subproblem 1"
        if self.lines.parallel(1):
            return "2 || 3: subproblem 4 for joint 1, 3 for the elbow, 1 for joint 2"
        if self.lines.parallel(0):
            return "1 || 2: subproblem 4 for joint 3, 3 for joint 1, 1 for joint 2"
        if self.lines.meet(0):
            return "1 meets 2: subproblem 3 for joint 3, 4 for joint 1, 1 for joint 2"
        return "skew: subproblem 5, Pieper's quartic"

    @cached_property
    def kernel(self) -> BatchKernel:  # type: ignore[override]
        """The fastest kernel that covers the geometry."""
        rows = self.form.rows
        slides = self.chain.prismatic
        right = rows[1, 1 if slides[2] else 2] == rows[3, 1] == rows[4, 1] == 0.0
        common = right and not slides[:2].any()
        fast = common and self.form.exact and plain_ranges(self.chain)
        return solve_common_wrist if fast else solve_wrist_arm


def _places_wrist(form: DHForm) -> bool:
    """Whether the first three joints move the wrist centre in three directions somewhere."""
    links, slides = form.links[:4].copy(), np.ascontiguousarray(form.lines.chain.prismatic[:3])
    links[3, :3, 3] += form.rows[3, 3] * links[3, :3, 2]
    q, J = np.random.default_rng(0).uniform(-3.0, 3.0, (4, 3)), np.empty((4, 6, 3))
    chain_jacobian_batch(links, slides, q, J)
    J /= np.where(slides, 1.0, form.lines.chain.size)
    return bool((np.abs(np.linalg.det(J[:, :3])) > REGULAR).any())
