"""MoveIt's parameters as YAML: how inverse kinematics is solved, how fast joints move."""

import json
import re

from dh2urdf.conversions.write import DEFAULT_VELOCITY
from dh2urdf.dh import DHTable
from dh2urdf.export.ros2.semantics import GROUP

PLAIN_NAME = re.compile(r"[A-Za-z0-9_-]+")
"""Names that may be a joint's in ROS parameters, where a dot parts levels."""

KDL = "kdl_kinematics_plugin/KDLKinematicsPlugin"
"""The solver that every MoveIt has."""

_KINEMATICS = """\
{group}:
  kinematics_solver: {solver}
  kinematics_solver_search_resolution: 0.005
  kinematics_solver_timeout: 0.005
"""

_POSITION_ONLY = "  position_only_ik: true  # fewer than six joints reach no pose at will\n"

_LIMITS = """\
default_velocity_scaling_factor: 0.1
default_acceleration_scaling_factor: 0.1

# Accelerations are in no DH table: write the maker's here, which MoveIt needs to time a motion.
joint_limits:
"""

_LIMIT = """\
  {name}:
    has_velocity_limits: true
    max_velocity: {velocity}{note}
    has_acceleration_limits: false
"""


def kinematics_yaml(table: DHTable, solver: str = KDL) -> str:
    """Solver of the group; KDL's reaches positions alone with fewer than six joints."""
    alone = table.n < 6 and solver == KDL
    return _KINEMATICS.format(group=GROUP, solver=solver) + (_POSITION_ONLY if alone else "")


def joint_limits_yaml(table: DHTable) -> str:
    """Largest speed of each joint [rad/s, m/s]; positions are the URDF's."""
    text = _LIMITS
    for name, row in zip(table.joint_names, table.joints, strict=True):
        given = row.velocity is not None
        text += _LIMIT.format(
            name=json.dumps(name),
            velocity=yaml_float(row.velocity if row.velocity is not None else DEFAULT_VELOCITY),
            note="" if given else "  # not in the table",
        )
    return text


def yaml_float(value: float) -> str:
    """A number that YAML 1.1, which ROS reads, takes for no integer and no string."""
    mantissa, e, exponent = repr(float(value)).partition("e")
    return f"{mantissa}{'' if '.' in mantissa else '.0'}{e}{exponent}"
