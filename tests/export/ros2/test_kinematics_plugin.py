"""``export --ros2 DIR --plugin``: MoveIt's plugin, compiled against its base class and used."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

import dh2urdf
from dh2urdf import DHRow, DHTable
from dh2urdf.exceptions import ArgumentError, NoSolverError
from dh2urdf.export.ros2 import ros2_package, write_ros2_package

HERE = Path(__file__).parent / "moveit"

AMENT = HERE.with_name("ament")

STRICT = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-pedantic", "-Woverloaded-virtual"]

ARMS = {
    "ur5e": "0.1, -1.2, 0.9, 0.4, 0.5, 0.6",
    "puma560": "0.1, 0.4, -0.9, 0.4, 0.5, 0.6",
    "xarm6": "0.1, -0.4, -0.9, 0.4, 0.5, 0.6",
}
"""Arms of six joints, one of which needs memory to work in, and a configuration of each."""


@pytest.mark.parametrize(("arm", "compiler"), [*zip(ARMS, ("g++", "clang++", "g++"), strict=True)])
def test_plugin_compiles_and_solves_as_moveit_asks(tmp_path, arm, compiler):
    """C++17 without a warning; seeds, callbacks, limits of consistency and errors as MoveIt's."""
    if not shutil.which(compiler):
        pytest.skip(f"not installed: {compiler}")
    folder = tmp_path / "arm_description"
    write_ros2_package(arm, folder, plugin=True)
    sources = [folder / "src/kinematics_plugin.cpp", HERE / "use_plugin.cpp"]
    words = [compiler, *STRICT, f"-DQS={ARMS[arm]}", f"-I{HERE}", f"-I{folder / 'include'}"]
    made = subprocess.run(
        [*words, *sources, "-o", "use"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert made.returncode == 0, made.stderr[:4000]
    used = subprocess.run(["./use"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (used.returncode, used.stdout.count("not so")) == (0, 0), used.stdout
    robot = dh2urdf.Robot.from_dh(arm)
    q = [float(v) for v in ARMS[arm].split(",")]
    assert used.stdout == f"{len(robot.ik(robot.fk(q)))} solutions\n"


@pytest.mark.skipif(not shutil.which("cmake"), reason="no cmake")
@pytest.mark.parametrize("plugin", [False, True])
def test_cmake_builds_and_installs_the_package(tmp_path, plugin):
    """With exported targets of ament and MoveIt alone; nothing is used that ROS gave up."""
    folder, there = tmp_path / "arm_description", tmp_path / "there"
    package = write_ros2_package("ur5e", folder, plugin=plugin)
    assert "ament_target_dependencies" not in package.files["CMakeLists.txt"]
    configure = ["-S", folder, "-B", "build", "-Werror=dev", "-Werror=deprecated"]
    for words in (
        [*configure, f"-DCMAKE_PREFIX_PATH={AMENT}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror"],
        ["--build", "build"],
        ["--install", "build", "--prefix", there],
    ):
        done = subprocess.run(
            ["cmake", *words], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    share, installed = f"share/{package.name}", {path.name for path in there.glob("lib/*")}
    assert installed == ({"libarm_description_kinematics.so"} if plugin else set())
    folders = ("config", "launch", "rviz", "srdf", "urdf")
    wanted = [f"{share}/{p}" for p in package.files if p.startswith(folders)]
    wanted += [p for p in package.files if p.startswith("include")]
    wanted += [f"{share}/kinematics_plugin.xml"] * plugin
    missing = [place for place in wanted if not (there / place).is_file()]
    assert not missing


def test_package_names_its_plugin_everywhere_alike():
    """The class of the source is the one of the description and of kinematics.yaml."""
    package = ros2_package("ur5e", "arm_description", plugin=True)
    plain = ros2_package("ur5e", "arm_description")
    more = {"include/arm_description/ur5e.h", "kinematics_plugin.xml", "src/kinematics_plugin.cpp"}
    assert package.files.keys() - plain.files.keys() == more
    described = etree.fromstring(package.files["kinematics_plugin.xml"].encode())
    (one,) = described.iter("class")
    assert f"kinematics_solver: {one.get('name')}\n" in package.files["config/kinematics.yaml"]
    source = package.files["src/kinematics_plugin.cpp"]
    exported = re.search(r"PLUGINLIB_EXPORT_CLASS\(([\w:]+), ([\w:]+)\)", source).groups()
    assert exported == (one.get("type"), one.get("base_class_type"))
    cmake = package.files["CMakeLists.txt"]
    assert f"add_library({described.get('path')} SHARED src/kinematics_plugin.cpp)" in cmake
    found = set(re.findall(r"find_package\((\w+)", cmake)) - {"ament_cmake"}
    depends = etree.fromstring(package.files["package.xml"].encode()).iter("depend")
    assert found == {depend.text for depend in depends}
    for place, text in package.files.items():
        assert not re.search(r"@[A-Z]+@", text), place
    assert "moveit_core" not in "".join(plain.files.values())


def test_plugin_keeps_to_the_limits_of_the_urdf():
    """Those that a joint has only there, too, within which MoveIt plans."""
    rows = tuple(DHRow(a=0.3, alpha=0.5, d=0.1, lower=low) for low in (None, -1.0, None))
    files = ros2_package(DHTable(rows, "standard", name="arm"), "arm_moveit", plugin=True).files
    joints = etree.fromstring(files["urdf/arm.urdf"].encode()).iter("limit")
    ends = [(float(x.get("lower")), float(x.get("upper"))) for x in joints]
    head = files["include/arm_moveit/arm.h"]
    texts = (re.search(rf"ARM_{k}\[ARM_JOINTS\] = {{(.*?)}};", head)[1] for k in ("LOWER", "UPPER"))
    own = [[float(number) for number in text.split(",")] for text in texts]
    assert np.allclose(np.transpose(own), ends, atol=1e-12)


def test_arms_without_a_plugin_are_refused_with_the_reason(refused, tmp_path):
    """A joint to spare, and a name that C++ could not quote; nothing is written."""
    with pytest.raises(NoSolverError, match="a joint to spare: leave out the plugin"):
        ros2_package("kuka_iiwa14", "arm_description", plugin=True)
    rows = tuple(DHRow(a=0.3, name=name) for name in ('a"b', "c", "d"))
    table = DHTable(rows, "standard", name="arm")
    with pytest.raises(ArgumentError, match="letters, digits"):
        ros2_package(table, "arm_description", plugin=True)
    assert "joint to spare" in refused("export", "kuka_iiwa14", "--ros2", "iiwa", "--plugin")
    assert "--plugin does nothing without --ros2" in refused(
        "export", "ur5", "--plugin", "-o", "a.h"
    )
    assert list(tmp_path.iterdir()) == []
