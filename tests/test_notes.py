"""The lecture notes' forward kinematics, equation by equation."""

import math

import numpy as np
import pytest
from dh_product import difference, shift, turn

import dh2urdf
from dh2urdf import DHRow, Origin, dh_parameters
from dh2urdf import transforms as tf
from dh2urdf.exceptions import TableError
from dh2urdf.symbolic import symbolic_product

Q1, Q2, Q3 = 0.7, -1.1, 0.4


def test_planar_transforms_multiply_to_the_arm_with_orientation():
    """Section 2: H_1^0 H_2^1 H_3^2 H_4^3 holds x, y and phi of section 1."""
    l1, l2 = 1.0, 0.7
    H = tf.planar_rotation(Q1) @ tf.planar_translation(l1)
    H = H @ tf.planar_rotation(Q2) @ tf.planar_translation(l2)
    x = l1 * math.cos(Q1) + l2 * math.cos(Q1 + Q2)
    y = l1 * math.sin(Q1) + l2 * math.sin(Q1 + Q2)
    assert H[:2, 2] == pytest.approx([x, y], abs=1e-15)
    assert math.atan2(H[1, 0], H[0, 0]) == pytest.approx(Q1 + Q2, abs=1e-15)
    T = dh2urdf.Robot.from_dh("planar_rr").fk([Q1, Q2])
    assert T[:2, 3] == pytest.approx([x, y], abs=1e-15)
    assert T[:2, :2] == pytest.approx(H[:2, :2], abs=1e-15)


def test_both_remedies_of_the_rpr_arm_reach_the_same_point():
    """Section 7.1: frame 3 of the two remedies has one origin, turned by 90 degrees about z."""
    q = [Q1, 0.3, Q3]
    new_frame = dh2urdf.load_table("rpr_new_frame").fk(q)
    by_inspection = dh2urdf.load_table("rpr_by_inspection").fk(q)
    assert difference(new_frame[:3, 3], by_inspection[:3, 3]) < 1e-15
    assert difference(new_frame, by_inspection @ turn(2, math.pi / 2)) < 1e-15
    H = turn(2, Q1) @ shift(0, 3) @ turn(0, -math.pi / 2)
    H = H @ shift(2, 0.3 + 2) @ turn(0, math.pi / 2) @ turn(2, Q3) @ shift(1, 1.5)
    assert difference(by_inspection, H) < 1e-14


def test_third_row_of_the_rpr_arm_is_recognised():
    """Rot_z(theta_3) Trans_y(1.5) is no DH row: the message says why and names both remedies."""
    with pytest.raises(TableError) as caught:
        dh_parameters(turn(2, 0.0) @ shift(1, 1.5), i=3)
    message = str(caught.value)
    assert "frame 3 cannot be reached from frame 2 by the four DH motions" in message
    assert "the line of x_3 misses z_2 by 1.5 m" in message
    assert "theta + 90 deg, d = 0, a = 1.5, alpha = 0 deg" in message
    assert "{type: fixed, xyz: [0, 1.5, 0], rpy: [0, 0, 0]}" in message
    with pytest.raises(TableError, match="four DH motions"):
        DHRow(origin=Origin((0, 1.5, 0)))


def test_tilted_frame_is_recognised():
    """A frame whose x leans against the previous z is refused with the angle."""
    with pytest.raises(TableError, match=r"not perpendicular to z_0 \(off by 10 deg\)"):
        dh_parameters(turn(1, math.radians(10)))


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_parameters_of_a_displacement_come_back(convention):
    """dh_parameters inverts dh_transform."""
    rng = np.random.default_rng(0)
    for _ in range(100):
        theta, alpha = rng.uniform(-3, 3, 2)
        d, a = rng.uniform(-1, 1, 2)
        T = dh2urdf.dh_transform(theta, d, a, alpha, convention)
        again = dh2urdf.dh_transform(*dh_parameters(T, convention), convention)
        assert difference(T, again) < 1e-14


def test_denso_flange_stands_where_the_notes_draw_it():
    """Section 7.2 with theta_2 = -90 deg: the flange is at (450, 0, 695) mm."""
    T = dh2urdf.Robot.from_dh("denso_vs6556").fk([0, -math.pi / 2, 0, 0, 0, 0])
    assert T[:3, 3] == pytest.approx([0.450, 0, 0.695], abs=1e-15)


def test_zyz_angles_have_two_solutions_and_one_family():
    """Both ZYZ solutions make the rotation; at sin(theta) = 0 one representative does."""
    rng = np.random.default_rng(1)
    for _ in range(200):
        angles = rng.uniform(-math.pi, math.pi, 3)
        R = tf.zyz_to_matrix(*angles)
        found = tf.matrix_to_zyz(R)
        assert len(found) == 2
        assert all(difference(tf.zyz_to_matrix(*s), R) < 1e-15 * 10 for s in found)
        assert (
            min(np.abs(np.exp(1j * np.array(s)) - np.exp(1j * angles)).max() for s in found) < 1e-7
        )
    for theta in (0.0, math.pi):
        R = tf.zyz_to_matrix(0.4, theta, 1.1)
        (single,) = tf.matrix_to_zyz(R)
        assert single[0] == 0.0
        assert difference(tf.zyz_to_matrix(*single), R) < 1e-15


def test_symbolic_product_is_the_notes_planar_arm():
    """c12, s12, l1 c1 + l2 c12: the product in symbols reads as in section 8.2."""
    from dh2urdf.symbolic import symbolic_product, symbolic_text

    text = symbolic_text(symbolic_product(dh2urdf.load_table("planar_rr")))
    assert text.splitlines()[0].split("  ")[1:] == ["c12", "\N{MINUS SIGN}s12", "0", "c1 + 0.7·c12"]


@pytest.mark.parametrize("name", ["denso_vs6556", "rpr_by_inspection", "franka_fer", "stanford"])
def test_symbolic_product_is_numerically_the_dh_product(name):
    """Numbers put into the symbolic product give the FK without base and tool."""
    import sympy

    from dh2urdf.symbolic import symbolic_product

    table = dh2urdf.load_table(name)
    q = np.linspace(-0.9, 1.2, table.n)
    values = {sympy.Symbol(f"q_{i}"): v for i, v in enumerate(q, 1)}
    H = np.array(symbolic_product(table).evalf(subs=values), dtype=float)
    frames = table.frames(q)
    assert difference(H, tf.inverse(frames[0]) @ frames[-1]) < 1e-12


def test_the_angles_of_sixty_parallel_joints_are_added():
    """The product of a long planar arm is a sum of cosines, found in seconds."""
    sympy = pytest.importorskip("sympy")
    arm = dh2urdf.DHTable.from_array(np.tile([0, 0, 0.01, 0], (60, 1)), convention="standard")
    total = sum(sympy.symbols("q_1:61"))
    assert symbolic_product(arm)[0, 0] == sympy.cos(total)
