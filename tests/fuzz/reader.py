"""Reads robot files for a door, each in a process forked from one that has imported the readers.

Started by :func:`forked`; a line of JSON on stdin asks, a line on stdout answers with the status.
"""

import atexit
import contextlib
import json
import os
import signal
import subprocess
import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]


@cache
def _server() -> subprocess.Popen[str]:
    path = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])
    server = subprocess.Popen(
        [sys.executable, "-m", "tests.fuzz.reader"],
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
        server = _server()
    asked = [*command[3:], cwd or os.path.dirname(command[4]), timeout]
    print(json.dumps(asked), file=server.stdin, flush=True)
    status = json.loads(server.stdout.readline())
    if status is None:
        raise subprocess.TimeoutExpired(command, timeout)
    return subprocess.CompletedProcess(command, status)


def _serve(answers) -> None:
    import mujoco  # noqa: F401
    import pinocchio  # noqa: F401
    import xacro  # noqa: F401

    def late(*_: object) -> None:
        with contextlib.suppress(ProcessLookupError):  # which has ended just now
            os.kill(child, signal.SIGKILL)

    signal.signal(signal.SIGALRM, late)
    for line in sys.stdin:
        reader, source, folder, cwd, timeout = json.loads(line)
        child = os.fork()
        if child == 0:
            _read(reader, source, folder, cwd)
        signal.setitimer(signal.ITIMER_REAL, timeout)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        left = signal.setitimer(signal.ITIMER_REAL, 0)[0]
        late = status == -signal.SIGKILL and left == 0.0
        print(json.dumps(None if late else status), file=answers, flush=True)


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

    _serve(_answers)
