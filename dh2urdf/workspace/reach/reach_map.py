"""The map of an arm's reach, in one call."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from numpy.typing import ArrayLike

from dh2urdf.doors import instance
from dh2urdf.exceptions import ArgumentError
from dh2urdf.robot import Robot
from dh2urdf.workspace.reach import store as stored
from dh2urdf.workspace.reach.block import Values
from dh2urdf.workspace.reach.dataset import (
    COMPLETE,
    MapSummary,
    empty_values,
    load_xarray,
    to_dataset,
)
from dh2urdf.workspace.reach.job import Job
from dh2urdf.workspace.reach.provenance import provenance
from dh2urdf.workspace.reach.refined import around
from dh2urdf.workspace.reach.run import connected, on_cluster, on_threads
from dh2urdf.workspace.reach.settings import Block, MapSettings, settings_of
from dh2urdf.workspace.refine import Progress

if TYPE_CHECKING:
    import xarray


def reach_map(
    robot: Robot,
    *,
    step: float = 0.05,
    orientations: int | ArrayLike = 200,
    region: ArrayLike | None = None,
    within_limits: bool = True,
    each: bool = False,
    refine: int = 0,
    client: Any = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> xarray.Dataset:
    """Where the tip can be, in how many ways and how well: all solutions on a grid of poses.

    Parameters
    ----------
    robot : Robot
    step : float
        Side of a voxel [m]; its values are those at its centre.
    orientations : int, or array_like, shape (k, 3, 3) or (k, spins, 3, 3)
        Orientations of the tip tried at each centre. A number: so many spread evenly over SO(3)
        (super-Fibonacci spirals, Alexa, CVPR 2022), over the turns of a planar arm or a SCARA.
        Rotations in base: those, as of :func:`cone`; one is reached when one of its spins is.
    region : array_like, shape (3, 2), optional
        Lower and upper ends along x, y, z of the base [m]; without it all that the arm's lengths
        allow.
    within_limits : bool
        Leave out solutions outside the joint limits.
    each : bool
        Keep the values of each orientation, too: variables that end in ``_each``.
    refine : int
        How often a voxel is halved along each axis where its share differs from a neighbour's by
        more than 0.1. The grid is then that of the smallest voxels; the halves of voxels that
        were not halved have the values of the whole, which ``level`` tells.
    client : dask.distributed.Client or str, optional
        A Dask cluster whose workers do the work, or its scheduler's address; without it the
        threads of this process do.
    store : path or URL, optional
        Where the map is kept as a Zarr group while it grows. One that is there with the same
        settings is gone on with; workers write to it themselves, so all have to see it.
    progress : callable, optional
        Called with the number of blocks done, those of earlier calls among them, and their total.

    Returns
    -------
    xarray.Dataset
        Over ``x``, ``y``, ``z`` [m]: ``share`` of orientations reached, ``solutions_mean`` and
        ``solutions_max`` of an orientation, the best ``manipulability`` and ``singular_value``
        (the smallest one) and ``limit_margin`` of all solutions, NaN where there are none. Read
        from the store as it is needed, where there is one.

    Raises
    ------
    ArgumentError, PoseError, NoSolverError, MissingExtraError
        Also an ``ArgumentError`` for a store of other settings.
    OutputError, SchedulerError
        A store that cannot be written, a scheduler that does not answer; what is done is kept.

    Examples
    --------
    >>> import dh2urdf
    >>> from dh2urdf.workspace import reach_map
    >>> found = reach_map(dh2urdf.Robot.from_dh("ur5e"), step=0.4, orientations=20)
    >>> found.share.sizes["x"], float(found.share.max()) > 0.9
    (6, True)
    """
    xr = load_xarray()
    path = None if store is None else _place(store)
    settings = settings_of(robot, step, orientations, region, within_limits, each, refine)
    values, finest, said = _worked(robot, settings, client, path, progress)
    if path is not None:
        with stored.writing(path):
            whole: xarray.Dataset = xr.open_zarr(path, chunks=None, zarr_format=3)
        return whole
    assert values is not None
    return to_dataset(finest, values, {**said, COMPLETE: 1})


def store_map(
    robot: Robot,
    settings: MapSettings,
    store: str | os.PathLike[str],
    client: Any = None,
    progress: Progress | None = None,
) -> MapSummary:
    """The work of :func:`reach_map` into a store, told in a few numbers, without xarray.

    Raises
    ------
    As :func:`reach_map`.
    """
    path = _place(store)
    _worked(robot, settings, client, path, progress)
    return stored.summary(path)


def _worked(
    robot: Robot, settings: MapSettings, client: Any, path: str | None, progress: Progress | None
) -> tuple[Values | None, MapSettings, dict[str, Any]]:
    """Values over the finest grid, where there is no store; its settings; what is said of them."""
    arm: Robot = instance(robot, "robot", Robot)
    if progress is not None:
        instance(progress, "progress", Callable)
    levels = [settings]
    for _ in range(settings.refine):
        levels.append(levels[-1].halved())
    arm.solver_for(task=settings.task)  # or an error, before anything is written
    said = provenance(arm, settings)
    paths = [_path_of_level(path, level, settings.refine) for level in range(len(levels))]
    values: Values | None = None
    with ExitStack() as stack:
        found = None if client is None else stack.enter_context(connected(client))
        for level, place in zip(levels[::-1], paths[::-1], strict=True):
            if place is not None:  # the map itself first, which the others are parts of
                stored.prepare(place, level, said)
        told = _Told(progress, sum(len(level.blocks()) for level in levels))
        for k, level in enumerate(levels):
            job = Job.of(arm, level, paths[k], paths[k - 1] if k else None)
            values = _level(job, values, found, told)
    return values, levels[-1], said


class _Told:
    """How many blocks are done."""

    def __init__(self, progress: Progress | None, total: int) -> None:
        self.progress, self.done, self.total = progress, 0, total

    def __call__(self) -> None:
        self.done += 1
        if self.progress is not None:
            self.progress(self.done, self.total)


def _level(job: Job, coarse: Values | None, client: Any, told: _Told) -> Values | None:
    """Work on what is not done of a level; its values over the whole grid, without a store."""
    settings, blocks, values = job.settings, job.settings.blocks(), None
    if job.path is None:
        values = empty_values(settings)
    else:
        marks = stored.take_back(job.path, settings)
        blocks = [block for block in blocks if not marks[block]]
        told.done += int(marks.sum())

    def beside(block: Block) -> Values | None:
        part = around(settings, block)
        return {name: v[part] for name, v in coarse.items()} if coarse else None

    if client is None:
        answers = on_threads(job, blocks, beside)
    else:
        answers = on_cluster(client, job, blocks, beside)
    with closing(answers):
        for block, found in answers:
            for name, part in (found or {}).items():
                assert values is not None
                values[name][settings.part(block)] = part
            told()
    if job.path is not None:
        stored.finish(job.path)
    return values


def _path_of_level(path: str | None, level: int, finest: int) -> str | None:
    """Where a level is kept: the finest is the map itself, the others are groups in it."""
    return path if path is None or level == finest else f"{path}/level_{level}"


def _place(store: str | os.PathLike[str]) -> str:
    """A path that means the same to every process, or a URL as it is."""
    try:
        text = os.fspath(store)
    except TypeError:
        raise ArgumentError(f"store: expected a path or a URL, got {store!r:.60}") from None
    if str(text).startswith("file://"):
        text = unquote(urlsplit(str(text)).path)
    return str(text) if "://" in str(text) else os.path.abspath(text)
