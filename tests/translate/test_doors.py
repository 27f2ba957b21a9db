"""What an entry is handed is looked at before it runs: kinds, numbers and all lengths."""

import numpy as np
import pytest

from dh2urdf.kernels.certificate import measure_all
from dh2urdf.kernels.numbers import engine
from dh2urdf.kernels.spherical_wrist import solve_common_wrist

pytestmark = pytest.mark.skipif(not engine._COMPILED, reason="kernels are interpreted")

CODES = np.int64
POSES = 3


def arguments():
    """Arm, poses, whether within limits, and room for solutions: as the entry declares them."""
    arm = [np.zeros((7, 4, 4)), np.zeros((6, 3)), np.zeros((6, 7)), np.zeros((3, 4, 4)), 1.0]
    outputs = [np.full((POSES, 8, 6), 5.0), np.full((POSES, 8), 5.0)]
    outputs += [np.full(shape, 5, CODES) for shape in (POSES, (POSES, 8), (POSES, 8))]
    return [arm, np.zeros((POSES, 4, 4)), True, outputs]


def called(given):
    """Call the compiled entry."""
    given = [tuple(x) if isinstance(x, list) else x for x in given]
    return solve_common_wrist(*given)


def test_what_is_declared_is_taken():
    """The arguments of the other tests are good ones but for what they change."""
    given = arguments()
    assert called(given) is None
    assert not np.array_equal(given[3][2], np.full(POSES, 5))


FLOATS = "array of float"
ELSE = {
    "no number": (0, 4, "long", TypeError, r"arm\[4\]: expected float"),
    "no truth": (2, None, np.zeros(2), TypeError, "within_limits: expected bool"),
    "no array": (1, None, [1.0], TypeError, rf"Ts: expected {FLOATS} \(poses, 4, 4\)"),
    "whole numbers": (1, None, np.zeros((3, 4, 4), CODES), TypeError, "Ts: expected"),
    "floats": (3, 2, np.zeros(3), TypeError, r"outputs\[2\]: expected array of int \(poses\)"),
    "dimensions": (1, None, np.zeros((4, 4)), TypeError, "Ts: expected"),
    "columns first": (1, None, np.zeros((3, 4, 4)).swapaxes(1, 2), TypeError, "in C order"),
    "no tuple": (0, None, np.zeros(5), TypeError, "arm: expected a tuple of 5"),
    "short tuple": (3, None, [np.zeros((3, 8, 6))], TypeError, "outputs: expected a tuple of 5"),
    "first length": (0, 0, np.zeros((6, 4, 4)), ValueError, r"arm\[0\]: expected"),
    "inner length": (1, None, np.zeros((3, 4, 3)), ValueError, "Ts: expected"),
    "joints": (0, 1, np.zeros((7, 3)), ValueError, rf"arm\[1\]: expected {FLOATS} \(6, 3\)"),
    "other poses": (3, 0, np.zeros((2, 8, 6)), ValueError, r"outputs\[0\]: expected"),
    "few solutions": (3, 1, np.zeros((3, 7)), ValueError, r"outputs\[1\]: expected"),
    "few counts": (3, 2, np.zeros(2, CODES), ValueError, r"outputs\[2\]: expected"),
    "many codes": (3, 4, np.zeros((3, 9), CODES), ValueError, r"outputs\[4\]: expected"),
}
"""An argument, which of its items, what is handed instead, and what is said of it."""


@pytest.mark.parametrize("what", ELSE)
def test_anything_else_is_refused_by_name(what):
    """The message names the argument and what it has to be; nothing is written."""
    at, item, other, error, message = ELSE[what]
    given = arguments()
    outputs = list(given[3])
    if item is None:
        given[at] = tuple(other) if what == "short tuple" else other
    else:
        given[at][item] = other
    with pytest.raises(error, match=message):
        called(given)
    assert all((array == 5).all() for array in outputs)


@pytest.mark.parametrize("count", [0, 3, 5])
def test_other_counts_of_arguments_are_refused(count):
    """Too few and too many."""
    given = [*arguments(), 0.0][:count]
    with pytest.raises(TypeError, match=f"expected 4 arguments, got {count}"):
        called(given)


@pytest.mark.parametrize("task", [2**31, 1.0, None])
def test_whole_numbers_that_c_does_not_hold_are_refused(task):
    """They would lose bits."""
    chain, poses = (np.zeros((3, 4, 4)), np.zeros((2, 3))), np.zeros((0, 4, 4))
    found = np.zeros((0, 1, 2)), np.zeros(0, CODES), np.zeros((0, 1))
    measure_all(chain, 0, poses, *found)
    with pytest.raises(TypeError, match="task: expected int"):
        measure_all(chain, task, poses, *found)


def test_lengths_that_depend_on_one_another_are_compared():
    """There is one link more than joints, whatever comes first."""
    found = np.zeros((0, 4, 4)), np.zeros((0, 1, 2)), np.zeros(0, CODES), np.zeros((0, 1))
    for links in (0, 2, 4):
        with pytest.raises(ValueError, match=r"chain\[[01]\]: expected array of float"):
            measure_all((np.zeros((links, 4, 4)), np.zeros((2, 3))), 0, *found)
