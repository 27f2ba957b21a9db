"""The guard itself: it sees what no input may bring about."""

import os
import pickle
import socket
import subprocess
import time
import warnings
from pathlib import Path

import pytest

from tests.fuzz import guard
from tests.fuzz.guard import FaultError, watched


def swallowed():
    """A file outside, of which the error is caught."""
    try:
        Path("/tmp/outside").write_text("x")
    except Exception:
        return


def connect():
    """A connection to this machine."""
    with socket.socket() as made:
        made.connect(("127.0.0.1", 9))


BREACHES = {
    "network: socket.connect": lambda _: connect(),
    "network: socket.getaddrinfo": lambda _: socket.getaddrinfo("localhost", 80),
    "a process: subprocess.Popen": lambda _: subprocess.run(["true"], check=False),
    "a process: os.system": lambda _: os.system("true"),
    "code from data: <code object": lambda _: eval("1 + 1"),
    "code from data: pickle": lambda _: pickle.loads(pickle.dumps(Path("x"))),
    "outside the folder: /tmp/outside": lambda _: swallowed(),
    "left behind": lambda folder: (folder / "x").write_text("x"),
    "no end after": lambda _: time.sleep(4),
}


@pytest.mark.parametrize("says", BREACHES)
def test_what_no_input_may_bring_about_is_a_fault(says, tmp_path, monkeypatch):
    """Each is told, also where the package itself would have caught the error."""
    monkeypatch.setattr(guard, "SECONDS", 0.5)
    with pytest.raises(FaultError, match=says), watched(tmp_path):
        BREACHES[says](tmp_path)


@pytest.mark.parametrize("others", [True, False])
def test_waiting_is_a_fault_but_not_for_the_processor(tmp_path, monkeypatch, others):
    """A door that waits for anything hangs; time that others have is not its own."""
    monkeypatch.setattr(guard, "SECONDS", 0.05)
    monkeypatch.setattr(guard, "PATIENCE", 2)
    if others:
        monkeypatch.setattr(guard, "starved", time.monotonic)
        with watched(tmp_path):
            time.sleep(0.3)
    else:
        with pytest.raises(FaultError, match="no end"), watched(tmp_path):
            time.sleep(10.0)


def test_a_process_that_was_stopped_does_not_hang(tmp_path, monkeypatch):
    """Time in which a process was stopped, such as on a machine that sleeps, is not its own."""
    monkeypatch.setattr(guard, "SECONDS", 0.5)
    clock = iter([0.0])
    monkeypatch.setattr(guard.time, "monotonic", lambda: next(clock, 1000.0))
    with watched(tmp_path):
        time.sleep(0.6)


def test_a_warning_is_an_error_under_guard(tmp_path):
    """No door warns."""
    with pytest.raises(UserWarning), watched(tmp_path):
        warnings.warn("x", stacklevel=1)


def test_memory_is_measured(tmp_path, monkeypatch):
    """A process that grows by more than is allowed over one input is told."""
    monkeypatch.setattr(guard, "GROWTH", 200_000)
    with pytest.raises(FaultError, match="MB of memory"), watched(tmp_path):
        b"".join([b"x" * 10**6] * 600)
