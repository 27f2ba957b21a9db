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

_FEW_VALUES = "  position_only_ik: true  # fewer than six values reach no pose at will\n"

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
    """Solver of the group; KDL's reaches positions alone with fewer than six values."""
    values = sum(row.mimic is None for row in table.joints)
    few = _POSITION_ONLY if table.n < 6 else _FEW_VALUES
    alone = few if values < 6 and solver == KDL else ""
    said = "".join(f"# {line}\n" for line in coupled_words(table))
    return said + _KINEMATICS.format(group=GROUP, solver=solver) + alone


def coupled_words(table: DHTable) -> list[str]:
    """What someone who moves the URDF's joints has to know of followers and couplings."""
    pairs = zip(table.joint_names, table.joints, strict=True)
    follow = "; ".join(f"{name} follows {row.mimic.joint}" for name, row in pairs if row.mimic)
    words = [
        f"{name} of the URDF is the joint itself, at the controller's {name} plus "
        f"{' plus '.join(f'{ratio:g} {other}' for other, ratio in terms.items())}"
        for name, terms in table.couplings.items()
    ]
    return [f"{' '.join(each.split())}." for each in (follow, *words) if each]


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
