"""Mass properties survive the way into a URDF, and files hold only bodies that could exist."""

from dataclasses import replace

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from newton_euler import joint_torques

import dh2urdf
from dh2urdf.conversions.write.inertia import Inertial, balanced, tensor, why_impossible
from dh2urdf.conversions.write.urdf_elements import urdf_text_and_warnings

AS_PUBLISHED = dh2urdf.UrdfOptions(balance_inertia=False)


def puma560():
    """Puma 560 with the dynamics of Corke and Armstrong-Helouvry, ICRA 1994.

    Published as they are: the tensors of links 1 and 3 belong to no body. Link 1 was published
    without mass; it has 13 kg on joint 1's axis here, where they change no torque.
    """
    shipped = dh2urdf.load_table("puma560")
    dynamics = [
        (13.0, (0, -0.2, 0), (0, 0.35, 0)),
        (17.4, (-0.3638, 0.006, 0.2275), (0.13, 0.524, 0.539)),
        (4.8, (-0.0203, -0.0141, 0.070), (0.066, 0.086, 0.0125)),
        (0.82, (0, 0.019, 0), (1.8e-3, 1.3e-3, 1.8e-3)),
        (0.34, (0, 0, 0), (0.3e-3, 0.4e-3, 0.3e-3)),
        (0.09, (0, 0, 0.032), (0.15e-3, 0.15e-3, 0.04e-3)),
    ]
    rows = tuple(
        replace(row, mass=mass, com=com, inertia=(x, 0, 0, y, 0, z))
        for row, (mass, com, (x, y, z)) in zip(shipped.rows, dynamics, strict=True)
    )
    return dh2urdf.DHTable(rows, "standard", name="puma560_dynamics")


def pinocchio_torques(table, q, v, a, options=AS_PUBLISHED):
    """rnea of the written file, joints found by name."""
    model = pin.buildModelFromXML(dh2urdf.urdf_text(table, options))
    order = [model.joints[model.getJointId(name)].idx_v for name in table.joint_names]
    motion = [np.empty(model.nv) for _ in range(3)]
    for array, values in zip(motion, (q, v, a), strict=True):
        array[order] = values
    return pin.rnea(model, model.createData(), *motion)[order]


def motions(n, count, seed):
    """Random configurations, velocities and accelerations, shape (count, 3, n)."""
    return np.random.default_rng(seed).uniform(-3, 3, size=(count, 3, n))


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_puma_dynamics_survive(convention):
    """Pinocchio's torques for the written Puma 560 equal Newton-Euler on its DH frames to 1e-9."""
    table = puma560()
    written = dh2urdf.to_convention(table, convention)
    for q, v, a in motions(6, 50, seed=1):
        expected = joint_torques(table, q, v, a)
        assert np.abs(pinocchio_torques(written, q, v, a) - expected).max() <= 1e-9


def test_the_puma_as_published_is_not_possible():
    """Two of its tensors are named, links 1 and 3, and only they are changed."""
    table = puma560()
    _, warnings = urdf_text_and_warnings(table, dh2urdf.UrdfOptions())
    named = [w.split(":")[0] for w in warnings if "no body has this inertia" in w]
    assert named == ["joint_1", "joint_3"]
    q, v, a = motions(6, 1, seed=2)[0]
    raised = pinocchio_torques(table, q, v, a, dh2urdf.UrdfOptions())
    assert np.abs(raised - joint_torques(table, q, v, a)).max() > 1e-3


@st.composite
def moving_tables(draw):
    """Tables of 1 to 7 joints, both conventions, signs and slides, every link with a body."""
    number, angle = st.floats(-1, 1), st.floats(-3, 3)
    rows = []
    for _ in range(draw(st.integers(1, 7))):
        x, y, z = (draw(st.floats(0.05, 0.5)) for _ in range(3))
        ixx, iyy, izz = y * y + z * z, x * x + z * z, x * x + y * y
        rows.append(
            dh2urdf.DHRow(
                theta=draw(angle), d=draw(number), a=draw(number), alpha=draw(angle),
                sign=draw(st.sampled_from([1, -1])),
                joint_type=draw(st.sampled_from(["revolute", "prismatic"])),
                lower=-3.0, upper=3.0, mass=draw(st.floats(0.1, 5)),
                com=(draw(number), draw(number), draw(number)),
                inertia=(ixx, 0.01 * x * y, 0, iyy, -0.01 * y * z, izz),
            )
        )  # fmt: skip
    base = dh2urdf.Origin((0.1, 0.2, 0.3), (draw(angle), 0.4, draw(angle)))
    convention = draw(st.sampled_from(["standard", "modified"]))
    return dh2urdf.DHTable(tuple(rows), convention, base=base)


