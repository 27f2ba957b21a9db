"""Pinocchio's forward kinematics of a source, against which an extracted table is checked.

A URDF is read a second time by Pinocchio's own parser, from the text of the file; a chain of
typed axes goes through the exponentials of its screws. Neither shares a product with the
extraction.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pinocchio as pin

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.dh import DHConvention, DHTable, JointType
from dh2urdf.transforms import Array

FAR = 100.0
"""Limits beyond this many arm's lengths are a way to say that there are none."""

Referee = Callable[[Array], Array]
"""From configurations (m, n) to ``T_base_tip`` (m, 4, 4)."""


def model_referee(model: pin.Model, base: int, tip: int, names: Sequence[str]) -> Referee:
    """FK between two frames of a model (indices), by the names of the joints in the chain."""
    joints = [model.joints[list(model.names).index(name, 1)] for name in names]
    circles = [k for k, joint in enumerate(joints) if joint.nq == 2]
    return addressed_referee(model, base, tip, [joint.idx_q for joint in joints], circles)


def addressed_referee(
    model: pin.Model, base: int, tip: int, indices: Sequence[int], circles: Sequence[int] = ()
) -> Referee:
    """FK between two frames of a model, by the places of the chain's joints in its q.

    ``circles`` are joints of the chain that the model keeps as cosine and sine.
    """
    data = model.createData()

    def poses(qs: Array) -> Array:
        out = np.empty((len(qs), 4, 4))
        config = pin.neutral(model)
        for k, q in enumerate(qs):
            config[indices] = q
            for i in circles:
                config[indices[i] : indices[i] + 2] = math.cos(q[i]), math.sin(q[i])
            pin.forwardKinematics(model, data, config)
            oMb = pin.updateFramePlacement(model, data, base).copy()
            out[k] = oMb.actInv(pin.updateFramePlacement(model, data, tip)).homogeneous
        return out

    return poses


def screw_referee(chain: SerialChain) -> Referee:
    """FK of a chain as a product of exponentials: ``exp(S_1 q_1) ... exp(S_n q_n) M``."""
    screws = []
    for axis, point, slides in zip(chain.axes, chain.points, chain.prismatic, strict=True):
        linear = axis if slides else -np.cross(axis, point)
        screws.append(np.concatenate([linear, np.zeros(3) if slides else axis]))
    M = pin.SE3(np.array(chain.tool))

    def poses(qs: Array) -> Array:
        out = np.empty((len(qs), 4, 4))
        for k, q in enumerate(qs):
            T = pin.SE3.Identity()
            for screw, value in zip(screws, q, strict=True):
                T = T * pin.exp6(pin.Motion(screw * value))
            out[k] = (T * M).homogeneous
        return out

    return poses


def configurations(chain: SerialChain, count: int, size: float) -> Array:
    """Configurations to compare at, shape (count, n): q = 0 and random ones.

    Full turns whatever the limits; sliding joints within theirs, or an arm's length each way.
    """
    rng = np.random.default_rng(20170829)
    reach = np.where(chain.prismatic, size, np.pi)
    low = np.where(chain.prismatic & (np.abs(chain.lower) <= FAR * size), chain.lower, -reach)
    high = np.where(chain.prismatic & (np.abs(chain.upper) <= FAR * size), chain.upper, reach)
    qs = rng.uniform(low, np.maximum(low, high), size=(count, chain.n))
    qs[0] = 0.0
    return qs


def turn_slide(theta: Array, d: Array) -> Array:
    """``Rot_z(theta) Trans_z(d)`` of many angles [rad] and lengths [m], shape (m, 4, 4)."""
    out = np.tile(np.eye(4), (len(theta), 1, 1))
    out[:, 0, 0] = out[:, 1, 1] = np.cos(theta)
    out[:, 1, 0] = np.sin(theta)
    out[:, 0, 1] = -out[:, 1, 0]
    out[:, 2, 3] = d
    return out


def table_poses(table: DHTable, qs: Array) -> Array:
    """``T_base_tool`` of a table at many configurations: the DH product, shape (m, 4, 4)."""
    T = np.broadcast_to(table.base.matrix, (len(qs), 4, 4))
    columns = iter(np.asarray(qs, float).T)
    for row in table.rows:
        if not row.is_joint:
            T = T @ row.transform(0.0, table.convention)
            continue
        q = row.sign * next(columns)
        slides = row.joint_type is JointType.PRISMATIC
        theta, d = (row.theta + 0 * q, row.d + q) if slides else (row.theta + q, row.d + 0 * q)
        motion = turn_slide(theta, d)
        X = tf.trans(row.a, 0, 0) @ tf.rot_x(row.alpha)
        T = T @ (motion @ X if table.convention is DHConvention.STANDARD else X @ motion)
    return T @ table.tool.matrix
