"""Robots of the package example-robot-data, and their links placed by Pinocchio."""

import math
from pathlib import Path

import pinocchio as pin

ROBOTS = Path(pin.__file__).parents[4] / "share/example-robot-data/robots"
UR5 = ROBOTS / "ur_description/urdf/ur5_robot.urdf"
PANDA = ROBOTS / "panda_description/urdf/panda.urdf"
TIAGO = ROBOTS / "tiago_description/robots/tiago.urdf"
ANYMAL = ROBOTS / "anymal_b_simple_description/robots/anymal.urdf"


def example(name):
    """Path of the URDF of some name."""
    return str(next(ROBOTS.rglob(name)))


def configuration(model, q):
    """A configuration of a model: values by the names of joints, the other joints neutral."""
    config = pin.neutral(model)
    for name, value in q.items():
        joint = model.joints[model.getJointId(name)]
        values = [math.cos(value), math.sin(value)] if joint.nq == 2 else value
        config[joint.idx_q : joint.idx_q + joint.nq] = values
    return config


def placed(model, q, *links):
    """Poses of links of a model (`pin.SE3`), values q by the names of joints."""
    data = model.createData()
    pin.framesForwardKinematics(model, data, configuration(model, q))
    return [data.oMf[model.getFrameId(name, pin.FrameType.BODY)] for name in links]


def fk_between(model, base, tip, q):
    """``T_base_tip`` of a model, values q by the names of joints, shape (4, 4)."""
    oMb, oMt = placed(model, q, base, tip)
    return oMb.actInv(oMt).homogeneous
