"""The best base found for a job, or which of its poses stand in the way of one."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, rot_z
from dh2urdf.workspace.placing.asked import Told, box_of, job_of, sides, told_of
from dh2urdf.workspace.placing.job import Job
from dh2urdf.workspace.placing.lattice import BaseMap, Lattice, finer, lattice_of, map_of, worth

LOOKED_AT = 100
"""Poses out of reach of which more is said: the first."""


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
    job = job_of(robot, Ts, mount, task, within_limits)
    told = told_of(progress)
    box = box_of(job, region, height, yaw)
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
    job = job_of(robot, Ts, mount, task, within_limits)
    box = box_of(job, region, height, yaw)
    lattice, bases, count, margin = _first(job, box, told_of(progress))
    return map_of(lattice, bases, count, margin, len(job))


def _first(job: Job, box: Array, told: Told) -> tuple[Lattice, Array, NDArray[np.int64], Array]:
    """The first lattice, its bases, how many poses each misses, and their margins."""
    lattice = lattice_of(job, box)
    bases = lattice.bases()
    count, margin = worth(job, bases, lambda a, b: told("bases", a, b))
    return lattice, bases, count, margin


def _standing(base: Array) -> Array:
    """``T_world_foot`` of a base (x, y, z, yaw)."""
    T = rot_z(float(base[3]))
    T[:3, 3] = base[:3]
    return T


def _anywhere(job: Job, i: int, region: ArrayLike | None, box: Array) -> bool:
    """Whether pose i alone is reached from any base of a lattice of its own."""
    alone = replace(job, T_world_tool=job.T_world_tool[i : i + 1])
    own = box if region is not None else np.concatenate([sides(alone), box[2:]])
    bases = lattice_of(alone, own).bases()
    return bool(alone.reached(bases, np.zeros(len(bases), np.intp), lambda *_: None).any())
