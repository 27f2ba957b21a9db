"""The robot: a Pinocchio model with the chain between two of its frames, and what it can do."""

from dh2urdf.robot.carried import packed, unpacked
from dh2urdf.robot.robot import Robot

__all__ = ["Robot", "packed", "unpacked"]
