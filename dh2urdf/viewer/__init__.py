"""The arm in the browser: joints, the table explained and edited, inverse kinematics.

The only package that imports viser (extra ``viewer``).
"""

from dh2urdf.viewer.view import ArmView, view

__all__ = ["ArmView", "view"]
