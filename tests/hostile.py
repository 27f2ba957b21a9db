"""Hostile inputs: what a property over a door takes and asserts.

A door answers, or refuses with one error of the package's own tree that has something to say;
any other exception, and any warning, fails the test by itself.
"""

import time
from functools import wraps

import pytest
from hypothesis import HealthCheck, given, settings

from dh2urdf.exceptions import Dh2UrdfError

SECONDS = 10.0
"""Longest that a door may take without progress."""

SIZES = [300, pytest.param(10_000, marks=pytest.mark.exhaustive)]
"""Inputs of a door in the default suite, and in the marked one."""


def hostile(**strategies):
    """Make a test of a property: a few hundred inputs by default, ten thousand in the sweep."""

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
    """What a door answers, or the error by which it refuses; in time, and with a message."""
    start = time.monotonic()
    try:
        return call(*args, **kwargs)
    except Dh2UrdfError as error:
        message = str(error)
        assert message.strip()
        assert len(message) < 20_000
        return error
    finally:
        assert time.monotonic() - start < SECONDS
