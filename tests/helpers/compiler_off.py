"""A plugin (``-p tests.helpers.compiler_off``): the suite with kernels that run interpreted.

Floating-point errors in kernels are warnings, which are errors here as everywhere in the suite.
Lines of kernels that ran are added to the file that ``KERNEL_LINES`` names. Kernels are hundreds
of times slower so: a test that takes longer than ``KERNEL_SECONDS``, 30 by default, is skipped and
says so; what it had reached counts. ``python -m tests.translate.probes`` tells the lines.
"""

import os
import signal

import pytest

os.environ["DH2URDF_ENGINE"] = "python"

SECONDS = float(os.environ.get("KERNEL_SECONDS", "30"))


def pytest_sessionstart():
    """Mark the kernels before any test runs."""
    from tests.translate import probes

    probes.mark_all()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call():
    """Let a test run for so long, of this process's time."""

    def late(*_):
        pytest.skip(f"more than {SECONDS:g} s interpreted")

    was = signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, SECONDS)
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, was)


def pytest_sessionfinish():
    """Add what ran."""
    if file := os.environ.get("KERNEL_LINES"):
        from pathlib import Path

        from tests.translate import probes

        probes.add(Path(file))
