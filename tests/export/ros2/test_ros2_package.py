"""``dh2urdf export --ros2``: a description package, checked as far as it can be without ROS."""

import ast
import errno
import math
import os
import re
import stat
from itertools import pairwise
from pathlib import Path

import pinocchio as pin
import pytest
from lxml import etree
from ruamel.yaml import YAML

import dh2urdf
from dh2urdf import DHRow, DHTable, JointType
from dh2urdf.exceptions import ArgumentError, OutputError, OutputExistsError
from dh2urdf.export.ros2 import ros2_package, write_ros2_package
from dh2urdf.export.ros2.self_collisions import _Sampler

ARMS = ["denso_vs6556", "ur5", "kuka_iiwa14", "stanford", "planar_rrr", "omron_cobra600", "px100"]

FORMAT_3 = ["name", "version", "description", "maintainer", "license"]
"""Elements that a package.xml of format 3 must have: http://download.ros.org/schema/."""


@pytest.fixture(scope="module", params=ARMS)
def made(request):
    """An arm and its package."""
    table = dh2urdf.load_table(request.param)
    return table, ros2_package(table, "arm_description")


def yaml(text):
    """A document as ROS reads it, by YAML 1.1."""
    reader = YAML(typ="safe", pure=True)
    reader.version = (1, 1)
    return reader.load(text)


def trees(package):
    """The URDF and the SRDF."""
    texts = [text for place, text in package.files.items() if place.endswith((".urdf", ".srdf"))]
    srdf, urdf = (etree.fromstring(text.encode()) for text in texts)
    assert (srdf[0].tag, urdf.find("joint") is not None) == ("group", True)
    return urdf, srdf


def test_every_name_of_the_srdf_is_in_the_urdf(made):
    """Links and joints exist, groups are those that the file defines, the robot is the same."""
    _, package = made
    urdf, srdf = trees(package)
    links = {link.get("name") for link in urdf.iter("link")}
    joints = {joint.get("name") for joint in urdf.iter("joint")}
    groups = {group.get("name") for group in srdf.iter("group")}
    assert srdf.get("name") == urdf.get("name")
    keys = ("base_link", "tip_link", "parent_link", "link1", "link2")
    named = [element.get(key) for element in srdf.iter() for key in keys if element.get(key)]
    named += [link.get("name") for link in srdf.iterfind("group/link")]
    assert set(named) <= links
    assert {joint.get("name") for joint in srdf.iter("joint")} <= joints
    assert {x.get(key) for x in srdf for key in ("group", "parent_group") if x.get(key)} <= groups


def test_the_group_is_the_chain_from_base_to_tip_with_all_joints(made):
    """Up from the chain's tip to its base lie the table's joints; the tool hangs on its last."""
    table, package = made
    urdf, srdf = trees(package)
    parents = {joint.find("child").get("link"): joint for joint in urdf.iter("joint")}
    chain = srdf.find("group[@name='manipulator']/chain")
    link, passed = chain.get("tip_link"), []
    while link != chain.get("base_link"):
        passed.insert(0, parents[link])
        link = passed[0].find("parent").get("link")
    moving = [joint.get("name") for joint in passed if joint.get("type") != "fixed"]
    assert moving == list(table.joint_names)
    effector = srdf.find("end_effector")
    assert effector.get("parent_link") == passed[-1].find("parent").get("link")
    assert effector.get("parent_group") == "manipulator"


def test_home_gives_every_joint_a_value_within_its_limits(made):
    """The state names each joint of the group once."""
    table, package = made
    urdf, srdf = trees(package)
    state = srdf.find("group_state[@name='home']")
    assert [joint.get("name") for joint in state] == list(table.joint_names)
    for joint in state:
        limit = urdf.find(f"joint[@name='{joint.get('name')}']/limit")
        assert float(limit.get("lower")) <= float(joint.get("value")) <= float(limit.get("upper"))


def test_disabled_pairs_are_told_once_with_a_reason_and_neighbours_are_adjacent(made):
    """Each pair of links with bodies stands once at most, those that follow each other do."""
    _, package = made
    urdf, srdf = trees(package)
    pairs = {frozenset((x.get("link1"), x.get("link2"))): x.get("reason")
             for x in srdf.iter("disable_collisions")}  # fmt: skip
    assert len(pairs) == len(list(srdf.iter("disable_collisions"))) == len(package.disabled)
    assert {len(pair) for pair in pairs} == {2}
    assert set(pairs.values()) <= {"Adjacent", "Default", "Always", "Never"}
    solid = [link.get("name") for link in urdf.iter("link") if link.find("collision") is not None]
    order = sorted(solid, key=lambda n: (n != "base_link_inertia", n))
    adjacent = {pair for pair, reason in pairs.items() if reason == "Adjacent"}
    assert adjacent == {frozenset(pair) for pair in pairwise(order)}
    assert {name for pair in pairs for name in pair} <= set(solid)


