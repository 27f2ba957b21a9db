"""The written MJCF is the table, as MuJoCo compiles it."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from dh_product import dh_frames, difference
from hypothesis import given, settings
from strategies import FACTORY, tables

import dh2urdf
from dh2urdf.conversions.write import UrdfOptions, verified_mjcf, write_mjcf
from dh2urdf.conversions.write.table_file import random_configurations
from dh2urdf.exceptions import OutputExistsError, VerificationError


def sites(text, q):
    """Poses of all sites by name, with the joints in the file's order at q."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    poses = {}
    for k in range(model.nsite):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = data.site_xmat[k].reshape(3, 3), data.site_xpos[k]
        poses[model.site(k).name] = T
    return poses


@settings(max_examples=150)
@given(tables())
def test_mujoco_places_every_frame_of_the_dh_product(table):
    """Sites dh_0 ... dh_n and tool0 stand where the product of the rows puts them, to 1e-12."""
    text, error, _ = verified_mjcf(table)
    reach = max(1.0, 10 * table.n)
    assert error <= 1e-12 * reach
    q = random_configurations(table, 1, seed=5)[0]
    placed = sites(text, q)
    names = [*(f"dh_{i}" for i in range(table.n + 1)), "tool0"]
    found = [placed[name] for name in names]
    assert difference(found, dh_frames(table, q)) <= 1e-12 * reach


@pytest.mark.parametrize("name", ["puma560", "franka_fer", "stanford", "rpr_by_inspection"])
def test_mujoco_weighs_the_arm_as_pinocchio_weighs_its_urdf(name):
    """Mass matrix and the forces of gravity and speed agree: masses, tensors, axes and limits."""
    table = dh2urdf.load_table(name)
    model = mujoco.MjModel.from_xml_string(verified_mjcf(table)[0])
    data, M = mujoco.MjData(model), np.zeros((table.n, table.n))
    other = pin.buildModelFromXML(dh2urdf.urdf_text(table))
    order = [other.joints[other.getJointId(joint)].idx_q for joint in table.joint_names]
    at, scratch = np.argsort(order), other.createData()
    for q in random_configurations(table, 5, seed=3):
        v = np.linspace(-1.0, 1.0, table.n)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, M)
        forces = pin.nle(other, scratch, q[at], v[at])[order]
        masses = pin.crba(other, scratch, q[at])[np.ix_(order, order)]
        assert data.qfrc_bias == pytest.approx(forces, rel=1e-9, abs=1e-9 * abs(forces).max())
        assert pytest.approx(masses, rel=1e-9, abs=1e-9 * abs(masses).max()) == M


@pytest.mark.parametrize("name", ["puma560", "franka_fer", "gantry_wrist", "stanford"])
def test_mujoco_draws_what_it_draws_of_the_urdf(name):
    """Shapes, sizes, places and colours are those of MuJoCo's own import of the URDF."""

    def drawn(text):
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        for k, joint in enumerate(dh2urdf.load_table(name).joint_names):
            data.qpos[model.joint(joint).qposadr[0]] = 0.1 * k - 0.3
        mujoco.mj_kinematics(model, data)
        colours = [
            model.geom_rgba[g] if m < 0 else model.mat_rgba[m]
            for g, m in enumerate(model.geom_matid)
        ]
        parts = data.geom_xpos, model.geom_type[:, None], model.geom_size, colours, data.geom_xmat
        return np.array(sorted(np.hstack(parts).round(9).tolist()))

    assert np.array_equal(drawn(verified_mjcf(name)[0]), drawn(dh2urdf.urdf_text(name)))


def test_limits_efforts_and_losses_are_those_of_the_table():
    """What an MJCF has a place for stands there; velocities are in the table that it carries."""
    row = dh2urdf.DHRow(0, 0.3, 0.2, 0.1, lower=-1, upper=2, velocity=3, effort=40)
    slide = dh2urdf.DHRow(0.1, 0, 0, 0, "prismatic", lower=0, upper=0.5, damping=7, friction=0.5)
    table = dh2urdf.DHTable((row, slide), "modified", name="two")
    text, _, warnings = verified_mjcf(table)
    model = mujoco.MjModel.from_xml_string(text)
    assert warnings == ()
    assert model.jnt_range.tolist() == [[-1, 2], [0, 0.5]]
    assert model.jnt_actfrcrange.tolist() == [[-40, 40], [0, 0]]
    assert model.dof_damping.tolist() == [0, 7]
    assert model.dof_frictionloss.tolist() == [0, 0.5]


@pytest.mark.parametrize("table", [FACTORY, "gantry_wrist", "kuka_iiwa14"])
def test_options_of_the_urdf_hold_for_the_mjcf(table):
    """Without DH frames only the tool is a site; bodies that collide are doubled."""
    text, _, _ = verified_mjcf(table, UrdfOptions(dh_frames=False, collision=True))
    model = mujoco.MjModel.from_xml_string(text)
    assert [model.site(k).name for k in range(model.nsite)] == ["tool0"]
    assert set(model.geom_group.tolist()) == {2, 3}
    assert sum(model.geom_contype > 0) == model.ngeom // 2


def test_a_mjcf_is_written_over_only_where_it_is_ours(tmp_path):
    """A file of this package is replaced, another's is not."""
    path = tmp_path / "arm.xml"
    for _ in range(2):
        assert write_mjcf("planar_rr", path).max_error < 1e-12
    path.write_text("<mujoco/>")
    with pytest.raises(OutputExistsError, match="was not written by dh2urdf"):
        write_mjcf("planar_rr", path)
    assert path.read_text() == "<mujoco/>"


def test_a_mjcf_that_differs_is_not_written(tmp_path, monkeypatch):
    """A wrong place of a body shows in MuJoCo's own frames, and nothing is written."""
    from dh2urdf.conversions.write import mjcf_file

    wrong = {"pos": "0 0 0.1"}
    monkeypatch.setattr(mjcf_file, "_place", lambda _: wrong)
    with pytest.raises(VerificationError, match="differs from the DH product by"):
        write_mjcf("puma560", tmp_path / "arm.xml")
    assert not list(tmp_path.iterdir())
