"""One consumer loads one file: run as a program, so that a crash or a hang stays apart.

``python -m dh2urdf.checks.probe MuJoCo robot.urdf`` exits with 1 where the consumer refuses the
file, with its words on stderr; with 0 where it takes it, with any complaint on stderr.
"""

import logging
import os
import sys
import warnings
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

from dh2urdf.checks.findings import Consumer


def _pinocchio(path: str) -> str:
    import numpy as np
    import pinocchio as pin

    model = pin.buildModelFromUrdf(path)
    data = model.createData()
    still = np.zeros(model.nv)
    if not np.isfinite(pin.aba(model, data, pin.neutral(model), still, still)).all():
        _say("forward dynamics (pin.aba) are not finite")
    folders = [str(folder) for folder in Path(path).resolve().parents]
    folders += os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)
    for kind in (pin.GeometryType.VISUAL, pin.GeometryType.COLLISION):
        try:
            pin.buildGeomFromUrdf(model, path, kind, None, folders)
        except ValueError as error:
            _say(f"geometry: {error}")
    return str(pin.__version__)


def _yourdfpy(path: str) -> str:
    import yourdfpy

    logging.basicConfig(format="%(message)s", level=logging.WARNING)
    robot = yourdfpy.URDF.load(path)
    if not robot.validate():
        for error in robot.errors:
            _say(str(error))
    return version("yourdfpy")


def _mujoco(path: str) -> str:
    import mujoco
    import numpy as np

    mujoco.set_mju_user_warning(_say)
    try:
        model = mujoco.MjModel.from_xml_path(path)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
    finally:
        mujoco.set_mju_user_warning(None)
    if not np.isfinite(data.qacc).all():
        _say("accelerations are not finite")
    return str(mujoco.__version__)


def _pybullet(path: str) -> str:
    import pybullet

    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.loadURDF(path, useFixedBase=True, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    finally:
        pybullet.disconnect(client)
    return version("pybullet")


def _drake(path: str) -> str:
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    logging.basicConfig(format="%(message)s", level=logging.WARNING)
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(Path(path))
    plant.Finalize()
    return version("drake")


def _ikpy(path: str) -> str:
    import numpy as np
    from ikpy.chain import Chain
    from lxml import etree

    root = etree.parse(path).getroot()
    children = {child.get("link") for child in root.iterfind("joint/child")}
    bases = [link.get("name") for link in root.iterfind("link") if link.get("name") not in children]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=r"Link .* is of type 'fixed'")
        chain = Chain.from_urdf_file(path, base_elements=bases[:1], symbolic=False)
        tip = chain.forward_kinematics([0.0] * len(chain.links))
    if not np.isfinite(tip).all():
        _say("forward kinematics are not finite")
    return version("ikpy")


PROBES: dict[Consumer, Callable[[str], str]] = {
    Consumer.PINOCCHIO: _pinocchio,
    Consumer.YOURDFPY: _yourdfpy,
    Consumer.MUJOCO: _mujoco,
    Consumer.PYBULLET: _pybullet,
    Consumer.DRAKE: _drake,
    Consumer.IKPY: _ikpy,
}
"""What loads a file in each consumer; returns the consumer's version."""


def probe(name: str, path: str) -> int:
    """Load a file in a consumer; the version goes to stdout, complaints to stderr."""
    try:
        known = PROBES[Consumer(name)](path)
    except BaseException as error:
        _say(f"{type(error).__name__}: {error}")
        return 1
    sys.stdout.write(f"\n{known}\n")
    return 0


def _say(text: str) -> None:
    sys.stderr.write(text.rstrip() + "\n")


if __name__ == "__main__":
    sys.exit(probe(*sys.argv[1:]))
