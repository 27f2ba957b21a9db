"""A ROS 2 description package of an arm.

`package` puts the files together and writes them; `self_collisions` samples which links cannot
meet, `semantics` says it in an SRDF; `parameters` writes MoveIt's YAML; `templates/` holds the
files that are the same for every arm but for what stands in ``@NAME@``.
"""

from dh2urdf.export.ros2.package import Ros2Package, ros2_package, write_ros2_package

__all__ = ["Ros2Package", "ros2_package", "write_ros2_package"]
