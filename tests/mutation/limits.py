"""A plugin: a test that takes a minute of processor time, compiled code too, ends the process."""

import signal

import pytest

SECONDS = 60


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol():
    """Let a test run for so long."""
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
