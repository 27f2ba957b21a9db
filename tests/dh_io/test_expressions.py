"""Cells: numbers, units, pi, functions; and nothing else."""

import math
import pickle
import subprocess
import sys
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dh2urdf.dh_io import SI, Units, parse_cell
from dh2urdf.dh_io.cells.units import decimal_text
from dh2urdf.exceptions import TableError

MM_DEG = Units("mm", "deg")
finite = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e6, max_value=1e6)


@pytest.mark.parametrize(
    ("text", "kind", "units", "value"),
    [
        ("-90", "angle", MM_DEG, -math.pi / 2),
        ("-90", "angle", SI, -90.0),
        ("90deg", "angle", SI, math.pi / 2),
        ("90 deg", "angle", SI, math.pi / 2),
        ("90°", "angle", SI, math.pi / 2),
        ("1.5rad", "angle", MM_DEG, 1.5),
        ("pi/2", "angle", SI, math.pi / 2),
        ("pi/2", "angle", MM_DEG, math.pi / 2),
        ("π/2", "angle", MM_DEG, math.pi / 2),
        ("2pi", "angle", MM_DEG, 2 * math.pi),
        ("-2*pi/3", "angle", SI, -2.0943951023931957),
        ("pi/2 - 90", "angle", MM_DEG, 0.0),
        ("30deg - pi/6", "angle", SI, 0.0),
        ("90*pi/180", "angle", MM_DEG, math.pi / 2),
        ("335", "length", MM_DEG, 0.335),
        ("89.159", "length", MM_DEG, 0.089159),
        ("100mm", "length", SI, 0.1),
        ("100mm + 5", "length", MM_DEG, 0.105),
        ("10 in", "length", SI, 0.254),
        ("3.5cm", "length", MM_DEG, 0.035),
        ("sqrt(90^2 + 295^2)", "length", MM_DEG, math.hypot(90, 295) / 1000),
        ("hypot(3mm, 4mm)", "length", SI, 0.005),
        ("2*cos(60)", "length", Units("m", "deg"), 1.0),
        ("2*cos(pi/3)", "length", MM_DEG, 0.001),
        ("atan2(1, 1)", "angle", MM_DEG, math.pi / 4),
        ("asin(1)/3", "angle", MM_DEG, math.pi / 6),
        ("abs(-30)", "angle", MM_DEG, math.pi / 6),
        ("pi", "number", SI, math.pi),
        ("3/4", "number", SI, 0.75),
        ("2**3", "number", SI, 8.0),
        ("-2^2", "number", SI, -4.0),
        ("2^-1", "number", SI, 0.5),
        ("1e-3", "number", SI, 0.001),
        ("-.5", "number", SI, -0.5),
        ("+5.", "number", SI, 5.0),
        ("0.1 + 0.2", "number", SI, 0.3),
        ("−90", "angle", MM_DEG, -math.pi / 2),
        (r"$-90^{o}$", "angle", MM_DEG, -math.pi / 2),
        (r"\pi/2", "angle", SI, math.pi / 2),
        (r"90^\circ", "angle", SI, math.pi / 2),
        ("2 · 3", "number", SI, 6.0),
    ],
)
def test_a_cell_is_read_to_the_last_bit(text: str, kind: str, units: Units, value: float) -> None:
    """Cells without functions equal the literal; functions are within an ulp or two."""
    tolerance = 1e-15 if "(" in text else 0.0
    assert parse_cell(text, kind, units) == pytest.approx(value, rel=tolerance, abs=0.0)