@settings(max_examples=150)
@given(moving_tables(), st.integers(0, 10_000))
def test_dynamics_of_any_table_survive(table, seed):
    """Torques equal Newton-Euler on the DH frames to 1e-11 of the largest, at least 1 N m."""
    q, v, a = motions(table.n, 1, seed)[0]
    expected = joint_torques(table, q, v, a)
    found = pinocchio_torques(table, q, v, a)
    assert np.abs(found - expected).max() <= 1e-11 * max(1.0, np.abs(expected).max())


@pytest.mark.parametrize(
    ("six", "why"),
    [
        ((0.35, 0, 0, 0.1, 0, 0.1), "exceeds the sum"),
        ((0, 0, 0, 0.35, 0, 0), "smallest principal moment is 0"),
        ((0.1, 0.2, 0, 0.1, 0, 0.1), "smallest principal moment is -0.1"),
        ((0, 0, 0, 0, 0, 0), "zero"),
        ((-1, 0, 0, -1, 0, -1), "smallest principal moment is -1"),
    ],
)
def test_impossible_tensors_are_mended_so_that_mujoco_takes_them(six, why):
    """A tensor that no body has is named, MuJoCo refuses it as given and takes it mended."""
    assert why in why_impossible(tensor(six))
    row = dh2urdf.DHRow(a=0.5, lower=-1, upper=1, mass=2.0, com=(0.1, 0, 0), inertia=six)
    table = dh2urdf.DHTable((row,), "standard")
    with pytest.raises(ValueError, match="inertia"):
        mujoco.MjModel.from_xml_string(dh2urdf.urdf_text(table, AS_PUBLISHED))
    mujoco.MjModel.from_xml_string(dh2urdf.urdf_text(table))
    _, warnings = urdf_text_and_warnings(table, dh2urdf.UrdfOptions())
    assert any(w.startswith("joint_1: no body has this inertia") for w in warnings)


moments = st.floats(1e-6, 10)


@settings(max_examples=300)
@given(moments, moments, moments, st.integers(0, 1000))
def test_balancing_keeps_axes_and_the_largest_moment(x, y, z, seed):
    """A balanced tensor is possible, keeps its principal axes, and no moment shrinks."""
    assume(2 * max(x, y, z) > x + y + z)
    Q = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    given_ = Q @ np.diag([x, y, z]) @ Q.T
    out = balanced(0.5 * (given_ + given_.T))
    assert why_impossible(out) == ""
    inside = Q.T @ out @ Q
    scale = max(x, y, z)
    assert np.abs(inside - np.diag(np.diag(inside))).max() <= 1e-9 * scale
    grown = np.diag(inside) - [x, y, z]
    assert grown.min() >= -1e-9 * scale
    assert abs(grown[int(np.argmax([x, y, z]))]) <= 1e-9 * scale


def test_two_halves_weigh_as_much_as_the_whole():
    """A rod cut in two and put together again has its mass, centre and tensor."""

    def rod(length, middle):
        side = length**3 / 12
        return Inertial(length, np.array([middle, 0.0, 0.0]), np.diag([0.0, side, side]))

    both = Inertial.total([rod(1.0, 0.5), rod(2.0, 2.0)])
    whole = rod(3.0, 1.5)
    assert both.mass == pytest.approx(whole.mass)
    np.testing.assert_allclose(both.com, whole.com, atol=1e-15)
    np.testing.assert_allclose(both.inertia, whole.inertia, atol=1e-15)


def test_estimated_bodies_of_any_size_move():
    """From a 1 cm toy to a 100 m crane, MuJoCo takes the file and Pinocchio's ABA is finite."""
    for size in (0.01, 0.1, 1.0, 10.0, 100.0):
        rows = (dh2urdf.DHRow(d=size / 3, alpha=1.5), dh2urdf.DHRow(a=size), dh2urdf.DHRow())
        text = dh2urdf.urdf_text(dh2urdf.DHTable(rows, "standard"))
        mujoco.MjModel.from_xml_string(text)
        model = pin.buildModelFromXML(text)
        still = np.zeros(model.nv)
        assert np.isfinite(pin.aba(model, model.createData(), still, still, still)).all()


def test_mass_without_tensor_takes_the_shape_that_is_drawn():
    """A mass alone scales the drawn body's tensor; a density scales what has no mass."""
    table = dh2urdf.DHTable((dh2urdf.DHRow(a=0.5), dh2urdf.DHRow(a=0.5, mass=3.0)), "standard")

    def links(density):
        model = pin.buildModelFromXML(
            dh2urdf.urdf_text(table, dh2urdf.UrdfOptions(density=density))
        )
        return list(model.inertias)[1:]

    light, heavy = links(1000.0), links(2000.0)
    assert light[1].mass == heavy[1].mass == 3.0
    np.testing.assert_allclose(light[1].inertia, heavy[1].inertia, rtol=1e-7)
    assert heavy[0].mass == pytest.approx(2 * light[0].mass, rel=1e-8)
    np.testing.assert_allclose(heavy[0].inertia, 2 * light[0].inertia, rtol=1e-7, atol=1e-12)
