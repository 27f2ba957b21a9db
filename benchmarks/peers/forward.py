"""Forward kinematics of the arms, ours and the peers', each by its documented fast path."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.arms import Arm
from benchmarks.contestant import FKContestant
from benchmarks.marker import at_work
from benchmarks.results import Results
from dh2urdf import Robot, urdf_text

__all__ = ["forward_contestants"]

Array = NDArray[np.float64]


def forward_contestants(arm: Arm, results: Results) -> Iterator[FKContestant]:
    """All that can place this arm's tool; a missing package is named in ``left_out``."""
    for name, build in BUILDERS.items():
        if name in results.excluded:
            continue
        at_work(name)
        try:
            contestant = build(arm)
        except ImportError as error:
            results.left_out[name] = f"not installed ({error})"
            continue
        if contestant is not None:
            yield contestant


def _ours(arm: Arm) -> FKContestant:
    robot = Robot.from_dh(arm.table)
    return FKContestant("dh2urdf", robot.fk, robot.fk)


def _pinocchio(arm: Arm) -> FKContestant:
    """The documented pair of calls, in a Python loop for many configurations."""
    import pinocchio as pin

    model = pin.buildModelFromXML(urdf_text(arm.table))
    data, tool = model.createData(), model.getFrameId("tool0")

    def one(q: Array) -> Array:
        pin.forwardKinematics(model, data, q)
        T: Array = pin.updateFramePlacement(model, data, tool).homogeneous
        return T

    def many(q: Array) -> Array:
        out = np.empty((len(q), 4, 4))
        for i, qi in enumerate(q):
            pin.forwardKinematics(model, data, qi)
            out[i] = pin.updateFramePlacement(model, data, tool).homogeneous
        return out

    return FKContestant("Pinocchio loop", one, many)


def _eaik(arm: Arm) -> FKContestant | None:
    from benchmarks.peers.eaik import Eaik

    if arm.held:
        return None
    return FKContestant("EAIK", Eaik(arm).robot.fwdKin)


def _py_ikgeo(arm: Arm) -> FKContestant | None:
    from benchmarks.peers.py_ikgeo import PyIkgeo

    if arm.n != 6:
        return None
    peer = PyIkgeo(arm)

    def to_poses(answer: Any) -> Array:
        T: Array = np.array(answer.as_matrix())
        T[..., :3, :3] = T[..., :3, :3] @ peer.form.R_tool
        return T

    robot = peer.robot
    return FKContestant("py-ikgeo", robot.forward, robot.batch_forward, to_poses=to_poses)


def _py_opw(arm: Arm) -> FKContestant | None:
    from benchmarks.peers.opw_models import MODELS
    from benchmarks.peers.py_opw import PyOpw

    if arm.key not in MODELS:
        return None
    robot = PyOpw(arm).robot
    return FKContestant(
        "py-opw", robot.forward, robot.batch_forward, to_poses=lambda answer: answer.as_matrix()
    )


def _ur_analytic(arm: Arm) -> FKContestant | None:
    if arm.key != "ur5":
        return None
    from ur_analytic_ik import ur5

    return FKContestant("ur-analytic-ik", lambda q: ur5.forward_kinematics(*q))


def _toolbox(arm: Arm) -> FKContestant:
    """The toolbox's elementary transforms, evaluated in C: its fastest way."""
    from benchmarks.peers.toolbox import elementary_transforms

    ets = elementary_transforms(arm)
    return FKContestant("roboticstoolbox", ets.eval, ets.eval)


def _ikpy(arm: Arm) -> FKContestant:
    from ikpy.chain import Chain

    elements = ["base_link"]
    for i, row in enumerate(arm.rows, 1):
        elements += [row.name, f"link_{i}"]
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = Path(folder, "arm.urdf")
        path.write_text(urdf_text(arm.table))
        chain = Chain.from_urdf_file(str(path), base_elements=[*elements, "tool0_fixed"])
    pad = len(chain.links) - arm.n - 1
    return FKContestant(
        "ikpy", chain.forward_kinematics, encode=lambda q: np.pad(q, ((0, 0), (1, pad)))
    )


def _frankik(arm: Arm) -> FKContestant | None:
    """Its end effector is the hand: 0.1034 m beyond the flange, turned by -45 degrees."""
    if arm.key != "franka_fer":
        return None
    import frankik

    c = np.sqrt(0.5)
    T_hand_flange = np.array([[c, -c, 0, 0], [c, c, 0, 0], [0, 0, 1, -0.1034], [0, 0, 0, 1]])
    return FKContestant("frankik", frankik.fk, to_poses=lambda T: np.asarray(T) @ T_hand_flange)


BUILDERS: dict[str, Callable[[Arm], FKContestant | None]] = {
    "dh2urdf": _ours,
    "Pinocchio loop": _pinocchio,
    "EAIK": _eaik,
    "py-ikgeo": _py_ikgeo,
    "py-opw": _py_opw,
    "ur-analytic-ik": _ur_analytic,
    "frankik": _frankik,
    "roboticstoolbox": _toolbox,
    "ikpy": _ikpy,
}
