"""The doors for arguments: each kind read in one way, refused in one way."""

import numpy as np
from hostile import ANYTHING, hostile, outcome

from dh2urdf import doors
from dh2urdf.exceptions import ArgumentError


@hostile(value=ANYTHING)
def test_an_argument_is_a_float_array_or_refused_by_name(value):
    """Whatever comes in, floats or an error that names the argument come out."""
    got = outcome(doors.real_array, value, "q", "3 numbers")
    if isinstance(got, ArgumentError):
        assert str(got).startswith("q: expected 3 numbers, got ")
    else:
        assert got.dtype == np.float64
