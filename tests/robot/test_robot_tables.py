"""The tables that ship, each against a referee that does not use the package.

The DH product is that of ``dh_product``, written out from the rows; the referees are URDFs of the
example-robot-data package run by Pinocchio, joint origins of the makers' descriptions, closed forms
and published poses.
"""

import math
import re
from functools import cache
from importlib.metadata import distribution

import numpy as np
import pinocchio as pin
import pytest
from dh_product import dh_frames, rigid, shift, turn
from robot_references import CHAINS, MODIFIED_BY_MAKER, MOVED, PACKAGED, POSES, ROUNDED

import dh2urdf

TRIALS = 100
NAMES = sorted(dh2urdf.list_tables())


def chain_fk(text: str, q) -> np.ndarray:
    """End of a chain of joint origins and axes (see ``robot_references``), (4, 4)."""
    T, moves = np.eye(4), iter(q)
    for item in text.split(";"):
        xyz, rpy, axis = (part.split() for part in item.split("/"))
        T = T @ rigid([float(v) for v in xyz], [float(v) for v in rpy])
        name = axis[0]
        if name == ".":
            continue
        move = -next(moves) if name[0] == "-" else next(moves)
        T = T @ (shift if name.endswith("P") else turn)("xyz".index(name.strip("-P")), move)
    return T


def configurations(n: int, seed: int = 7):
    """Random configurations within half a turn (prismatic joints: within pi metres)."""
    return np.random.default_rng(seed).uniform(-math.pi, math.pi, (TRIALS, n))


load_table = cache(dh2urdf.load_table)


def tool(name: str, q) -> np.ndarray:
    """Pose of tool0 in base_link, by the DH product of the tests."""
    return dh_frames(load_table(name), q)[-1]


class PackagedArm:
    """A serial part of a URDF of example-robot-data, its other joints at rest."""

    def __init__(self, path: str, base: str, tip: str) -> None:
        files = distribution("example-robot-data").files or []
        (urdf,) = (f for f in files if str(f).endswith("/robots/" + path))
        self.model = pin.buildModelFromUrdf(str(urdf.locate()))
        self.data = self.model.createData()
        self.base, self.tip = (self.model.getFrameId(name) for name in (base, tip))
        joint, self.joints = self.model.frames[self.tip].parentJoint, []
        while joint > 0:
            self.joints.insert(0, joint)
            joint = self.model.parents[joint]

    def poses(self, q, *frames: str) -> list[np.ndarray]:
        """Frames (the tip by default) in the base frame."""
        full = pin.neutral(self.model)
        for joint, value in zip(self.joints, q, strict=True):
            i, width = self.model.idx_qs[joint], self.model.nqs[joint]
            full[i : i + width] = [math.cos(value), math.sin(value)] if width == 2 else value
        pin.framesForwardKinematics(self.model, self.data, full)
        ids = [self.model.getFrameId(name) for name in frames] or [self.tip]
        base = self.data.oMf[self.base].inverse()
        return [(base * self.data.oMf[i]).homogeneous for i in ids]


def rpr_point(q):
    l2 = q[1] + 2
    x = 3 * math.cos(q[0]) - l2 * math.sin(q[0]) - 1.5 * math.sin(q[0] + q[2])
    y = 3 * math.sin(q[0]) + l2 * math.cos(q[0]) + 1.5 * math.cos(q[0] + q[2])
    return x, y, 0.0


def planar_point(q, *lengths, z=0.0):
    angles = np.cumsum(q[: len(lengths)])
    return np.dot(lengths, np.cos(angles)), np.dot(lengths, np.sin(angles)), z


def cylindrical_point(q):
    return -math.sin(q[0]) * q[2], math.cos(q[0]) * q[2], 0.4 + q[1]


def stanford_point(q):
    (c1, c2), (s1, s2) = np.cos(q[:2]), np.sin(q[:2])
    return c1 * s2 * q[2] - 0.154 * s1, s1 * s2 * q[2] + 0.154 * c1, 0.412 + c2 * q[2]


