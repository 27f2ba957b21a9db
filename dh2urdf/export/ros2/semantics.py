"""The SRDF of an arm: its group, its end effector, its home, and pairs that are not checked.

Elements as https://wiki.ros.org/srdf/review and moveit2's ``robot_model.cpp`` read them.
"""

from collections.abc import Mapping, Sequence

from lxml import etree

from dh2urdf.export.ros2.self_collisions import SAMPLES, Disabled

GROUP = "manipulator"
"""The planning group of the arm, as most configurations of industrial arms call it."""

TOOL = "tool"
"""The end effector, and its group."""


def srdf_text(
    name: str,
    last_link: str,
    home: Mapping[str, float],
    disabled: Sequence[Disabled],
    passive: Sequence[str] = (),
) -> str:
    """The SRDF of a chain from ``base_link`` to ``tool0``.

    ``last_link`` carries the tool; ``home`` gives each joint's value [rad, m]; ``passive`` joints
    follow others, and nobody publishes them.
    """
    robot = etree.Element("robot", name=name)
    arm = etree.SubElement(robot, "group", name=GROUP)
    etree.SubElement(arm, "chain", base_link="base_link", tip_link="tool0")
    tool = etree.SubElement(robot, "group", name=TOOL)
    etree.SubElement(tool, "link", name="tool0")
    state = etree.SubElement(robot, "group_state", name="home", group=GROUP)
    for joint, value in home.items():
        etree.SubElement(state, "joint", name=joint, value=repr(value))
    for joint in passive:
        etree.SubElement(robot, "passive_joint", name=joint)
    places = {"parent_link": last_link, "group": TOOL, "parent_group": GROUP}
    etree.SubElement(robot, "end_effector", name=TOOL, **places)
    robot.append(
        etree.Comment(
            f" Never: in none of {SAMPLES} random configurations; Always: in 95 % of 1000; "
            "Default: at home; bodies as drawn, so sample again with the maker's meshes. "
        )
    )
    for pair in disabled:
        links = {"link1": pair.link1, "link2": pair.link2}
        etree.SubElement(robot, "disable_collisions", **links, reason=str(pair.reason))
    etree.indent(robot, space="  ")
    return f'<?xml version="1.0"?>\n{etree.tostring(robot, encoding="unicode")}\n'
