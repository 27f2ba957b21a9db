"""One block as a task: what a worker needs for it, be it a thread or another machine's process."""

from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from typing import Any

from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.robot import Robot, packed, unpacked
from dh2urdf.workspace.reach import store
from dh2urdf.workspace.reach.block import Values, block_values
from dh2urdf.workspace.reach.refined import around, refined_block
from dh2urdf.workspace.reach.settings import Block, MapSettings


@dataclass(frozen=True, eq=False)
class Job:
    """What the blocks of one level of a map have in common, as plain data.

    Attributes
    ----------
    robot : bytes
        Built once by each process.
    settings : MapSettings
    version : str
        Of the package.
    path, before : str or None
        The store of this level, and that of the coarser one; without them values are returned.
    """

    robot: bytes
    settings: MapSettings
    version: str
    path: str | None
    before: str | None

    @cached_property
    def arrays(self) -> dict[str, Any]:
        """Those of the store, opened once by each process."""
        assert self.path is not None
        return store.arrays(self.path)

    @classmethod
    def of(cls, robot: Robot, settings: MapSettings, path: str | None, before: str | None) -> "Job":
        """The job of one level."""
        return cls(packed(robot), settings, version("dh2urdf"), path, before)


def run_block(job: Job, block: Block, coarse: Values | None = None) -> Values | None:
    """Work out a block and write it to the job's store, or return its values.

    ``coarse``: variables of the coarser voxels around it, where there is no store to read.

    Raises
    ------
    Dh2UrdfError
        This process has another version of the package.
    OutputError
    """
    if job.version != version("dh2urdf"):
        raise Dh2UrdfError(
            f"a worker has dh2urdf {version('dh2urdf')}, the call was made by {job.version}; "
            "both have to be the same"
        )
    settings = job.settings
    if job.path is not None and store.is_done(job.path, block, job.arrays):
        return None
    if job.before is not None:
        coarse = store.read(job.before, around(settings, block))
    robot = unpacked(job.robot)
    if coarse is None:
        values = block_values(robot, settings, block)
    else:
        values = refined_block(robot, settings, block, coarse)
    if job.path is None:
        return values
    store.write(job.path, settings, block, values, job.arrays)
    return None