CLOSED_FORMS = {
    "planar_rr": (0.0, lambda q: planar_point(q, 1, 0.7)),
    "planar_rrr": (0.0, lambda q: planar_point(q, 1, 0.7, 0.4)),
    "rpr_new_frame": (0.0, rpr_point),
    "rpr_by_inspection": (0.0, rpr_point),
    "cylindrical": (0.0, cylindrical_point),
    "cylindrical_wrist": (0.15, cylindrical_point),
    "gantry": (0.0, lambda q: (q[0], q[1], 1.5 - q[2])),
    "gantry_wrist": (0.1, lambda q: (q[0], q[1], 1.5 - q[2])),
    "omron_cobra600": (0.0, lambda q: planar_point(q, 0.325, 0.275, z=0.387 - q[2])),
    "stanford": (0.263, stanford_point),
}
"""Table -> (distance of the point behind tool0 along its z, closed form of the point)."""

PAIRS = [("stanford", "stanford_modified"), ("abb_irb140", "abb_irb140_modified")]


def test_at_least_thirty_five_tables_ship():
    """The package ships 35 tables or more."""
    assert len(NAMES) >= 35


def test_every_table_has_a_referee_here():
    """No shipped table goes without a check in this module."""
    seen = {*CHAINS, *PACKAGED, *CLOSED_FORMS, *(p[0] for p in POSES), *sum(PAIRS, ())}
    assert set(NAMES) == seen | set(MODIFIED_BY_MAKER)


@pytest.mark.parametrize("name", NAMES)
def test_table_says_source_check_and_limits(name):
    """Every table carries its name, source, a check with a figure, and limits of every joint."""
    table = load_table(name)
    assert table.name == name
    assert table.source
    assert re.search(r"\d", table.checked)
    for row in table.joints:
        assert row.mimic or row.lower < row.upper


@pytest.mark.parametrize("name", sorted(PACKAGED))
def test_table_equals_packaged_urdf(name):
    """The DH product and the URDF of example-robot-data agree from base to tip."""
    *ends, roll, pitch, yaw, bound = PACKAGED[name].split()
    T_tip_tool = rigid((0, 0, 0), np.radians([float(roll), float(pitch), float(yaw)]))
    arm = PackagedArm(*ends)
    for q in configurations(len(arm.joints)):
        (T_base_tip,) = arm.poses(q)
        np.testing.assert_allclose(
            tool(name, q), T_base_tip @ T_tip_tool, rtol=0, atol=float(bound)
        )


def test_panda_links_are_its_dh_frames():
    """Modified DH frame i of the Franka table is the URDF's link i, for every i."""
    arm = PackagedArm(*PACKAGED["franka_fer"].split()[:3])
    links = [f"panda_link{i}" for i in range(9)]
    for q in configurations(7):
        ours = dh_frames(load_table("franka_fer"), q)
        np.testing.assert_allclose(ours, arm.poses(q, *links), rtol=0, atol=1e-13)


def test_ur5_links_stand_still_in_their_dh_frames():
    """Every moving link of the UR5 URDF has a constant pose in the DH frame of its row."""
    arm = PackagedArm(*PACKAGED["ur5"].split()[:3])
    links = ["shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"]
    links = [f"{link}_link" for link in links]
    offsets = []
    for q in configurations(6):
        ours = dh_frames(load_table("ur5"), q)[1:7]
        theirs = arm.poses(q, *links)
        offsets.append([np.linalg.solve(a, b) for a, b in zip(ours, theirs, strict=True)])
    assert np.ptp(offsets, axis=0).max() < 1e-10


@pytest.mark.parametrize("name", sorted(CHAINS))
def test_table_equals_makers_joint_origins(name):
    """The DH product and the maker's chain of joint origins agree to the source's rounding."""
    chain, bound = CHAINS[name], ROUNDED.get(name, 1e-14)
    for q in configurations(load_table(name).n):
        np.testing.assert_allclose(tool(name, q), chain_fk(chain, q), rtol=0, atol=bound)


