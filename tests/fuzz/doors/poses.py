"""Files of poses."""

from pathlib import Path

import numpy as np
from hostile import outcome

from dh2urdf.cli.verbs.ik.poses import Poses, poses_of_csv
from dh2urdf.exceptions import PoseError
from tests.fuzz.door import Door


def read(data: bytes, folder: Path) -> None:
    """Poses are finite and rigid, one a line, or the file is refused; with each reading of it."""
    path = folder / "poses.csv"
    path.write_bytes(data)
    for options in ({}, {"nearest": True}, {"position_only": True}):
        found = outcome(poses_of_csv, str(path), deg=False, **options)
        if isinstance(found, Poses):
            R = found.T[:, :3, :3]
            assert np.isfinite(found.T).all()
            assert len(found.T) == len(found.lines)
            assert np.abs(R @ R.swapaxes(1, 2) - np.eye(3)).max() < 1e-5
        else:
            assert isinstance(found, PoseError)
    path.unlink()


DOORS = [Door("poses", read, ("poses",))]
