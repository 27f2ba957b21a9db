"""A workspace of xacro packages in the shape in which makers ship them, its numbers made up."""

from pathlib import Path

ROBOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'

MODELS = {"mini3": (0.3, 0.2), "mini5": (0.5, 0.4), "mini10e": (1.0, 0.8)}
"""Models of the arm, with the lengths of its two links [m]."""

TOP = f"""<?xml version="1.0"?>
{ROBOT} name="$(arg name)">
  <xacro:arg name="name" default="mini"/>
  <xacro:arg name="prefix" default=""/>
  {{type}}
  <xacro:arg name="tool" default="false"/>
  <xacro:arg name="kinematics_file"
             default="$(find mini_description)/config/$(arg arm_type)/kinematics.yaml"/>
  <xacro:include filename="$(find mini_description)/urdf/mini_macro.xacro"/>
  <link name="world"/>
  <xacro:mini_arm prefix="$(arg prefix)" parent="world" kinematics_file="$(arg kinematics_file)">
    <origin xyz="0 0 0.1" rpy="0 0 0"/>
  </xacro:mini_arm>
  <xacro:if value="$(arg tool)">
    <xacro:include filename="$(find mini_resources)/urdf/tool.xacro"/>
    <xacro:tool prefix="$(arg prefix)"/>
  </xacro:if>
</robot>
"""

MACRO = f"""<?xml version="1.0"?>
{ROBOT}>
  <xacro:include filename="package://mini_resources/urdf/common.xacro"/>
  <xacro:macro name="read_lengths" params="kinematics_file">
    <xacro:property name="config" value="${{xacro.load_yaml(kinematics_file)}}"/>
    <xacro:property name="lengths" value="${{config['kinematics']['lengths']}}" scope="parent"/>
    <xacro:property name="limit" value="${{config['limit']}}" scope="parent"/>
  </xacro:macro>
  <xacro:macro name="mini_arm" params="prefix parent kinematics_file *origin">
    <xacro:read_lengths kinematics_file="${{kinematics_file}}"/>
    <link name="${{prefix}}base"/>
    <joint name="${{prefix}}base_joint" type="fixed">
      <xacro:insert_block name="origin"/>
      <parent link="${{parent}}"/>
      <child link="${{prefix}}base"/>
    </joint>
    <xacro:turning name="${{prefix}}joint_1" parent="${{prefix}}base" child="${{prefix}}upper"
                   x="0" limit="${{limit}}" mesh="upper"/>
    <xacro:turning name="${{prefix}}joint_2" parent="${{prefix}}upper" child="${{prefix}}fore"
                   x="${{lengths.first}}" limit="${{radians(150)}}" mesh="fore"/>
    <link name="${{prefix}}flange"/>
    <joint name="${{prefix}}flange_joint" type="fixed">
      <origin xyz="${{lengths['second']}} 0 0" rpy="0 ${{pi/2}} 0"/>
      <parent link="${{prefix}}fore"/>
      <child link="${{prefix}}flange"/>
    </joint>
  </xacro:macro>
</robot>
"""

COMMON = f"""<?xml version="1.0"?>
{ROBOT}>
  <xacro:macro name="turning" params="name parent child x limit mesh:=none">
    <link name="${{child}}">
      <visual>
        <geometry><mesh filename="package://mini_resources/meshes/${{mesh}}.stl"/></geometry>
      </visual>
      <inertial>
        <mass value="1"/>
        <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>
      </inertial>
    </link>
    <joint name="${{name}}" type="revolute">
      <origin xyz="${{x}} 0 0" rpy="0 0 0"/>
      <parent link="${{parent}}"/>
      <child link="${{child}}"/>
      <axis xyz="0 0 1"/>
      <limit lower="${{-limit}}" upper="${{limit}}" effort="10" velocity="2"/>
    </joint>
  </xacro:macro>
</robot>
"""

TOOL = f"""<?xml version="1.0"?>
{ROBOT}>
  <xacro:macro name="tool" params="prefix">
    <link name="${{prefix}}tcp"/>
    <joint name="${{prefix}}tcp_joint" type="fixed">
      <origin xyz="0 0 0.05"/>
      <parent link="${{prefix}}flange"/>
      <child link="${{prefix}}tcp"/>
    </joint>
  </xacro:macro>
</robot>
"""

NEEDED = ""
"""No line for the model of the arm, which then has no default."""

WRONG = '<xacro:arg name="arm_type" default="minix"/>'
"""A default that names no model, so that one has to be chosen."""


def write_package(folder: Path, name: str, files: dict[str, str], *, manifest: bool = True) -> Path:
    """A package of files by their paths, with its package.xml."""
    if manifest:
        text = f'<package format="3"><name>{name}</name></package>'
        files = {"package.xml": text, **files}
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    return folder


def write_workspace(folder: Path, arm_type: str = NEEDED, *, resources: str = "src") -> Path:
    """``mini_description`` in a repository of another name, ``mini_resources`` in a folder.

    Returns the top file.
    """
    yaml = "kinematics:\n  lengths: {{first: {}, second: {}}}\nlimit: !degrees 170\n"
    config = {f"config/{m}/kinematics.yaml": yaml.format(*sizes) for m, sizes in MODELS.items()}
    urdf = {"urdf/mini.urdf.xacro": TOP.format(type=arm_type), "urdf/mini_macro.xacro": MACRO}
    here = write_package(folder / "src/Mini_Robots", "mini_description", {**config, **urdf})
    parts = {"urdf/common.xacro": COMMON, "urdf/tool.xacro": TOOL, "meshes/upper.stl": "solid\n"}
    write_package(folder / resources / "mini_resources", "mini_resources", parts)
    return here / "urdf/mini.urdf.xacro"
