"""A row motion by motion: the order of each convention, and a product that is the row's matrix."""

from functools import reduce

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import tables

from dh2urdf import DHRow, DHTable, load_table
from dh2urdf.dh.row import Origin
from dh2urdf.drawing.lesson import motions
from dh2urdf.transforms import trans


@given(tables(), st.integers(0, 2**32 - 1))
def test_product_of_the_motions_is_the_row(table, seed):
    """Fixed steps included, row by row, in both conventions."""
    q = np.random.default_rng(seed).uniform(-2, 2, table.n)
    for i, T in enumerate(table.transforms(q), 1):
        product = reduce(np.matmul, [motion.T for motion in motions(table, i, q[i - 1])])
        np.testing.assert_allclose(product, T, atol=1e-12 * max(1, np.abs(T).max()))


@pytest.mark.parametrize(
    ("name", "keys", "words"),
    [
        ("ur5e", "theta d a alpha", ["turn about z₁ by θ₂", "move along x₂ by a₂"]),
        ("franka_fer", "alpha a theta d", ["turn about z₂ by θ₂", "move along x₁ by a₁"]),
    ],
)
def test_motions_come_in_the_order_of_the_convention(name, keys, words):
    """Each names the axis it goes about or along, with the indices of the convention."""
    steps = motions(load_table(name), 2)
    assert [step.key for step in steps] == keys.split()
    assert set(words) <= {step.words for step in steps}


def test_fixed_rows_are_one_step_more():
    """Rows without a joint follow the motions of the row before, as one step of their own."""
    origin = Origin((0.0, 1.5, 0.0), (0.1, 0.0, 0.0))
    fixed = (DHRow(joint_type="fixed", origin=origin), DHRow(joint_type="fixed", a=0.2))
    table = DHTable((DHRow(a=1.0), *fixed, DHRow(d=0.3)), "standard", "stepped")
    first, last = motions(table, 1, 0.5), motions(table, 2)
    assert [m.key for m in first] == ["theta", "d", "a", "alpha", "step"]
    np.testing.assert_allclose(first[-1].T, origin.matrix @ trans(0.2, 0, 0), atol=1e-15)
    assert len(last) == 4
