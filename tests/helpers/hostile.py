"""Hostile inputs: what a property over a door takes and asserts.

A door answers, or refuses with one error of the package's own tree that has something to say;
any other exception, and any warning, fails the test by itself.
"""

import time
from fractions import Fraction
from functools import wraps

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from dh2urdf.exceptions import Dh2UrdfError

SECONDS = 10.0
"""Longest that a door may take without progress."""

SIZES = [100, pytest.param(10_000, marks=pytest.mark.exhaustive)]
"""Inputs of a door in the default suite, and in the marked one."""


def hostile(**strategies):
    """Make a test of a property: a hundred inputs by default, ten thousand in the sweep."""

    def decorate(check):
        @pytest.mark.parametrize("inputs", SIZES)
        @wraps(check, assigned=("__name__", "__doc__", "__module__"), updated=())
        def test(inputs):
            quiet = list(HealthCheck)
            run = settings(max_examples=inputs, deadline=None, suppress_health_check=quiet)
            run(given(**strategies)(check))()

        del test.__wrapped__  # pytest would read the property's arguments as fixtures
        return test

    return decorate


def outcome(call, *args, **kwargs):
    """What a door answers, or the error by which it refuses; in time, and with a message.

    The time is that of the processor. A first call may have compiled kernels, which is told to
    the user; the second shows what a call takes.
    """
    found, seconds = _timed(call, *args, **kwargs)
    if seconds > SECONDS:
        found, seconds = _timed(call, *args, **kwargs)
    assert seconds < SECONDS
    if isinstance(found, Dh2UrdfError):
        assert 0 < len(str(found).strip()) < 20_000
    return found


def _timed(call, *args, **kwargs):
    start = time.process_time()
    try:
        found = call(*args, **kwargs)
    except Dh2UrdfError as error:
        found = error
    return found, time.process_time() - start


SHAPES = [(), (0,), (1,), (2,), (3,), (6,), (7,), (3, 3), (4, 4), (0, 4, 4), (2, 4, 4), (2, 6)]


class Unspeakable:
    """An object whose every answer is an exception."""

    def __repr__(self):
        raise RuntimeError("no repr")

    __bool__ = __len__ = __iter__ = __eq__ = __float__ = __index__ = __array__ = __repr__
    __hash__ = object.__hash__


ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(-3, 9),
    st.floats(),
    st.floats(-3, 3),
    st.complex_numbers(),
    st.text(max_size=8),
    st.binary(max_size=8),
    st.decimals(),
    st.fractions(),
    st.lists(st.one_of(st.floats(), st.none(), st.text(max_size=3), st.integers()), max_size=7),
    st.dictionaries(st.text(max_size=3), st.floats(), max_size=2),
    st.sampled_from([10**400, -(10**400), Fraction(10**400), 10**30, 1e300, np.inf, np.nan]),
    st.sampled_from([object(), np.ma.masked, np.datetime64("now"), ..., Unspeakable()]),
    st.sampled_from(["nan", "inf", "x" * 5000, "\ud800", "\0", "../..", "1", "True"]),
    st.builds(np.zeros, st.sampled_from(SHAPES), st.sampled_from(["f8", ">f8", "i4", "c16", "O"])),
    st.builds(np.full, st.sampled_from(SHAPES), st.sampled_from([np.nan, 1e300, 1.0, -1e9])),
    st.builds(np.ma.masked_all, st.sampled_from(SHAPES)),
)
"""Values of every kind that a caller might mistake for what an argument takes."""
