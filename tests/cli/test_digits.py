"""Numbers as text by the thousand: the same as ``repr``."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from dh2urdf.cli.verbs.ik.digits import few_words, number_words, text_of, whole_words


def texts(values):
    """The cells of numbers."""
    return text_of([number_words(np.asarray(values, float))]).decode().split(",")[1:]


def test_numbers_of_every_size_are_written_as_by_repr():
    """Angles in radians and degrees, rounded numbers, powers of 2 and 10 and their neighbours."""
    rng = np.random.default_rng(0)
    tens, twos = 10.0 ** np.arange(-7, 8), 2.0 ** np.arange(-20, 20)
    edges = np.concatenate([tens, twos, [0.0, -0.0, np.pi, 5e-324, 1e300, np.inf]])
    neighbours = [np.nextafter(edges, side) for side in (-np.inf, np.inf)]
    rounded = [rng.uniform(-400, 400, 2_000).round(digits) for digits in range(17)]
    dyadic = 1 + np.arange(2_000) / 2.0**16
    plain = [rng.uniform(-np.pi, np.pi, 20_000), 10.0 ** rng.uniform(-6, 6, 20_000)]
    values = np.concatenate([edges, *neighbours, *rounded, dyadic, *plain])
    assert texts(values) == [repr(float(v)) for v in values]


@given(values=hnp.arrays(np.float64, st.integers(1, 20), elements=st.floats(allow_nan=False)))
def test_any_float_is_written_as_by_repr(values):
    """Bit for bit the same text."""
    assert texts(values) == [repr(float(v)) for v in values]


def test_nan_is_an_empty_cell():
    """A pose without a solution has cells without text."""
    assert texts([1.5, np.nan, 2.0]) == ["1.5", "", "2.0"]


@given(st.lists(st.integers(0, 10**8 - 1), min_size=1))
def test_whole_numbers_are_written_as_by_str(values):
    """From 0 up to 10^8."""
    assert text_of([whole_words(np.array(values))]).decode()[1:].split(",") == [*map(str, values)]


def test_texts_of_any_length_stand_where_their_keys_are():
    """Letters of any script and empty texts."""
    words = ["", ";left, \N{GREEK SMALL LETTER THETA}", ";up"]
    keys = np.array([2, 0, 1, 1, 0, 2])
    found = few_words(keys, lambda i: words[keys[i]])
    assert text_of([found]).decode() == "".join(words[k] for k in keys)