def test_parameters_name_the_group_and_every_joint(made):
    """Speeds are those of the URDF, as floats; fewer than six joints want positions only."""
    table, package = made
    urdf, _ = trees(package)
    (group, solver), *more = yaml(package.files["config/kinematics.yaml"]).items()
    assert (group, more) == ("manipulator", [])
    assert solver["kinematics_solver"] == "kdl_kinematics_plugin/KDLKinematicsPlugin"
    assert solver.get("position_only_ik", False) is (table.n < 6)
    limits = yaml(package.files["config/joint_limits.yaml"])["joint_limits"]
    assert list(limits) == list(table.joint_names)
    for name, limit in limits.items():
        assert isinstance(limit["max_velocity"], float)
        written = urdf.find(f"joint[@name='{name}']/limit").get("velocity")
        assert limit["max_velocity"] == float(written)


def test_package_xml_has_what_format_3_wants_and_names_what_is_launched(made):
    """Name, version, description, maintainer, licence; every launched package is a dependency."""
    _, package = made
    root = etree.fromstring(package.files["package.xml"].encode())
    assert (root.tag, root.get("format")) == ("package", "3")
    order = [child.tag for child in root if isinstance(child.tag, str)]
    assert order[:5] == FORMAT_3
    assert root.findtext("name") == package.name
    assert re.fullmatch(r"\d+\.\d+\.\d+", root.findtext("version"))
    assert "@" in root.find("maintainer").get("email")
    assert root.findtext("buildtool_depend") == root.findtext("export/build_type") == "ament_cmake"
    nodes = re.findall(r'package="(\w+)"', package.files["launch/display.launch.py"])
    assert {*nodes, "launch", "launch_ros"} == {d.text for d in root.iter("exec_depend")}


def test_launch_file_is_python_and_opens_files_of_the_package(made):
    """It compiles, makes a description, and joins paths that are installed."""
    _, package = made
    text = package.files["launch/display.launch.py"]
    compile(text, "display.launch.py", "exec")
    functions = [n.name for n in ast.parse(text).body if isinstance(n, ast.FunctionDef)]
    assert functions == ["generate_launch_description"]
    opened = re.findall(r'share / "([^"]+)" / "([^"]+)"', text)
    assert len(opened) == 2
    assert {"/".join(parts) for parts in opened} <= package.files.keys()
    assert yaml(package.files["rviz/display.rviz"])["Visualization Manager"]["Displays"]


def test_cmake_installs_every_folder_and_no_blank_is_left(made):
    """Folders of the files are those of the install rule; the project is the package."""
    _, package = made
    rule = re.search(r"install\(DIRECTORY ([a-z0-9 ]+) DEST", package.files["CMakeLists.txt"])
    assert rule[1].split() == sorted({p.split("/")[0] for p in package.files if "/" in p})
    assert f"project({package.name})" in package.files["CMakeLists.txt"]
    for place, text in package.files.items():
        assert not re.search(r"@[A-Z]+@", text), place
    told = re.findall(r"`([\w./]+\.(?:urdf|srdf|yaml|py))`", package.files["README.md"])
    assert set(told) <= package.files.keys()


def test_pairs_are_right_on_an_arm_whose_collisions_are_plain():
    """A short last link cannot turn back to the first; given all its turn, it can."""

    def reasons(turn):
        rows = [DHRow(a=a, lower=-turn, upper=turn) for a in (1.0, 1.0, 1.0)]
        package = ros2_package(DHTable(tuple(rows), "standard", name="arm"), "arm_description")
        return {(pair.link1, pair.link2): str(pair.reason) for pair in package.disabled}

    assert reasons(0.2)["link_1", "link_3"] == "Never"
    assert ("link_1", "link_3") not in reasons(3.0)
    assert reasons(3.0)["link_1", "link_2"] == "Adjacent"


def test_bodies_that_overlap_at_home_or_nearly_always_are_told_apart():
    """Drums with no length between them meet at home, those that home alone parts nearly always."""
    rows = [DHRow(a=1.0), DHRow(d=0.001, alpha=1.0), DHRow(a=0.001), DHRow(a=0.5)]
    disabled = ros2_package(DHTable(tuple(rows), "standard", name="arm"), "arm_one").disabled
    reasons = {(pair.link1, pair.link2): str(pair.reason) for pair in disabled}
    assert reasons["link_2", "link_4"] == "Default"


def test_pairs_that_never_meet_do_not_in_other_samples_either():
    """Of 2,000 configurations that were not among the samples, none makes such a pair collide."""
    for arm in ("denso_vs6556", "ur5", "kuka_iiwa14"):
        package = ros2_package(arm, "arm_description")
        never = {(p.link1, p.link2) for p in package.disabled if p.reason == "Never"}
        sampler = _Sampler(package.files[f"urdf/{arm}.urdf"])
        names = sampler.links
        sampler.watch({(i, j) for i, j in sampler.pairs if (names[i], names[j]) in never})
        pin.seed(7)
        for _ in range(2_000):
            assert not sampler.meeting(pin.randomConfiguration(sampler.model)), arm


