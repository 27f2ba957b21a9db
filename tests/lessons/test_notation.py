"""Formulas are written once: as text with numbers put in, and as LaTeX."""

import math

import pytest

from dh2urdf.lessons.equation import Equation
from dh2urdf.lessons.evaluated import turn_shown
from dh2urdf.lessons.notation import latex, latex_name, measured, shown, with_numbers


@pytest.mark.parametrize(
    ("formula", "given", "text"),
    [
        ("2 l_1 l_2 c_2", {"l_1": 1.0, "l_2": 0.7, "c_2": -0.5}, "2 · 1 · 0.7 · (-0.5)"),
        ("atan2(y, x) - gamma", {"y": -1.0, "x": 2.0, "gamma": -0.5}, "atan2(-1, 2) - (-0.5)"),
        ("x^2 + y^2", {"x": -3.0, "y": 4.0}, "(-3)^2 + 4^2"),
        ("+- acos(c)", {"c": 0.25}, "±acos(0.25)"),
        ("a +- b", {"a": 1.0, "b": 2.0}, "1 ± 2"),
        ("(a - b) / (2 a)", {"a": 1.0, "b": 2.0}, "(1 - 2) / (2 · 1)"),
        (
            "o - d_6 k",
            {"o": (1.0, 0.0, 0.5), "d_6": 0.1, "k": (0.0, 0.0, 1.0)},
            "(1, 0, 0.5) - 0.1 · (0, 0, 1)",
        ),
    ],
)
def test_numbers_are_put_in_with_their_signs(formula, given, text):
    """Negative numbers get brackets where a sign or a power stands beside them."""
    assert with_numbers(formula, given) == text


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        ("sqrt(x_c^2 + y_c^2)", r"\sqrt{x_{c}^{2} + y_{c}^{2}}"),
        ("(R_3^0)^T R", r"\left(R_{3}^{0}\right)^{T} \, R"),
        ("b / sin(alpha_1)", r"\frac{b}{\sin\left(\alpha_{1}\right)}"),
        ("(a + b) / (2 l_1)", r"\frac{a + b}{2 \, \ell_{1}}"),
        ("((a) (b)) / c", r"\frac{\left(a\right) \, \left(b\right)}{c}"),
        ("+- acos(c_eta)", r"\pm \arccos\left(c_{\eta}\right)"),
    ],
)
def test_latex_has_the_notes_letters(formula, text):
    """Indices, Greek letters, fractions without their own brackets."""
    assert latex(formula) == text


def test_names_and_values_are_short():
    """Six digits, noise as zero, angles in degrees too."""
    assert latex_name("l_1") == r"\ell_{1}"
    assert shown(6.1e-17) == "0"
    assert shown(-0.12345678) == "-0.123457"
    assert measured(0.5, "rad") == "0.5 rad (28.6479 deg)"
    assert measured(0.25, "m") == "0.25 m"


def test_a_turn_that_is_left_out_is_shown():
    """theta_6 - theta_06 = -4.57 is given as 1.71: numbers put in have + 2π behind them."""
    given = {"theta_6": -1.42694, "theta_06": 3.14159}
    turned = Equation("q_6", "theta_6 - theta_06", given, -4.56853 + math.tau, "rad")
    assert turned.numbers == "-1.42694 - 3.14159 + 2π"
    assert r"3.14159 + 2 \pi \\" in turned.latex
    same = Equation("q_6", "theta_6 - theta_06", given, -4.56853, "rad")
    assert same.numbers == "-1.42694 - 3.14159"


@pytest.mark.parametrize(
    ("formula", "number"),
    [
        ("a - b - a", -2.0),
        ("-a^2 b / (2 a)", -1.0),
        ("atan2(-a, -(b - 1)) - sqrt(a^2 + 3)", -0.75 * math.pi - 2.0),
        ("acos(a) cos(-a + 1)", 0.0),
    ],
)
def test_formulas_are_computed_as_they_are_read(formula, number):
    """Signs, powers, products and brackets, by the turns to a value three turns away."""
    given = {"a": 1.0, "b": 2.0}
    assert turn_shown(formula, given, (number + 3 * math.tau,)) == " + 6π"
    assert turn_shown(formula, given, (number - math.tau,)) == " - 2π"
    assert turn_shown(formula, given, (number + 1e-3,)) == ""


@pytest.mark.parametrize("formula", ["k + a", "c + a", "acos(b)", "a / 0", "a +- acos(b)"])
def test_formulas_without_a_number_have_no_turn(formula):
    """A vector, a letter without a number, no such angle: nothing is added."""
    given = {"a": 1.0, "b": 2.0, "k": [1.0, 0.0, 0.0]}
    assert turn_shown(formula, given, (7.0,)) == ""


def test_either_sign_is_modulo_a_turn_where_one_value_is():
    """3 ± 1 is 4 or 2; given as -2.28 or 2 it holds modulo 2π, and says so."""
    given = {"a": 3.0, "b": 1.0}
    assert turn_shown("a +- b", given, (4.0, 2.0)) == ""
    assert turn_shown("a +- b", given, (4.0 - math.tau, 2.0)) == " (mod 2π)"
    assert turn_shown("a +- b", given, (4.0 + 1e-5, 2.0)) == ""
    equation = Equation("theta_1", "a +- b", given, 4.0 - math.tau, "rad", (2.0,))
    assert equation.numbers == "3 ± 1 (mod 2π)"
    assert r"3 \pm 1 \ (\mathrm{mod}\ 2 \pi)" in equation.latex
