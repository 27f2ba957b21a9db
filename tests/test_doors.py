"""The doors for arguments: each kind read in one way, refused in one way."""

import numpy as np
from hostile import hostile, outcome
from hypothesis import strategies as st

from dh2urdf import doors
from dh2urdf.exceptions import ArgumentError

ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.complex_numbers(),
    st.text(max_size=8),
    st.binary(max_size=8),
    st.decimals(),
    st.fractions(),
    st.lists(st.one_of(st.floats(), st.none(), st.text(max_size=3)), max_size=4),
    st.sampled_from([10**400, object(), np.ma.masked, np.nan, np.datetime64("now"), ...]),
)


@hostile(value=ANYTHING)
def test_an_argument_is_a_float_array_or_refused_by_name(value):
    """Whatever comes in, floats or an error that names the argument come out."""
    got = outcome(doors.real_array, value, "q", "3 numbers")
    if isinstance(got, ArgumentError):
        assert str(got).startswith("q: expected 3 numbers, got ")
    else:
        assert got.dtype == np.float64