def test_the_same_arm_gives_the_same_package():
    """Sampling has a seed of its own."""
    assert ros2_package("stanford", "one_arm") == ros2_package("stanford", "one_arm")


def test_a_new_folder_appears_whole_or_not_at_all(tmp_path, monkeypatch):
    """Where a file cannot be written nothing is left; else the files and nothing beside them."""
    target = tmp_path / "arm_description"

    def fail(path, *_, **__):
        path.touch()
        if path.name == "package.xml":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_text", fail)
        with pytest.raises(OutputError, match=r"arm_description: cannot write: No space"):
            write_ros2_package("planar_rr", target)
    assert list(tmp_path.iterdir()) == []
    package = write_ros2_package("planar_rr", target)
    there = {str(p.relative_to(target)): p for p in target.rglob("*") if p.is_file()}
    assert {place: path.read_text() for place, path in there.items()} == package.files
    assert list(tmp_path.iterdir()) == [target]
    (tmp_path / "other").mkdir()
    assert stat.S_IMODE(target.stat().st_mode) == stat.S_IMODE((tmp_path / "other").stat().st_mode)


def test_a_folder_that_holds_something_is_refused_and_with_force_keeps_the_rest(tmp_path):
    """An empty folder is taken; files that the package has not stay as they were."""
    target = tmp_path / "arm_description"
    target.mkdir()
    write_ros2_package("planar_rr", target)
    with pytest.raises(OutputExistsError, match="--force"):
        write_ros2_package("ur5", target)
    assert not (target / "urdf/ur5.urdf").exists()
    (target / "urdf/notes.txt").write_text("mine")
    (target / "package.xml").write_text("theirs")
    package = write_ros2_package("ur5", target, force=True)
    assert (target / "urdf/notes.txt").read_text() == "mine"
    assert (target / "package.xml").read_text() == package.files["package.xml"]


@pytest.mark.parametrize("name", ["Arm", "a", "1arm", "arm-x", "arm__x", "arm_", "_arm", "ärm", ""])
def test_names_that_ros_takes_for_no_package_are_refused(name, tmp_path):
    """The message says what is allowed; nothing is written."""
    with pytest.raises(ArgumentError, match="lower-case letters"):
        ros2_package("planar_rr", name)
    assert list(tmp_path.iterdir()) == []


def test_hostile_names_are_quoted_and_told(tmp_path):
    """Joints of any name stay what they are in XML and YAML; ROS's own rule is a warning."""
    names = ["a: b # c", '"\\', "joint.1", "<x/>"]
    rows = tuple(DHRow(a=0.3, name=name) for name in names)
    package = ros2_package(DHTable(rows, "standard", name="../x y"), "arm_description")
    urdf, srdf = trees(package)
    assert {f"urdf/{urdf_name}.urdf" for urdf_name in ["x_y"]} <= package.files.keys()
    assert urdf.get("name") == srdf.get("name") == "../x y"
    assert [joint.get("name") for joint in srdf.iter("joint")] == names
    assert list(yaml(package.files["config/joint_limits.yaml"])["joint_limits"]) == names
    assert "ROS parameters" in package.warnings[-1]
    assert names[0] in package.warnings[-1]


def test_numbers_are_floats_in_yaml_however_large_or_small():
    """YAML 1.1 takes 1e-05 for a string and 3 for an integer."""
    for value in (3.0, 1e-5, 1e22, 2.5e-7, math.pi):
        rows = (DHRow(a=1.0, velocity=value), DHRow(d=1.0, joint_type=JointType.PRISMATIC))
        files = ros2_package(DHTable(rows, "standard", name="arm"), "arm_one").files
        read = yaml(files["config/joint_limits.yaml"])["joint_limits"]["joint_1"]["max_velocity"]
        assert (type(read), read) == (float, value)


def test_verb_writes_a_package_and_refuses_what_it_cannot(run, refused, tmp_path):
    """One line of what was made; a name, a file in the way and no folder are told in one."""
    status, out, _ = run("export", "denso_vs6556", "--ros2", "denso_description")
    assert (status, out.count("\n")) == (0, 1)
    assert "package denso_description, 9 files" in out
    assert (tmp_path / "denso_description/urdf/denso_vs6556.urdf").exists()
    assert "--force" in refused("export", "ur5", "--ros2", "denso_description")
    assert run("export", "ur5", "--ros2", "denso_description", "--force")[0] == 0
    (tmp_path / "file").touch()
    assert "it is a file" in refused("export", "ur5", "--ros2", "file")
    assert "no such folder" in refused("export", "ur5", "--ros2", "nowhere/arm_description")
    assert "lower-case" in refused("export", "ur5", "--ros2", "UR 5")
    refused("export", "ur5")
