"""The map of an arm's reach, in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from dh2urdf.doors import instance
from dh2urdf.exceptions import ArgumentError
from dh2urdf.robot import Robot
from dh2urdf.workspace.reach.block import block_values
from dh2urdf.workspace.reach.dataset import empty_values, load_xarray, to_dataset
from dh2urdf.workspace.reach.settings import settings_of
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
    client: Any = None,
    store: Any = None,
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
    progress : callable, optional
        Called with the number of blocks done and their total.

    Returns
    -------
    xarray.Dataset
        Over ``x``, ``y``, ``z`` [m]: ``share`` of orientations reached, ``solutions_mean`` and
        ``solutions_max`` of an orientation, the best ``manipulability`` and ``singular_value``
        (the smallest one) and ``limit_margin`` of all solutions, NaN where there are none.

    Raises
    ------
    ArgumentError, PoseError, NoSolverError, MissingExtraError

    Examples
    --------
    >>> import dh2urdf
    >>> from dh2urdf.workspace import reach_map
    >>> found = reach_map(dh2urdf.Robot.from_dh("ur5e"), step=0.4, orientations=20)
    >>> found.share.sizes["x"], float(found.share.max()) > 0.9
    (6, True)
    """
    load_xarray()
    arm: Robot = instance(robot, "robot", Robot)
    if client is not None or store is not None:
        raise ArgumentError("client and store are not there yet")
    settings = settings_of(arm, step, orientations, region, within_limits, each)
    blocks, values = settings.blocks(), empty_values(settings)
    for done, block in enumerate(blocks, 1):
        for name, part in block_values(arm, settings, block).items():
            values[name][settings.part(block)] = part
        if progress is not None:
            progress(done, len(blocks))
    return to_dataset(settings, values, {"robot": arm.model.name})