@pytest.mark.parametrize(
    ("text", "kind", "says"),
    [
        ("", "number", "not complete"),
        ("x", "number", "'x' is not a number"),
        ("1 +", "number", "not complete"),
        ("(1", "number", "not closed"),
        ("1)", "number", r"'\)' is not expected"),
        ("1 2", "number", "'2' is not expected"),
        ("1,5", "number", "',' is not expected"),
        ("nan", "number", "not a finite number"),
        (".inf", "number", "not a finite number"),
        ("-Infinity", "number", "not a finite number"),
        ("1e999", "number", "too large"),
        ("1e99999999999999999999", "number", "too large|no real value"),
        ("1/0", "number", "division by zero"),
        ("0/0", "number", "division by zero"),
        ("0^-1", "number", "division by zero"),
        ("sqrt(-1)", "number", "no real value"),
        ("asin(2)", "angle", "no value"),
        ("9**9**9**9", "number", "an exponent of at most 10"),
        ("2^1000", "number", "an exponent of at most 10"),
        ("((((9^9)^9)^9)^9)^9", "number", "too large"),
        ("(" * 60 + "1" + ")" * 60, "number", "nested deeper"),
        ("-" * 150 + "1", "number", "nested deeper"),
        ("1+" * 150 + "1", "number", "301 characters"),
        ("1" * 100_000, "number", "100000 characters"),
        ("__import__('os')", "number", "has no place"),
        ("os.system", "number", "'.' has no place"),
        ("(lambda: 0)()", "number", "':' has no place|'lambda'"),
        ("[1 for _ in ()]", "number", "has no place"),
        ("f(1)", "number", "is not a function"),
        ("exit(0)", "number", "is not a function"),
        ("0x10", "number", "'x10' is not expected"),
        ("1_000", "number", "'_000' is not expected"),
        ("100mm", "angle", "a length where an angle"),
        ("90deg", "length", "an angle where a length"),
        ("90deg", "number", "an angle where a plain number"),
        ("90deg * 2rad", "angle", "neither a length nor an angle"),
        ("1/90deg", "angle", "by a plain number"),
        ("pi/2rad", "angle", "by a plain number"),
        ("(2mm)^2", "length", "plain numbers only"),
        ("hypot(1mm, 2deg)", "length", "two values of one kind"),
        ("hypot(1)", "length", "takes 2 values"),
        ("sqrt(2mm)", "length", "takes a plain number"),
    ],
)
def test_what_is_no_number_is_refused_with_its_reason(text: str, kind: str, says: str) -> None:
    """Every text of the list raises a table error that gives the reason."""
    with pytest.raises(TableError, match=says):
        parse_cell(text, kind)


def test_code_in_a_cell_does_not_run() -> None:
    """Reading cells that hold code creates no file and imports nothing."""
    program = (
        "import sys\n"
        "from dh2urdf.dh_io import parse_cell\n"
        "from dh2urdf.exceptions import TableError\n"
        "before = set(sys.modules)\n"
        "for text in (\"__import__('antigravity')\", 'exec(\"import this\")', '().__class__'):\n"
        "    try: parse_cell(text)\n"
        "    except TableError: pass\n"
        "    else: sys.exit('not refused')\n"
        "assert set(sys.modules) - before <= {'decimal', '_decimal'}\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_an_expression_error_survives_pickling() -> None:
    """A process pool hands the message and the hint on."""
    with pytest.raises(TableError) as caught:
        parse_cell("nan")
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)
    assert again.hint == caught.value.hint


@given(finite)
def test_the_text_of_a_float_is_the_float(value: float) -> None:
    """``repr`` of a float is read back as the float itself."""
    assert parse_cell(repr(value)) == value


@pytest.mark.parametrize("unit", ["m", "cm", "mm", "in", "rad", "deg"])
@given(value=finite)
def test_a_value_survives_every_unit(unit: str, value: float) -> None:
    """A length or an angle written in any unit reads back as the same float."""
    angle = unit in ("rad", "deg")
    units = Units("m", unit) if angle else Units(unit, "rad")
    assert parse_cell(decimal_text(value, unit), "angle" if angle else "length", units) == value


@given(st.integers(-720, 720))
def test_whole_degrees_are_written_as_such(degrees: int) -> None:
    """No whole number of degrees is written with a fraction."""
    assert decimal_text(parse_cell(f"{degrees}deg", "angle"), "deg") == str(degrees)


@given(st.decimals(-5000, 5000, places=3, allow_nan=False))
def test_millimetres_are_shifted_not_multiplied(number: object) -> None:
    """A decimal in mm is the float nearest to that decimal in metres."""
    nearest = float(Fraction(str(number)) / 1000)
    assert parse_cell(str(number), "length", MM_DEG) == nearest


@given(st.recursive(
    st.integers(1, 50).map(str),
    lambda inner: st.tuples(inner, st.sampled_from("+-*/"), inner).map(
        lambda t: f"({t[0]} {t[1]} {t[2]})"
    ),
    max_leaves=8,
))  # fmt: skip
def test_arithmetic_is_that_of_fractions(text: str) -> None:
    """Random expressions have the value that exact fractions give, or divide by zero."""
    names = {"__builtins__": {}, "F": Fraction}
    exact_text = "".join(f"F({w})" if w.isdigit() else w for w in _words(text))
    try:
        exact = eval(exact_text, names)  # the test's own text, digits and operators only
    except ZeroDivisionError:
        with pytest.raises(TableError, match="division by zero"):
            parse_cell(text)
        return
    assert parse_cell(text) == pytest.approx(float(exact), rel=1e-15, abs=1e-40)


def _words(text: str) -> list[str]:
    return text.replace("(", "( ").replace(")", " )").split(" ")