@pytest.mark.parametrize("name", sorted(MOVED))
def test_robot_takes_what_the_controller_shows(name):
    """Of coupled arms the robot's FK is that of the maker's chain, its joints moved as said."""
    robot, bound = dh2urdf.Robot.from_dh(load_table(name)), ROUNDED.get(name, 1e-14)
    assert {name for name in NAMES if load_table(name).joint_map} == set(MOVED)
    for q in configurations(robot.n):
        expected = chain_fk(CHAINS[name], MOVED[name](q))
        np.testing.assert_allclose(robot.fk(q), expected, rtol=0, atol=bound)


def test_pendant_of_a_fanuc():
    """ros-industrial/fanuc_experimental, issue 17: the pendant's J3 and the joint that ROS told."""
    robot = dh2urdf.Robot.from_dh("fanuc_r1000ia80f")
    q = np.radians([15.7193, 31.3242, -33.342, 73.64, -101.1251, -31.149])
    joint = np.degrees(robot.chain_configuration(q)[2])
    assert abs(joint - np.degrees(-0.035214900970458984)) < 1e-3


@pytest.mark.parametrize("name", sorted(CLOSED_FORMS))
def test_table_equals_closed_form(name):
    """The end point or wrist centre is where the closed form puts it."""
    behind, point = CLOSED_FORMS[name]
    for q in configurations(load_table(name).n):
        T = tool(name, q)
        np.testing.assert_allclose(T[:3, 3] - behind * T[:3, 2], point(q), rtol=0, atol=1e-14)


@pytest.mark.parametrize(("name", "q", "xyz"), POSES)
def test_table_reaches_published_pose(name, q, xyz):
    """tool0 stands where the maker or the text book says it does."""
    np.testing.assert_allclose(tool(name, np.radians(q))[:3, 3], xyz, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("standard", "modified"), PAIRS)
def test_two_conventions_describe_one_arm(standard, modified):
    """The standard and the modified table of an arm have the same base, tool and q."""
    for q in configurations(6):
        np.testing.assert_allclose(tool(standard, q), tool(modified, q), rtol=0, atol=1e-14)


@pytest.mark.parametrize("name", sorted(MODIFIED_BY_MAKER))
def test_table_equals_makers_modified_table(name):
    """UFACTORY's standard and modified tables agree."""
    rows = [[float(v) for v in r.split()] for r in MODIFIED_BY_MAKER[name].split(";")]
    for q in configurations(len(rows)):
        T = np.eye(4)
        for angle, (theta, d, alpha, a) in zip(q, rows, strict=True):
            T = T @ turn(0, math.radians(alpha)) @ shift(0, a / 1000)
            T = T @ turn(2, angle + math.radians(theta)) @ shift(2, d / 1000)
        np.testing.assert_allclose(tool(name, q), T, rtol=0, atol=1e-14)


def test_rpr_remedies_share_a_point_and_differ_by_a_quarter_turn():
    """Both remedies of the notes put frame 3 at one point, turned by 90 deg about z."""
    for q in configurations(3):
        by_hand, new = tool("rpr_by_inspection", q), tool("rpr_new_frame", q)
        np.testing.assert_allclose(by_hand @ turn(2, math.pi / 2), new, rtol=0, atol=1e-14)


def test_ur5_base_height_is_the_makers():
    """d1 of the UR5 is 0.089159 m, not the 0.089459 that circulates."""
    assert load_table("ur5").rows[0].d == 0.089159


@pytest.mark.parametrize("name", ["puma560", "puma560_modified"])
def test_published_inertias_are_those_of_rigid_bodies(name):
    """Every tensor carried is positive and keeps the triangle inequality."""
    carried = [row for row in load_table(name).joints if row.inertia is not None]
    assert len(carried) == 4
    for row in carried:
        ixx, ixy, ixz, iyy, iyz, izz = row.inertia
        m = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
        assert m[0] > 0
        assert m[0] + m[1] >= m[2]
