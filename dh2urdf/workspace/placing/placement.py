"""The best base found for a job, or which of its poses stand in the way of one."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.bounds import JOB_POSES, LENGTH
from dh2urdf.doors import choice, finite_array, flag, instance, number
from dh2urdf.exceptions import ArgumentError, NoSolverError
from dh2urdf.poses import check_pose
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose, rot_z, rpy_to_matrix
from dh2urdf.workspace.placing.job import Job
from dh2urdf.workspace.placing.lattice import BaseMap, Lattice, finer, lattice_of, map_of, worth
from dh2urdf.workspace.section import reach_ball

TASKS = ("pose", "position", "position+axis")

RANGES = ("region, x", "region, y", "height", "yaw")
"""What messages call the ranges of a base."""

LOOKED_AT = 100
"""Poses out of reach of which more is said: the first."""

Told = Callable[[str, int, int], None]
"""Called with what is done, how much of it, and the total."""


@dataclass(frozen=True, eq=False)
class Placement:
    """A base for a job.

    Parameters
    ----------
    x, y, z, yaw : float
        Where the base stands in the world [m], and its turn about the vertical [rad].
    T_world_base : array, shape (4, 4)
        The same with the mounting.
    margin : float
        The smallest of ``margins``; 0 where a pose is out of reach.
    margins : array, shape (m,)
        Of each pose, 0 to 1.
    q : array, shape (m, n)
        A configuration for each pose, that with the most margin [rad] or [m]; NaN out of reach.
    missed : tuple of int
        Poses out of reach from this base, which reaches the most of all bases tried.
    never : tuple of int
        Those of the first hundred of them that are reached from no base of a lattice about each.
    reasons : tuple of str
        Why each of the first hundred of ``missed`` is out of reach from this base.
    map : BaseMap
    tried : int
        Bases tried.
    """

    x: float
    y: float
    z: float
    yaw: float
    T_world_base: Array
    margin: float
    margins: Array
    q: Array
    missed: tuple[int, ...]
    never: tuple[int, ...]
    reasons: tuple[str, ...]
    map: BaseMap
    tried: int

    @property
    def found(self) -> bool:
        """Whether all poses are reached."""
        return not self.missed


def place(
    robot: Robot,
    Ts: ArrayLike,
    *,
    region: ArrayLike | None = None,
    height: float | tuple[float, float] = 0.0,
    yaw: float | tuple[float, float] | None = None,
    mount: ArrayLike | None = None,
    task: str = "pose",
    within_limits: bool = True,
    progress: Told | None = None,
) -> Placement:
    """Find the base from which an arm reaches all poses of a job with the most margin.

    The margin of a configuration is the smaller of two shares: how far its joints are from their
    limits, 1 in the middle of a range; and the smallest singular value of the Jacobian, with
    lengths in sizes of the arm, of the largest that the arm has. A pose has the margin of its best
    configuration, a base that of its worst pose.

    Bases are tried on a lattice, a twelfth of the reach and 15 degrees apart, then on ever finer
    ones about the best, or about those that miss the fewest poses; the same each time. That none
    is found is no proof that there is none between them; a smaller ``region`` lays them closer.

    Parameters
    ----------
    robot : Robot
    Ts : array_like, shape (m, 4, 4)
        ``T_world_tool`` of each pose, lengths in [m].
    region : array_like, shape (2, 2), optional
        Lower and upper ends of the base's x and y [m]; without it wherever a pose is in reach.
    height : float or two
        The base's z in the world [m], or the range that it may have.
    yaw : float or two, optional
        The base's turn about the vertical [rad], or its range; without it all around.
    mount : array_like, shape (3,), optional
        Roll, pitch and yaw [rad] of the base on what it stands on: ``(pi, 0, 0)`` hangs from above.
    task : {"pose", "position", "position+axis"}
        What of each pose has to be reached.
    within_limits : bool
        Keep the joint limits; without them they do not count for the margin.
    progress : callable, optional
        Called with what is done, how much of it, and the total.

    Returns
    -------
    Placement
        ``found`` says whether all poses are reached; where they are not, ``missed`` those that the
        best base leaves out.

    Raises
    ------
    PoseError, ArgumentError, NoSolverError

    Examples
    --------
    >>> import numpy as np
    >>> from dh2urdf import Robot
    >>> from dh2urdf.workspace import place
    >>> robot = Robot.from_dh("planar_rr")
    >>> found = place(robot, robot.fk([[0.1, 1.5], [0.3, 1.6]]), task="position")
    >>> found.found, found.margin > 0.5
    (True, True)
    """
    job = _job(robot, Ts, mount, task, within_limits)
    told = _told(progress)
    box = _box(job, region, height, yaw)
    lattice, bases, count, margin = _first(job, box, told)
    best, tried = finer(
        job, lattice, bases, count, margin, box, lambda a, b: told("finer lattices", a, b)
    )
    which = np.arange(len(job))
    margins, q = job.margins(np.tile(best, (len(job), 1)), which, lambda *_: None)
    missed = np.flatnonzero(np.isnan(q[:, 0]))
    first = missed[:LOOKED_AT]
    T = job.poses(np.tile(best, (len(first), 1)), first)
    reasons = [robot.why_unreachable(each, within_limits=within_limits, task=task) for each in T]
    x, y, z, turn = best.tolist()
    return Placement(
        x,
        y,
        z,
        turn,
        T_world_base=_standing(best) @ job.T_foot_base,
        margin=float(margins.min()),
        margins=margins,
        q=q,
        missed=tuple(missed.tolist()),
        never=tuple(i for i in first.tolist() if not _anywhere(job, i, region, box)),
        reasons=tuple(reasons),
        map=map_of(lattice, bases, count, margin, len(job)),
        tried=tried,
    )


def base_map(
    robot: Robot,
    Ts: ArrayLike,
    *,
    region: ArrayLike | None = None,
    height: float | tuple[float, float] = 0.0,
    yaw: float | tuple[float, float] | None = None,
    mount: ArrayLike | None = None,
    task: str = "pose",
    within_limits: bool = True,
    progress: Told | None = None,
) -> BaseMap:
    """The inverse map of an arm: what each base is worth for a job, or for a single pose.

    The first lattice of :func:`place`, whose parameters these are (Vahrenkamp, Asfour and Dillmann,
    "Robot placement based on reachability inversion", ICRA 2013).

    Raises
    ------
    PoseError, ArgumentError, NoSolverError
    """
    job = _job(robot, Ts, mount, task, within_limits)
    box = _box(job, region, height, yaw)
    lattice, bases, count, margin = _first(job, box, _told(progress))
    return map_of(lattice, bases, count, margin, len(job))


def _first(job: Job, box: Array, told: Told) -> tuple[Lattice, Array, NDArray[np.int64], Array]:
    """The first lattice, its bases, how many poses each misses, and their margins."""
    lattice = lattice_of(job, box)
    bases = lattice.bases()
    count, margin = worth(job, bases, lambda a, b: told("bases", a, b))
    return lattice, bases, count, margin


def _job(
    robot: Robot, Ts: ArrayLike, mount: ArrayLike | None, task: str, within_limits: bool
) -> Job:
    """Checked arguments."""
    arm: Robot = instance(robot, "robot", Robot)
    choice(task, "task", TASKS)
    T = finite_array(Ts, "Ts", "poses of shape (m, 4, 4)")
    if T.ndim != 3 or T.shape[1:] != (4, 4) or not 1 <= len(T) <= JOB_POSES:
        raise ArgumentError(
            f"Ts: expected 1 to {JOB_POSES} poses of shape (m, 4, 4), got {T.shape}"
        )
    check_pose(T, what="Ts")
    T_foot_base = np.eye(4)
    if mount is not None:
        angles = finite_array(mount, "mount", "three angles", shape=(3,))
        T_foot_base = pose(rpy_to_matrix(angles.tolist()), np.zeros(3))
    _check_solver(arm, task)
    return Job(arm, T, T_foot_base, task, flag(within_limits, "within_limits"))


def _check_solver(robot: Robot, task: str) -> None:
    """Raise where no solver finds all solutions for a task, in a line."""
    lacking = []
    for each in (task, *TASKS):
        try:
            robot.solver_for(task=each)
        except NoSolverError:
            lacking.append(each)
        if not lacking:
            return
    has = " and ".join(each for each in TASKS if each not in lacking)
    instead = f"it has one for {has}" if has else "it has none for any task"
    raise NoSolverError(
        f"{robot.model.name}: no solver finds all solutions for task {task!r}; {instead}"
    )


def _told(progress: Told | None) -> Told:
    """The caller's function, or one that does nothing."""
    if progress is None:
        return lambda *_: None
    told: Told = instance(progress, "progress", Callable)
    return told


