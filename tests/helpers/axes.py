"""Random serial chains for Hypothesis, and their forward kinematics by Pinocchio's screws."""

import math

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import strategies as st

from dh2urdf.chain import SerialChain
from dh2urdf.dh import DHConvention, JointType

BOTH = pytest.mark.parametrize("convention", list(DHConvention))

SMALL_ANGLES = st.sampled_from([10.0**-k for k in range(3, 13)])
LENGTHS = st.one_of(st.just(0.0), st.floats(-1, 1), st.sampled_from([0.425, 1e-9, -0.09]))
ANGLES = st.one_of(
    st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi, 1.5708]), st.floats(-3.1, 3.1)
)


def pose(axis, angle, xyz):
    """A rigid pose: rotation about any axis, then a translation."""
    turn = pin.AngleAxis(angle, np.asarray(axis, float) / np.linalg.norm(axis))
    return pin.SE3(turn.matrix(), np.array(xyz, float)).homogeneous


@st.composite
def any_pose(draw):
    axis = draw(st.tuples(*[st.floats(0.1, 1) for _ in range(3)]))
    return pose(axis, draw(ANGLES), draw(st.tuples(LENGTHS, LENGTHS, LENGTHS)))


def twist(alpha, beta):
    return pose((1, 0, 0), alpha, (0, 0, 0)) @ pose((0, 1, 0), beta, (0, 0, 0))


@st.composite
def special_link(draw):
    """A pair of axes that is parallel, nearly so, intersecting or one line, either way round."""
    kind = draw(st.sampled_from(["parallel", "near", "intersecting", "collinear", "touching"]))
    before = pose((0, 0, 1), draw(ANGLES), (0, 0, draw(LENGTHS)))
    after = pose((0, 0, 1), draw(ANGLES), (0, 0, draw(LENGTHS)))
    round_about = draw(st.sampled_from([0.0, math.pi]))
    if kind == "parallel":
        middle = pose((1, 0, 0), round_about, (draw(LENGTHS), 0, 0))
    elif kind == "near":
        tilt, direction = draw(SMALL_ANGLES), draw(ANGLES)
        middle = twist(tilt * math.cos(direction), tilt * math.sin(direction))
        middle = middle @ pose((1, 0, 0), round_about, (0, 0, 0))
        middle[:3, 3] = draw(LENGTHS), draw(LENGTHS), 0
    elif kind == "intersecting":
        middle = pose((1, 0, 0), draw(ANGLES), (0, 0, 0))
    elif kind == "touching":
        middle = pose((1, 0, 0), draw(ANGLES), (draw(SMALL_ANGLES), 0, 0))
    else:
        middle = pose((1, 0, 0), round_about, (0, 0, 0))
    return before @ middle @ after


@st.composite
def chains(draw, max_joints=7, revolute_only=False):
    """A chain whose links are special once in three or more, base and tool anywhere."""
    n = draw(st.integers(1, max_joints))
    links = [draw(any_pose())]
    for _ in range(n):
        special = draw(st.integers(0, 2)) == 0
        links.append(draw(special_link() if special else any_pose()))
    kinds = [JointType.REVOLUTE, JointType.REVOLUTE, JointType.PRISMATIC]
    types = tuple(
        JointType.REVOLUTE if revolute_only else draw(st.sampled_from(kinds)) for _ in range(n)
    )
    return SerialChain(
        np.stack(links),
        types,
        tuple(f"joint_{i + 1}" for i in range(n)),
        np.full(n, -math.inf),
        np.full(n, math.inf),
    )


def screw_fk(chain, q):
    """FK by Pinocchio's exponentials of the screws at q = 0."""
    frames, T = [], np.eye(4)
    for link in chain.links:
        T = T @ link
        frames.append(T)
    M = pin.SE3.Identity()
    for frame, kind, value in zip(frames, chain.joint_types, q, strict=False):
        axis, point = frame[:3, 2], frame[:3, 3]
        turns = kind == JointType.REVOLUTE
        linear = np.cross(point, axis) if turns else axis
        angular = axis if turns else np.zeros(3)
        M = M * pin.exp6(pin.Motion(linear * value, angular * value))
    return (M * pin.SE3(frames[-1])).homogeneous


def line_distance(point, axis, other_point, other_axis):
    """How far two lines are from being one: offset of a point [m] and sine of the angle."""
    gap = np.asarray(other_point) - point
    return (np.linalg.norm(gap - axis * (gap @ axis)), np.linalg.norm(np.cross(axis, other_axis)))
