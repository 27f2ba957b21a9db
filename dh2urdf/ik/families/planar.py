"""The inverse kinematics of the lecture notes, section 8, as functions to call and to read.

:func:`planar_rr_ik` and :func:`planar_rrr_ik` are 8.2, :func:`wrist_centre` is equation (5) of 8.3;
the ZYZ angles of its last step are :func:`dh2urdf.transforms.matrix_to_zyz`. ``Robot.ik`` runs the
same kernels on arms with two or three parallel axes (:class:`PlanarArm`).
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import LENGTH
from dh2urdf.chain import SerialChain
from dh2urdf.doors import number
from dh2urdf.exceptions import PoseError
from dh2urdf.ik.arm import NOMINAL, SNAP, Others, SolverBase, Task, hold, spare_joints
from dh2urdf.ik.families.short_position import axis_frames
from dh2urdf.kernels.short_chains import planar_rr, solve_planar
from dh2urdf.transforms import Array, check_pose, inverse, product

RIM = 1e-12
"""Relative excess over the rim of the annulus that is rounding of the point or the lengths."""


def planar_reach(l1: float, l2: float) -> tuple[float, float]:
    """Inner and outer radius [m] of the annulus that the planar RR arm reaches.

    ``(l1 - l2)^2 <= x^2 + y^2 <= (l1 + l2)^2`` is the workspace.

    Examples
    --------
    >>> planar_reach(1.0, 0.75)
    (0.25, 1.75)
    """
    l1, l2 = _numbers(l1=l1, l2=l2)
    return abs(l1 - l2), l1 + l2


def planar_rr_ik(l1: float, l2: float, x: float, y: float) -> Array:
    """Joint angles of the planar RR arm that reach a point.

    Parameters
    ----------
    l1, l2 : float
        Link lengths [m].
    x, y : float
        The point [m].

    Returns
    -------
    array, shape (k, 2)
        Rows (theta_1, theta_2) [rad]: elbow up (theta_2 < 0), elbow down. One row on the rim of
        the annulus, none outside it. At ``x = y = 0`` with ``l1 = l2`` theta_1 is free; the one
        row has theta_1 = 0.

    Examples
    --------
    >>> planar_rr_ik(1.0, 1.0, 1.0, 1.0).round(4) + 0.0
    array([[ 1.5708, -1.5708],
           [ 0.    ,  1.5708]])
    """
    out = np.empty((2, 2))
    first, second, u, v = _numbers(l1=l1, l2=l2, x=x, y=y)
    count, _ = planar_rr(first, second, u, v, RIM, 0.0, out)
    return _principal(out[:count])


def planar_rrr_ik(l1: float, l2: float, l3: float, x: float, y: float, phi: float) -> Array:
    """Joint angles of the planar RRR arm that reach a point in a direction.

    The wrist stands at ``(x - l3 cos phi, y - l3 sin phi)``; the first two joints take it there,
    and ``theta_3 = phi - theta_1 - theta_2``.

    Parameters
    ----------
    l1, l2, l3 : float
        Link lengths [m].
    x, y : float
        The point [m].
    phi : float
        Direction of the last link [rad].

    Returns
    -------
    array, shape (k, 3)
        As for :func:`planar_rr_ik`.

    Examples
    --------
    >>> planar_rrr_ik(1.0, 1.0, 0.5, 1.5, 1.0, 0.0).round(4) + 0.0
    array([[ 1.5708, -1.5708,  0.    ],
           [ 0.    ,  1.5708, -1.5708]])
    """
    l1, l2, l3, x, y, phi = _numbers(l1=l1, l2=l2, l3=l3, x=x, y=y, phi=phi)
    upper = planar_rr_ik(l1, l2, x - l3 * math.cos(phi), y - l3 * math.sin(phi))
    return _principal(np.column_stack([upper, phi - upper.sum(axis=1)]))


def wrist_centre(T: ArrayLike, d6: float) -> Array:
    """Wrist centre of a pose, ``o_c = o - d6 R e_3``, shape (3,) or (..., 3) [m].

    Parameters
    ----------
    T : array_like, shape (4, 4) or (..., 4, 4)
        Pose of frame 6; with a tool on it, take the tool off first.
    d6 : float
        Distance of frame 6 from the wrist centre along its z [m].

    Examples
    --------
    >>> from dh2urdf.transforms import trans
    >>> wrist_centre(trans(0.4, 0.0, 0.3), d6=0.08)
    array([0.4 , 0.  , 0.22])
    """
    pose, d6 = check_pose(T), number(d6, "d6", -LENGTH, LENGTH)
    centre: Array = pose[..., :3, 3] - d6 * pose[..., :3, 2]
    return centre


class PlanarArm(SolverBase):
    """Two or three turning joints with parallel axes, lecture notes 8.2, and a slide along them."""

    name = "planar arm"
    needs = "two or three revolute joints with parallel axes, and a slide along them or none"
    kmax = 2
    kernel = staticmethod(solve_planar)
    branch_words = (None, ("elbow up", "elbow down"))

    def __init__(self, chain: SerialChain, task: Task = Task.POSE, others: Others = ()) -> None:
        super().__init__(chain, task, others)
        turning, sliding = np.flatnonzero(~chain.prismatic), np.flatnonzero(chain.prismatic)
        flat = hold(chain, dict.fromkeys(sliding.tolist(), 0.0))
        frames = axis_frames(flat)
        T_first_base = inverse(frames[0])
        last = chain.tool if flat.n == 2 else frames[2]
        point = product(inverse(chain.tool), last)[:3, 3]
        link1 = product(T_first_base, frames[1])[0, 3]
        *link2, height = product(T_first_base, last)[:3, 3] - (link1, 0.0, 0.0)
        places = np.array([*turning, -1, -1][:3] + [*sliding, -1][:1])
        signs = np.sign(chain.axes[places] @ flat.axes[0])
        plane = np.stack([T_first_base, product(inverse(chain.tool), frames[0])])
        polar = math.hypot(*link2), math.atan2(link2[1], link2[0])
        rest = float(np.clip(0.0, flat.lower[0], flat.upper[0]))
        self.form = np.array([link1, *polar, *signs[1:3], *point, rest, signs[3], height])
        self.constants = chain.tables, places, plane, self.form, task is Task.POSE

    @classmethod
    def obstacle(
        cls, chain: SerialChain, task: Task = Task.POSE, tolerance: float = NOMINAL
    ) -> str | None:
        """Say what keeps the notes' planar arm from covering a chain; None if nothing does."""
        turning = np.flatnonzero(~chain.prismatic)
        joints = len(turning)
        if joints not in (2, 3) or chain.n > joints + 1:
            return "it needs two or three revolute joints, and one slide at most"
        if np.abs(np.cross(chain.axes[0], chain.axes)).max() > tolerance:
            return "the axes are not parallel"
        if task is Task.POSITION_AXIS or (task is Task.POSITION and joints == 3):
            return f"it does not solve for {task.value} with {joints} joints that turn"
        if spare_joints(chain, task):
            return cls.if_spare
        last = turning[-1]
        reach = np.linalg.norm(np.cross(chain.tool[:3, 3] - chain.points[last], chain.axes[last]))
        if joints == 2 and reach <= SNAP * chain.size:
            return "the tool is on axis 2: its place says nothing of joint 2"
        return None

    def details(self) -> str:
        """Name the lengths and the reach."""
        l1, l2 = self.form[:2] * self.chain.unit
        inner, outer = planar_reach(l1, l2)
        turning = int((~self.chain.prismatic).sum())
        what = "the tool" if turning == 2 else "the last of them"
        slide = ", a slide along them" if turning < self.chain.n else ""
        return (
            f"parallel axes (lecture notes 8.2), l1 = {l1:.4g} m, l2 = {l2:.4g} m; "
            f"{what} reaches an annulus from {inner:.4g} to {outer:.4g} m{slide}"
        )


def _numbers(**given: float) -> list[float]:
    """Finite lengths and angles; link lengths are not negative."""
    return [
        number(value, key, 0.0, LENGTH)
        if key.startswith("l")
        else number(value, key, -LENGTH, LENGTH, PoseError)
        for key, value in given.items()
    ]


def _principal(q: Array) -> Array:
    """Angles in [-pi, pi]."""
    return np.where(np.abs(q) <= math.pi, q, q - 2.0 * math.pi * np.round(q / (2.0 * math.pi)))
