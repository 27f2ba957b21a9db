"""Reads robot files for a door, each in a process forked from one that has imported the readers.

Started by :func:`forked`; a line of JSON on stdin asks, a line on stdout answers with the status.
"""

import atexit
import contextlib
import gc
import json
import os
import signal
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
XACRO = "xmlns:xacro='http://ros.org/wiki/xacro'"


@cache
def _server(reader: str) -> subprocess.Popen[str]:
    """The process of a reader, which has imported what that needs and no more."""
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    server = subprocess.Popen(
        [sys.executable, "-m", "tests.fuzz.reader", reader],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
        cwd=ROOT,
    )
    atexit.register(server.kill)
    return server


def forked(command, *, timeout, cwd, **_):
    """What ``subprocess.run`` does for `apart`, without starting Python anew."""
    from tests.fuzz.guard import unwatched

    with unwatched():
        server = _server(command[3])
    asked = [*command[3:], cwd or os.path.dirname(command[4]), timeout]
    print(json.dumps(asked), file=server.stdin, flush=True)
    status = json.loads(server.stdout.readline())
    if status is None:
        raise subprocess.TimeoutExpired(command, timeout)
    return subprocess.CompletedProcess(command, status)


def _serve(answers, reader: str) -> None:
    _warm(reader)

    def late(*_: object) -> None:
        with contextlib.suppress(ProcessLookupError):  # which has ended just now
            os.kill(child, signal.SIGKILL)

    signal.signal(signal.SIGALRM, late)
    for line in sys.stdin:
        source, folder, cwd, timeout = json.loads(line)[1:]
        child = os.fork()
        if child == 0:
            _read(reader, source, folder, cwd)
        signal.setitimer(signal.ITIMER_REAL, timeout)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        left = signal.setitimer(signal.ITIMER_REAL, 0)[0]
        late = status == -signal.SIGKILL and left == 0.0
        print(json.dumps(None if late else status), file=answers, flush=True)


def _warm(reader: str) -> None:
    """Read a file here, so that all that this imports is there when one is forked."""
    from dh2urdf.conversions.read import apart

    given = Path("given")
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        given.write_text(json.dumps(apart.NOTHING))
        if reader == "xacro":
            inner = "<xacro:if value='${1}'/><link name='${1 + 1}'/>"
            Path("arm.xacro").write_text(f"<robot name='r' {XACRO}>{inner}</robot>")
            apart._xacro("arm.xacro", Path())
        else:
            Path("arm.xml").write_text("<mujoco><worldbody/></mujoco>")
            with contextlib.suppress(Exception):  # an arm without joints is none
                apart._mjcf("arm.xml", Path())
    gc.freeze()


def _read(reader: str, source: str, folder: str, cwd: str) -> None:
    """Read as `apart` does; the process ends with its status."""
    from dh2urdf.conversions.read import apart

    status = 3
    try:
        os.chdir(cwd)
        status = apart._main(reader, source, folder)
    finally:
        os._exit(status)


if __name__ == "__main__":
    _answers = os.fdopen(os.dup(1), "w")
    for _stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_RDWR), _stream)
    import dh2urdf.conversions.read.apart  # noqa: F401, once for all

    _serve(_answers, sys.argv[1])
