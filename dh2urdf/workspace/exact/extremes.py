"""The largest and the smallest reach, by Newton steps from starts on all faces of the limits.

At an extreme distance the line from the shoulder to the point meets every axis that is free to turn
(Kumar and Waldron, "The workspaces of a mechanical manipulator", J. Mech. Des. 103, 1981): its
derivatives with respect to those joints are zero, and joints at a limit push against it.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dh2urdf.doors import flag
from dh2urdf.exceptions import ArgumentError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.workspace.exact.carried_point import CarriedPoint, carried_point

EACH, FACES = 20, 3**7
"""Configurations looked at on each face of the limits, the best of which is followed, and the most
faces, drawn at random where there are more."""

ROUGH, KEPT = 12, 48
"""Steps from all starts, and the best of them from which steps go on to the end."""

STEPS = 200
"""Newton steps at most; a handful will do but where a joint hardly counts."""

SCALES = (1.0, 0.25, 0.0625, 0.0078125)
"""Parts of a step that are tried."""

FLAT = 1e-9
"""Curvature, relative to the largest, below which a joint does not count."""

PARALLEL = 1e-9
"""Sine of the angle between directions up to which they count as parallel."""

Values = Callable[[Array], Array]
Slopes = Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class ExtremeReach:
    """Extremes of a point's place.

    Parameters
    ----------
    point : str
        ``tip`` or ``wrist point``.
    centre : array, shape (3,)
        The shoulder in base [m]: the point of axis 1 nearest to axis 2.
    axis : array, shape (3,)
        Direction of axis 1 in base.
    distance : tuple of 2 floats
        Smallest and largest distance from the shoulder [m].
    radius : tuple of 2 floats
        Smallest and largest distance from axis 1 [m].
    height : tuple of 2 floats
        Lowest and highest place along axis 1, from the shoulder [m].
    q : dict of str to array, shape (2, n)
        Configurations [rad] or [m] in which ``distance``, ``radius`` and ``height`` are so; of the
        wrist point n is 3.
    places : dict of str to array, shape (2, 3)
        Where the point is then, in base [m].
    """

    point: str
    centre: Array
    axis: Array
    distance: tuple[float, float]
    radius: tuple[float, float]
    height: tuple[float, float]
    q: dict[str, Array]
    places: dict[str, Array]

    @property
    def above(self) -> tuple[float, float] | None:
        """``height`` along z of the base [m], None where axis 1 is not parallel to that."""
        if np.hypot(self.axis[0], self.axis[1]) > PARALLEL:
            return None
        low, high = self.height
        return (low, high) if self.axis[2] > 0.0 else (-high, -low)


def extreme_reach(robot: Robot, point: str = "tip", *, within_limits: bool = True) -> ExtremeReach:
    """How far and how near an arm reaches.

    Parameters
    ----------
    robot : Robot
    point : {"tip", "wrist"}
        The wrist point is that of axis 4 nearest to axis 5, where the axes of a spherical wrist
        meet.
    within_limits : bool
        Keep the limits of joints that turn; those that slide always keep theirs.

    Returns
    -------
    ExtremeReach
        Each extreme is attained in its configuration, and the end of a descent to 1e-9 of the arm's
        size: the best of those from all starts, the same each time. It is not proven that none is
        farther or nearer: starts are on all faces of the limits of up to seven joints.

    Raises
    ------
    ArgumentError
        A slide without limits, no wrist point, limits of values and of joints that they move.

    Examples
    --------
    >>> from dh2urdf import Robot
    >>> from dh2urdf.workspace import extreme_reach
    >>> found = extreme_reach(Robot.from_dh("planar_rr"), within_limits=False)
    >>> [round(d, 9) for d in found.distance]
    [0.3, 1.7]
    """
    carried = carried_point(robot, point)
    low, high = bounds_of(carried, flag(within_limits, "within_limits"))
    ends, q = {}, {}
    for name, weights in (("distance", (1, 1, 1)), ("radius", (1, 1, 0)), ("height", None)):
        found = [_extreme(carried, weights, sign, low, high) for sign in (1.0, -1.0)]
        ends[name] = (found[0][0], found[1][0])
        q[name] = np.stack([configuration for _, configuration in found])
    T = carried.T_base_axis
    places = {name: carried.places(each) @ T[:3, :3].T + T[:3, 3] for name, each in q.items()}
    q = {name: carried.box.values(each) for name, each in q.items()}
    return ExtremeReach(carried.name, T[:3, 3].copy(), T[:3, 2].copy(), **ends, q=q, places=places)


def bounds_of(carried: CarriedPoint, within_limits: bool) -> tuple[Array, Array]:
    """Bounds of each joint (n,), infinite where it turns without limits.

    Raises
    ------
    ArgumentError
        A slide without limits.
    """
    box, chain = carried.box, carried.chain
    free = ~box.slides & (not within_limits)
    lower, upper = np.where(free, -np.inf, box.lower), np.where(free, np.inf, box.upper)
    low, high = (lower, upper) if box.moves is None else box.moves.ranges(lower, upper)
    endless = chain.prismatic & ~np.isfinite(high - low)
    if endless.any():
        name = chain.names[int(np.argmax(endless))]
        raise ArgumentError(f"{name} slides without limits: the reach has no bound")
    return lower, upper


def _extreme(
    carried: CarriedPoint, weights: tuple[int, ...] | None, sign: float, low: Array, high: Array
) -> tuple[float, Array]:
    """Smallest (sign 1) or largest (-1) value, and where.

    ``weights`` of squares of the coordinates whose root is meant; None for the height.
    """
    W = np.zeros(3) if weights is None else np.array(weights, float)
    up = np.array([0.0, 0.0, 1.0]) if weights is None else np.zeros(3)

    def values(q: Array) -> Array:
        p = carried.places(q)
        return np.asarray(sign * (0.5 * (p * p) @ W + p @ up))

    def slopes(q: Array) -> tuple[Array, Array]:
        """Gradient (k, n) and Hessian (k, n, n)."""
        J, axes = carried.jacobians(q)
        force = carried.places(q) * W + up
        gradient = np.einsum("kx,kxi->ki", force, J)
        # d2p / dq_i dq_j = z_i x dp/dq_j for i <= j
        twist = np.cross(axes[..., :, None], J[..., None, :], axis=1)
        second = np.einsum("kx,kxij->kij", force, twist)
        upper = np.triu(second)
        curve = upper + np.triu(second, 1).swapaxes(1, 2)
        hessian = np.einsum("kxi,x,kxj->kij", J, W, J) + curve
        return carried.box.by_values(sign * gradient, sign * hessian)

    q, value = _descended(_starts(values, low, high), values, slopes, low, high, ROUGH)
    q = q[np.argsort(value, kind="stable")[:KEPT]]
    q, value = _descended(q, values, slopes, low, high, STEPS)
    best = int(np.argmin(value))
    at = carried.places(q[best : best + 1])[0]
    end = float(at[2]) if weights is None else float(np.sqrt((at * at) @ W))
    return end, q[best]


def _starts(values: Values, low: Array, high: Array) -> Array:
    """The best of some configurations on each face of the limits, the corners among them, (k, n).

    A face has each joint at its lower limit, between the limits or at its upper one.
    """
    rng, n = np.random.default_rng(0), len(low)
    a, b = np.where(np.isfinite(low), low, -np.pi), np.where(np.isfinite(high), high, np.pi)
    numbers = np.arange(3**n) if 3**n <= FACES else rng.choice(3**n, FACES, replace=False)
    held = numbers[:, None] // 3 ** np.arange(n) % 3 / 2.0
    shares = rng.random((len(held), EACH, n))
    on_face = np.repeat(held[:, None], EACH, axis=1)
    q = a + np.where(on_face == 0.5, shares, on_face) * (b - a)
    best = values(q.reshape(-1, n)).reshape(len(held), EACH).argmin(axis=1)
    return np.asarray(q[np.arange(len(held)), best])


def _descended(
    q: Array, values: Values, slopes: Slopes, low: Array, high: Array, steps: int
) -> tuple[Array, Array]:
    """Steps downhill within bounds from configurations (k, n), and the values there.

    Newton steps with the Hessian's eigenvalues by size, so that they lead downhill at a saddle too,
    projected onto the bounds; steps along the gradient where none of those does, as may be where a
    joint at its limit is pushed out by the others.
    """
    value = values(q)
    going = np.arange(len(q))
    for _ in range(steps):
        start = q[going]
        for step in _steps(start, slopes, low, high):
            for scale in SCALES:
                rows = np.flatnonzero((q[going] == start).all(axis=1))
                trial = np.clip(start[rows] + scale * step[rows], low, high)
                lower = values(trial)
                better = lower < value[going[rows]]
                q[going[rows[better]]], value[going[rows[better]]] = trial[better], lower[better]
        going = going[(q[going] != start).any(axis=1)]
        if not len(going):
            break
    return q, value


def _steps(q: Array, slopes: Slopes, low: Array, high: Array) -> tuple[Array, Array]:
    """The Newton step and that along the gradient from configurations (k, n), at most 1 long."""
    gradient, hessian = slopes(q)
    held = ((q <= low) & (gradient > 0.0)) | ((q >= high) & (gradient < 0.0))
    gradient = np.where(held, 0.0, gradient)
    free = ~held[:, :, None] & ~held[:, None, :]
    size, ways = np.linalg.eigh(np.where(free, hessian, 0.0))
    size = np.abs(size)
    most = np.maximum(size.max(axis=1, keepdims=True), 1e-200)
    along = np.einsum("kij,ki->kj", ways, gradient) / np.maximum(size, FLAT * most)
    steps = -np.einsum("kij,kj->ki", ways, along), -gradient / most
    long = [np.maximum(np.abs(step).max(axis=1, keepdims=True), 1.0) for step in steps]
    return steps[0] / long[0], steps[1] / long[1]
