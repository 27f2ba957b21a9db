"""What moves a joint is written where the table is: text, LaTeX, symbols."""

import numpy as np
import pytest
from coupled_arms import COUPLED, driven_palletiser, painter

from dh2urdf import DHRow, DHTable, Mimic, Robot
from dh2urdf.dh.variables import moved_by
from dh2urdf.symbolic import symbolic_product, symbolic_transforms


def test_the_table_prints_the_values_that_move_a_joint():
    """Of joints that follow, the value of the one that leads; of coupled ones, the sum."""
    text = str(driven_palletiser()).replace("\N{MINUS SIGN}", "-")
    for word in ("q2 - 90", "q3 - q2 + 90", " -q2 ", "q2 - q3", " q4 "):
        assert word in text
    assert "q5" not in text
    assert "q = (joint_1, joint_2, joint_3, joint_6)" in text


def test_signs_multipliers_and_offsets_are_in_what_is_printed():
    """A joint that turns the other way, half as far, from 0.1 rad: -0.5 q1 - 0.1."""
    row = DHRow(a=0.1, sign=-1, mimic=Mimic("joint_1", 0.5, 0.1))
    table = DHTable((DHRow(a=0.2), row), "standard")
    assert moved_by(table.joint_map, 1, -1, minus="-") == ("-0.5 q1", -0.1)


def test_latex_prints_every_value_with_its_index():
    """Both values of a sum are set with their subscripts."""
    assert "$q_{3} - q_{2} + 90$" in driven_palletiser().to_latex()


@pytest.mark.parametrize("name", COUPLED)
def test_transforms_in_symbols_are_those_in_numbers(name):
    """With numbers for q_1 ... q_n they are what the robot's joints make."""
    import sympy as sp

    table = COUPLED[name]()
    robot = Robot.from_dh(table)
    q = np.random.default_rng(0).uniform(-1, 1, robot.n)
    given = {sp.Symbol(f"q_{k}"): v for k, v in enumerate(q.tolist(), 1)}
    joints = robot.chain_configuration(q)
    for symbols, numbers in zip(symbolic_transforms(table), table.transforms(joints), strict=True):
        assert symbols.free_symbols <= set(given)
        assert np.abs(np.array(symbols.subs(given), float) - numbers).max() < 1e-12


def test_the_product_of_a_palletiser_says_that_its_tool_is_level():
    """The third row of the rotation is a unit vector whatever the values are."""
    product = symbolic_product(driven_palletiser())
    assert [abs(product[2, k]) for k in range(3)] == [0, 0, 1]


def test_the_painter_has_six_values():
    """Seven joints, of which the sixth is minus the fifth value and the seventh the sixth."""
    found = [moved_by(painter().joint_map, i, minus="-")[0] for i in range(7)]
    assert found == ["q1", "q2", "q3", "q4", "q5", "-q5", "q6"]
