"""Angles and lengths as the steps of an assignment write them."""

import math

import pytest

from dh2urdf.conversions.assign.explain import angle_words, length_words


@pytest.mark.parametrize(("twelfths", "words"), [
    (0, "0"), (1, "pi/12"), (-2, "-pi/6"), (6, "pi/2"), (8, "2 pi/3"), (-9, "-3 pi/4"),
    (12, "pi"), (-12, "-pi"), (18, "3 pi/2"), (-24, "-2 pi"),
    (3.0001, "0.785424 rad (45.0015 deg)"),
])  # fmt: skip
def test_an_angle_is_written_as_a_person_writes_it(twelfths, words):
    """Parts of pi down to a twelfth in lowest terms, everything else in both units."""
    assert angle_words(twelfths * math.pi / 12) == words


@pytest.mark.parametrize(("length", "words"), [
    (0.25, "0.25"), (-1 / 3, "-0.333333"), (1e-13, "0"), (-1e-13, "0"), (1e-12, "1e-12"),
])  # fmt: skip
def test_a_length_is_written_without_noise(length, words):
    """Six digits, and 0 for what rounding leaves."""
    assert length_words(length) == words
