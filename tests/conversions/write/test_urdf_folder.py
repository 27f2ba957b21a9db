"""The files in urdf/: made by one command from the tables, and taken by every consumer."""

import math
import shutil
import subprocess
import sys
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
import pytest
import yourdfpy
from dh_product import dh_frames, difference
from example_robots import configuration, placed

import dh2urdf
from dh2urdf.conversions.write.verify import random_configurations

FOLDER = Path(__file__).parents[3] / "urdf"
NAMES = dh2urdf.list_tables()

every_file = pytest.mark.parametrize("name", NAMES)


def path_of(name):
    """The shipped URDF of a table."""
    return str(FOLDER / f"{name}.urdf")


def posed(name, seed=0):
    """The table, Pinocchio's model of its file, and a random q by the names of joints."""
    table = dh2urdf.load_table(name)
    q = random_configurations(table, 1, seed)[0]
    if table.joint_map is not None:
        robot = dh2urdf.Robot.from_dh(table)
        q = robot.chain_configuration(robot.random_configuration(seed))
    by_name = dict(zip(table.joint_names, q, strict=True))
    return table, pin.buildModelFromUrdf(path_of(name)), by_name


def test_folder_is_what_the_command_writes(tmp_path, run):
    """`dh2urdf convert --shipped --out-dir urdf` gives these files, byte for byte, and no other."""
    assert run("convert", "--shipped", "--out-dir", tmp_path)[0] == 0
    written = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    shipped = {p.name: p.read_bytes() for p in FOLDER.glob("*.urdf")}
    assert sorted(written) == sorted(shipped) == [f"{name}.urdf" for name in NAMES]
    assert [name for name in written if written[name] != shipped[name]] == []


@every_file
def test_table_inside_is_the_shipped_one(name):
    """The table in each file equals the one that ships."""
    assert dh2urdf.load_table(path_of(name)) == dh2urdf.load_table(name)


@every_file
def test_frames_equal_the_dh_product(name):
    """tool0 and every dh_i, placed by Pinocchio, equal the DH product to 1e-12."""
    table, model, q = posed(name, seed=3)
    names = [*(f"dh_{i}" for i in range(table.n + 1)), "tool0"]
    found = [T.homogeneous for T in placed(model, q, *names)]
    assert difference(found, dh_frames(table, list(q.values()))) <= 1e-12 * max(1.0, table.length)


@every_file
def test_pinocchio_can_move_it(name, capfd):
    """It loads in silence; joint space inertia is positive definite, ABA finite."""
    _, model, q = posed(name)
    data, q_model = model.createData(), configuration(model, q)
    M = pin.crba(model, data, q_model)
    M = np.triu(M) + np.triu(M, 1).T
    assert np.linalg.eigvalsh(M)[0] > 0
    v, tau = np.ones(model.nv), np.zeros(model.nv)
    a = pin.aba(model, data, q_model, v, tau)
    assert np.isfinite(a).all()
    np.testing.assert_allclose(
        pin.rnea(model, data, q_model, v, a), tau, atol=1e-9 * np.abs(M @ a).max()
    )
    pin.buildGeomFromUrdf(model, path_of(name), pin.GeometryType.VISUAL)
    assert capfd.readouterr() == ("", "")


