"""Of what an arm's limits are a box: of its values q, or of its joints, where values move several.

A pendant's J3, which moves joint 3 together with J2, has limits that leave joint 3 in its own: the
joints are in a box, the values are not. Followers of one value are the other way round.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import Coupling, SerialChain
from dh2urdf.chain.coupling import ALIKE, within
from dh2urdf.exceptions import ArgumentError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array


class Box(NamedTuple):
    """Independent ranges, and what they are of.

    ``lower`` and ``upper`` (n,) are of the values of ``moves``, which move the joints, or of the
    joints, None; these are at ``shown``'s values then, None where each is a value.
    """

    lower: Array
    upper: Array
    slides: NDArray[np.bool_]
    moves: Coupling | None
    shown: Coupling | None

    def joints(self, q: Array) -> Array:
        """Joints (k, chain.n) at values (k, n) of what the box is of."""
        return q if self.moves is None else self.moves.joints(q)

    def by_values(self, gradient: Array, hessian: Array) -> tuple[Array, Array]:
        """Derivatives (k, n) and (k, n, n) by what the box is of, of those by the joints."""
        if self.moves is None:
            return gradient, hessian
        C = self.moves.matrix
        return gradient @ C, np.einsum("ji,kjl,lm->kim", C, hessian, C)

    def values(self, q: Array) -> Array:
        """Values q of the robot (k, n), as many as are asked for, of what the box is of."""
        if self.shown is None:
            return q
        inverse, n = self.shown.inverse, q.shape[1]
        assert inverse is not None
        out: Array = (q - self.shown.offset[:n]) @ inverse[:n, :n].T
        return out

    def of_first(self, n: int) -> "Box":
        """That of the first joints alone.

        Raises
        ------
        ArgumentError
            Values of later joints move them.
        """
        if self.shown is not None and self.shown.matrix[:n, n:].any():
            raise ArgumentError(f"values of later joints move joints 1 to {n}")
        ends = self.lower[:n], self.upper[:n]
        return Box(*ends, self.slides[:n], self.moves, self.shown)


def box_of(robot: Robot) -> Box:
    """The box of a robot's limits.

    Raises
    ------
    ArgumentError
        Some limits are of values and others of joints that several of these move.
    """
    chain, coupling = robot.chain, robot.coupling
    own = chain.lower, chain.upper, chain.prismatic
    if coupling is None:
        return Box(*own, None, None)
    if coupling.leaves_values(chain):
        return Box(*own, None, coupling)
    low, high = coupling.ranges(robot.lower, robot.upper)
    if within(low, high, chain.lower, chain.upper):
        return Box(robot.lower, robot.upper, robot.slides, coupling, None)
    raise ArgumentError(
        f"{robot.model.name}: {_bound_twice(robot.chain, low, high)} moves by several values and "
        "has limits of its own; exact reach takes limits of the values or of the joints, not of "
        "both; workspace without --exact draws what is sampled"
    )


def _bound_twice(chain: SerialChain, low: Array, high: Array) -> str:
    """The first joint whose own limits are narrower than those that the values leave it."""
    beyond = (low < chain.lower - ALIKE) | (high > chain.upper + ALIKE)
    return chain.names[int(beyond.argmax())]