def _box(
    job: Job,
    region: ArrayLike | None,
    height: float | tuple[float, float],
    yaw: float | tuple[float, float] | None,
) -> Array:
    """Lower and upper ends (4, 2) of x, y, z [m] and yaw [rad]."""
    out = np.empty((4, 2))
    if region is None:
        out[:2] = _sides(job)
    else:
        out[:2] = finite_array(region, "region", "numbers of shape (2, 2)", shape=(2, 2))
    out[2] = _ends(height, "height", LENGTH)
    out[3] = (-math.pi, math.pi) if yaw is None else _ends(yaw, "yaw", 2 * math.pi)
    for name, (low, high) in zip(RANGES, out.tolist(), strict=True):
        if max(-low, high) > LENGTH:
            raise ArgumentError(f"{name}: at most {LENGTH:g} m, got {low:g} and {high:g}")
        if low > high:
            raise ArgumentError(f"{name}: lower end first, got {low:g} and {high:g}")
    if out[3, 1] - out[3, 0] > 2 * math.pi + 1e-9:
        raise ArgumentError(
            f"yaw: a range of one turn at most, got {out[3, 0]:g} and {out[3, 1]:g} rad"
        )
    return out


def _sides(job: Job) -> Array:
    """Ends (2, 2) of x and y [m] between which all poses are in reach; some, if not all can be."""
    centre, radius = reach_ball(job.robot)
    far = radius + float(np.linalg.norm((job.T_foot_base[:3, :3] @ centre)[:2]))
    points = job.T_world_tool[:, :2, 3]
    low, high = points.min(axis=0) - far, points.max(axis=0) + far
    common = np.stack([high - 2 * far, low + 2 * far], axis=1)
    apart = bool((common[:, 0] > common[:, 1]).any())
    return np.stack([low, high], axis=1) if apart else common


def _ends(value: object, what: str, most: float) -> tuple[float, float]:
    """A range of one number, or of two."""
    if isinstance(value, tuple | list | np.ndarray) and len(value) == 2:
        low, high = (number(v, what, -most, most) for v in value)
        return low, high
    single = number(value, what, -most, most)
    return single, single


def _standing(base: Array) -> Array:
    """``T_world_foot`` of a base (x, y, z, yaw)."""
    T = rot_z(float(base[3]))
    T[:3, 3] = base[:3]
    return T


def _anywhere(job: Job, i: int, region: ArrayLike | None, box: Array) -> bool:
    """Whether pose i alone is reached from any base of a lattice of its own."""
    alone = replace(job, T_world_tool=job.T_world_tool[i : i + 1])
    own = box if region is not None else np.concatenate([_sides(alone), box[2:]])
    bases = lattice_of(alone, own).bases()
    return bool(alone.reached(bases, np.zeros(len(bases), np.intp), lambda *_: None).any())