@every_file
def test_check_urdf_accepts_it(name):
    """urdfdom's own checker parses it and has nothing to say on stderr."""
    program = shutil.which("check_urdf", path=Path(sys.executable).parent)
    assert program, "check_urdf comes with pin"
    run = subprocess.run([program, path_of(name)], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    assert "Successfully Parsed XML" in run.stdout


@every_file
def test_yourdfpy_validates_it(name, caplog, capfd):
    """yourdfpy finds nothing to complain of and places tool0 where the DH product does."""
    robot = yourdfpy.URDF.load(path_of(name))
    assert (robot.validate(), robot.errors) == (True, [])
    assert caplog.records == []
    assert capfd.readouterr() == ("", "")
    table, _, q = posed(name)
    robot.update_cfg({joint: q[joint] for joint in robot.actuated_joint_names})
    tip = robot.get_transform("tool0", "base_link")
    assert difference(tip, dh_frames(table, q.values())[-1]) <= 1e-12 * max(1.0, table.length)


@every_file
def test_mujoco_places_every_body_as_pinocchio_does(name, capfd, tmp_path, monkeypatch):
    """MuJoCo compiles it without a warning, keeps every link, and agrees on every pose to 1e-12."""
    monkeypatch.chdir(tmp_path)
    said = []
    mujoco.set_mju_user_warning(said.append)
    try:
        m = mujoco.MjModel.from_xml_path(path_of(name))
        d = mujoco.MjData(m)
        _, model, q = posed(name)
        for joint, value in q.items():
            d.qpos[m.joint(joint).qposadr[0]] = value
        mujoco.mj_forward(m, d)
    finally:
        mujoco.set_mju_user_warning(None)
    assert said == []
    assert capfd.readouterr() == ("", "")
    assert not any(warning.number for warning in d.warning)
    assert list(tmp_path.iterdir()) == []
    links = {f.name for f in model.frames if f.type == pin.FrameType.BODY}
    bodies = [m.body(i).name for i in range(1, m.nbody)]
    assert set(bodies) == links - {"universe"}
    for k, pose in enumerate(placed(model, q, *bodies), 1):
        assert difference(d.xpos[k], pose.translation) <= 1e-12
        assert difference(d.xmat[k].reshape(3, 3), pose.rotation) <= 1e-12


@pytest.mark.exhaustive
@every_file
def test_pybullet_loads_it(name, capfd):
    """Its only notice is that of base_link, massless for KDL; tool0 stands where it should."""
    pybullet = pytest.importorskip("pybullet")
    table, _, q = posed(name)
    client = pybullet.connect(pybullet.DIRECT)
    try:
        capfd.readouterr()
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE
        arm = pybullet.loadURDF(path_of(name), useFixedBase=True, flags=flags)
        out, err = capfd.readouterr()
        infos = [pybullet.getJointInfo(arm, i) for i in range(pybullet.getNumJoints(arm))]
        joints = {info[1].decode(): info[0] for info in infos}
        links = {info[12].decode(): info[0] for info in infos}
        for joint, value in q.items():
            pybullet.resetJointState(arm, joints[joint], value)
        state = pybullet.getLinkState(arm, links["tool0"], computeForwardKinematics=True)
    finally:
        pybullet.disconnect(client)
    assert (out + err).count("b3Warning") == 2
    assert "No inertial data for link" in out + err
    assert (out + err).rstrip().endswith("base_link")
    assert "b3Error" not in out + err
    reach = max(1.0, table.length)
    assert difference(state[4], dh_frames(table, q.values())[-1][:3, 3]) <= 1e-6 * reach


@pytest.mark.exhaustive
@every_file
def test_drake_loads_it(name, caplog, capfd):
    """Drake has no remark, even parsing strictly, and places tool0 to 1e-12."""
    pytest.importorskip("pydrake")
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    plant = MultibodyPlant(0.0)
    parser = Parser(plant)
    parser.SetStrictParsing()
    (arm,) = parser.AddModels(path_of(name))
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base_link"))
    plant.Finalize()
    assert caplog.records == []
    assert capfd.readouterr() == ("", "")
    table, _, q = posed(name)
    context = plant.CreateDefaultContext()
    q_plant = np.empty(plant.num_positions())
    for joint, value in q.items():
        q_plant[plant.GetJointByName(joint, arm).position_start()] = value
    plant.SetPositions(context, q_plant)
    tip = plant.GetFrameByName("tool0").CalcPoseInWorld(context).GetAsMatrix4()
    assert difference(tip, dh_frames(table, q.values())[-1]) <= 1e-12 * max(1.0, table.length)


@pytest.mark.exhaustive
@every_file
def test_ikpy_walks_to_the_tool(name):
    """Given only the base link, ikpy finds the whole chain to tool0, and its FK agrees."""
    chain_of = pytest.importorskip("ikpy.chain").Chain.from_urdf_file
    table = dh2urdf.load_table(name)
    mask = [False, *[True] * table.n, False]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        chain = chain_of(path_of(name), base_elements=["base_link"], active_links_mask=mask)
    assert [link.name for link in chain.links][1:] == [*table.joint_names, "tool0_fixed"]
    q = random_configurations(table, 1)[0]
    tip = chain.forward_kinematics([0.0, *q, 0.0])
    assert difference(tip, dh_frames(table, q)[-1]) <= 1e-9 * max(1.0, table.length)


def test_limits_in_the_files_are_those_of_the_tables():
    """Pinocchio reads the limits of the tables; +-2 pi and the reach where a table has none.

    Joints that follow others without limits of their own have what these make of theirs.
    """
    for name in NAMES:
        table = dh2urdf.load_table(name)
        model = pin.buildModelFromUrdf(path_of(name))
        each = zip(table.joint_names, table.joints, table.joint_ranges, strict=True)
        for joint, row, (low, high) in each:
            if row.mimic is not None and math.isinf(low):
                continue
            k = model.joints[model.getJointId(joint)].idx_q
            far = 2 * math.pi if row.joint_type == "revolute" else table.length or 1.0
            assert model.lowerPositionLimit[k] == (-far if low == -math.inf else low)
            assert model.upperPositionLimit[k] == (far if high == math.inf else high)
