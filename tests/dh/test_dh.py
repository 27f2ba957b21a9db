"""Rows, tables, conventions, and how they print."""

import math
import pickle

import numpy as np
import pytest
from dh_product import dh_frames, difference, shift, turn
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import ANGLES, LENGTHS, tables

import dh2urdf
from dh2urdf import DHRow, DHTable, Origin, to_convention
from dh2urdf.exceptions import ConfigurationError, TableError

CONVENTIONS = ("standard", "modified")


@given(ANGLES, LENGTHS, LENGTHS, ANGLES)
def test_big_equation_is_the_product_of_its_four_factors(theta, d, a, alpha):
    """Rot_z Trans_z Trans_x Rot_x multiplies to the Big Equation, Craig's order to his."""
    factors = dh2urdf.dh_factors(theta, d, a, alpha)
    assert difference(factors.rot_z, turn(2, theta)) < 1e-15
    assert difference(factors.trans_z, shift(2, d)) == 0
    assert difference(factors.trans_x, shift(0, a)) == 0
    assert difference(factors.rot_x, turn(0, alpha)) < 1e-15
    standard = factors.rot_z @ factors.trans_z @ factors.trans_x @ factors.rot_x
    modified = factors.trans_x @ factors.rot_x @ factors.rot_z @ factors.trans_z
    assert difference(dh2urdf.dh_transform(theta, d, a, alpha), standard) < 1e-15
    assert difference(dh2urdf.dh_transform(theta, d, a, alpha, "modified"), modified) < 1e-15


@settings(max_examples=300)
@given(tables(), st.integers(0, 2**32 - 1))
def test_frames_are_the_product_of_the_rows(table, seed):
    """frames(q), fk(q) and transforms(q) equal the product written apart."""
    q = np.random.default_rng(seed).uniform(-2, 2, table.n)
    expected = dh_frames(table, q)
    assert difference(table.frames(q), expected[:-1]) < 1e-13
    assert difference(table.fk(q), expected[-1]) < 1e-13
    product = expected[0]
    for T in table.transforms(q):
        product = product @ T
    assert difference(product, expected[-2]) < 1e-12


@settings(max_examples=300)
@given(tables(), st.integers(0, 2**32 - 1))
def test_other_convention_is_the_same_arm(table, seed):
    """Base and tool take up what moves: FK is equal in both conventions, there and back."""
    q = np.random.default_rng(seed).uniform(-2, 2, table.n)
    other = to_convention(table, next(c for c in CONVENTIONS if c != table.convention))
    back = to_convention(other, table.convention)
    expected = dh_frames(table, q)[-1]
    assert difference(dh_frames(other, q)[-1], expected) < 1e-12
    assert difference(dh_frames(back, q)[-1], expected) < 1e-12
    assert other.joint_names == table.joint_names


def test_inertia_moves_with_the_frames():
    """Mass properties mean the same body in base in both conventions, at any q."""
    row = DHRow(
        theta=0.3, d=0.2, a=0.5, alpha=0.7, mass=2.0, com=(0.1, -0.2, 0.3),
        inertia=(0.03, 0.001, -0.002, 0.04, 0.003, 0.05),
    )  # fmt: skip
    fixed = DHRow(joint_type="fixed", origin=Origin((0.1, 0.2, 0.3), (0.4, 0.5, 0.6)))
    table = DHTable((row, fixed, row, row), "standard")
    modified = to_convention(table, "modified")
    q = [0.4, -0.9, 1.7]
    for old, new, a, b in zip(
        table.frames(q)[1:], modified.frames(q)[1:], table.joints, modified.joints, strict=True
    ):
        assert difference(old @ [*a.com, 1], new @ [*b.com, 1]) < 1e-14
        I_old, I_new = (dh2urdf.conversions.write.inertia.tensor(r.inertia) for r in (a, b))
        base_old = old[:3, :3] @ I_old @ old[:3, :3].T
        assert difference(base_old, new[:3, :3] @ I_new @ new[:3, :3].T) < 1e-15


def test_tables_are_values():
    """Equal tables are equal, hashable, picklable, and repr evaluates back."""
    from dh2urdf import DHConvention, JointType  # noqa: F401  (names that repr uses)

    table = dh2urdf.load_table("stanford")
    assert pickle.loads(pickle.dumps(table)) == table
    assert hash(dh2urdf.load_table("stanford")) == hash(table)
    names = {"DHTable": DHTable, "DHRow": DHRow, "Origin": Origin}
    text = repr(table)
    for kind in (dh2urdf.DHConvention, dh2urdf.JointType):
        for member in kind:
            text = text.replace(repr(member), repr(str(member)))
    assert eval(text, names) == table


def test_all_faults_of_a_row_are_told():
    """One row with five faults names all five, with the value and what is allowed."""
    with pytest.raises(TableError) as caught:
        DHRow(theta="x", d=math.nan, sign=2, lower=1, upper=0, mass=-1)
    keys = [problem.partition(":")[0] for problem in caught.value.problems]
    assert keys == ["theta", "d", "sign", "lower", "mass"]


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: DHTable((), "standard"), "at least one"),
        (lambda: DHTable((DHRow(),), "standard", name=""), "needs one"),
        (lambda: DHTable((DHRow(),), "distal"), "'standard' or 'modified'"),
        (lambda: DHTable((DHRow(name="a"), DHRow(name="a")), "standard"), "more than one"),
        (lambda: DHRow(joint_type="ball"), "'revolute' or 'prismatic' or 'fixed'"),
        (lambda: DHRow(inertia=(1, 0, 0, 1, 0, 1)), "mass: missing"),
        (lambda: DHRow(joint_type="fixed", mass=1), "row above"),
        (lambda: DHRow(com=(1, 2)), "com: expected 3 numbers"),
        (lambda: Origin((1, 2, math.inf)), "xyz: expected 3 numbers from -1e"),
        (lambda: Origin("ab"), "xyz: expected 3 numbers"),
    ],
)
def test_tables_that_cannot_be_meant_are_refused(build, message):
    """Each impossible row or table is an error that says what is allowed."""
    with pytest.raises(TableError, match=message):
        build()


def test_q_of_the_wrong_length_is_refused():
    """The message gives the joints and the shape found."""
    with pytest.raises(ConfigurationError, match=r"\(2,\) for 2 joints, got \(3,\)"):
        dh2urdf.load_table("planar_rr").fk([0, 0, 0])


def test_table_prints_itself():
    """Text, LaTeX and HTML hold every number with a true minus sign."""
    table = dh2urdf.load_table("puma560")
    text = str(table)
    for cell in ("puma560", "q1", "0.67183", "0.15005", "\N{MINUS SIGN}90", "standard DH"):
        assert cell in text
    assert r"\toprule" in table.to_latex()
    assert r"$q_{1}$" in table.to_latex()
    html = table._repr_html_()
    assert html.count("<tr>") == 7
    assert "0.15005" in html


def test_printed_variable_shows_sign_and_offset():
    """A negative sign and an offset read as in a textbook."""
    table = DHTable(
        (
            DHRow(theta=-math.pi / 2, sign=-1, a=1),
            DHRow(joint_type="prismatic", d=2.0),
            DHRow(joint_type="fixed", origin=Origin((0, 1.5, 0))),
        ),
        "standard",
    )
    text = str(table)
    assert "\N{MINUS SIGN}q1 \N{MINUS SIGN} 90" in text
    assert "q2 + 2" in text
    assert "xyz (0, 1.5, 0) m" in text
