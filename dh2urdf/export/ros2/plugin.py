"""The arm's own solver as a kinematics plugin of MoveIt 2, in the package of the arm."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from dh2urdf.conversions.write import default_limits
from dh2urdf.dh import DHTable
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError, NoSolverError
from dh2urdf.export.blanks import filled
from dh2urdf.export.ros2.parameters import PLAIN_NAME
from dh2urdf.export.self_test import has_workspace
from dh2urdf.export.source import exported
from dh2urdf.robot import Robot

CMAKE = """
find_package(moveit_core REQUIRED)
find_package(pluginlib REQUIRED)
add_library({name}_kinematics SHARED src/kinematics_plugin.cpp)
target_compile_features({name}_kinematics PRIVATE cxx_std_17)
target_include_directories({name}_kinematics PRIVATE include)
target_link_libraries({name}_kinematics PRIVATE
  moveit_core::moveit_kinematics_base pluginlib::pluginlib)
pluginlib_export_plugin_description_file(moveit_core kinematics_plugin.xml)
install(TARGETS {name}_kinematics LIBRARY DESTINATION lib)
install(DIRECTORY include/ DESTINATION include)
"""

DEPENDS = """
  <depend>moveit_core</depend>
  <depend>pluginlib</depend>
"""

WORKSPACE = """\
    static thread_local {p}_workspace work;
    static thread_local const bool prepared = ({p}_prepare(&work), true);
    (void)prepared;
"""

ABOUT = (
    "\n| `include/`, `src/`, `kinematics_plugin.xml` | the arm's own solver as MoveIt's plugin |"
)


def plugin_blanks(name: str) -> dict[str, str]:
    """What the plugin adds to the package's other files."""
    return {
        "PLUGIN_CMAKE": CMAKE.format(name=name),
        "PLUGIN_DEPENDS": DEPENDS,
        "PLUGIN_ABOUT": ABOUT,
    }


def _with_limits(table: DHTable) -> DHTable:
    """The table whose joints have the limits that they have in the URDF."""
    ends = (default_limits(table, i) for i in range(table.n))
    rows = []
    for row in table.rows:
        lower, upper = next(ends) if row.is_joint else (row.lower, row.upper)
        rows.append(replace(row, lower=lower, upper=upper))
    return replace(table, rows=tuple(rows))


def plugin_files(table: DHTable, blanks: Mapping[str, str]) -> dict[str, str]:
    """The solver, the plugin and its description, by their paths in the package.

    ``blanks`` has the names of the package and of the arm.

    Raises
    ------
    ArgumentError
        A name of a joint is none for C++.
    NoSolverError
        The arm has a joint to spare, or its solver is not one of kernels alone.
    """
    if odd := [name for name in table.joint_names if not PLAIN_NAME.fullmatch(name)]:
        raise ArgumentError(f"{found(odd[0])}: a plugin has joints of letters, digits, _ and -")
    from dh2urdf.ik.redundant import SweptJoint

    robot = Robot.from_dh(_with_limits(table))
    if isinstance(robot.solver, SweptJoint):
        raise NoSolverError(
            "MoveIt asks its plugins with no joint held, and this arm has a joint to spare: leave "
            "out the plugin (--plugin), and the package is written with KDL's"
        )
    made = exported(robot, language="c")
    joints = ", ".join(f'"{name}"' for name in table.joint_names)
    works = has_workspace(made)
    both = {
        **blanks,
        "PREFIX": made.prefix,
        "JOINTS": joints,
        "WORKSPACE": WORKSPACE.format(p=made.prefix) if works else "",
        "WORK": "&work, " if works else "",
    }
    places = ("kinematics_plugin.xml", "src/kinematics_plugin.cpp")
    return {
        f"include/{blanks['PACKAGE']}/{blanks['ARM']}.h": made.text,
        **{place: filled(__package__, Path(place).name, both) for place in places},
    }
