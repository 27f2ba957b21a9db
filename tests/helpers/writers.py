"""Writing verbs under faults: ``python tests/helpers/writers.py FOLDER TIMES SEED [VERB...]``.

Each verb is killed at so many random moments, then meets a disk that is full and a folder in which
it may not write. Runs are forked from a process that has imported everything, so that they are
killed at their work and not while Python starts. Ends with 1 and a sentence where a file was
neither the old one nor the new, or where a refusal was not one message.
"""

import contextlib
import os
import random
import resource
import shutil
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

from dh2urdf.cli import main

VERBS = {
    "convert": "convert puma560 -o a.urdf --force",
    "table": "convert puma560 -o a.toml --force",
    "mjcf": "convert planar_rr -o a.xml --force",
    "extract": "extract given.urdf -o a.yaml --force",
    "ik": "ik puma560 --csv poses.csv -o a.csv --force",
    "path": "path puma560 poses.csv -o a.csv --force",
    "figure": "figure planar_rr -o a.svg --force",
    "export": "export planar_rr -o a.h --tests t.c --force",
    "ros2": "export puma560 --ros2 puma_description --force",
    "view": "view puma560 -o a.html --force",
    "check": "check faulty.urdf --fix fixed.urdf --force",
}
"""A command line of each verb that writes files."""

MAP = "map planar_rr -o a.zarr --step 0.1 --orientations 4"
"""What appears piece by piece, and is gone on with."""

OLD = b"<!-- written before -->"


def prepare(folder: Path) -> None:
    """What the verbs read, and a folder that others may write in."""
    folder.chmod(0o777)
    os.chdir(folder)
    assert wait(start("convert puma560 -o given.urdf --force")) == 0
    text = Path("given.urdf").read_text()
    Path("faulty.urdf").write_text(text.replace('velocity="', 'velocity="-', 1))
    row = "0.4,0.1,0.3,0,3.1,0.{}\n"
    Path("poses.csv").write_text("x,y,z,roll,pitch,yaw\n" + "".join(map(row.format, range(200))))


def start(line: str, first=lambda: None) -> int:
    """Run a command line in a forked process, its messages to ``stderr``: the process."""
    process = os.fork()
    if process == 0:
        os.dup2(os.open(os.devnull, os.O_RDWR), 1)
        os.dup2(os.open("stderr", os.O_CREAT | os.O_TRUNC | os.O_WRONLY, 0o666), 2)
        try:
            first()
            main(line.split())
        except SystemExit as end:
            os._exit(int(end.code or 0))
        finally:
            os._exit(70)
    return process


def wait(process: int) -> int:
    """The status of a process, negative where a signal ended it."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def killed_after(seconds: float, process: int) -> bool:
    """Kill a process after so long; whether it was still at work."""
    time.sleep(seconds)
    os.kill(process, signal.SIGKILL)
    return wait(process) == -signal.SIGKILL


def killed_at_work(
    one: Callable[[float], bool], took: float, times: int, rng: random.Random
) -> int:
    """Try to kill at random moments of what took so long, so many times; how often it was at work.

    Where others had the processor when the time was taken, it is over sooner: then it took less.
    """
    at_work = 0
    for _ in range(10 * times):
        if at_work == times:
            break
        seconds = rng.uniform(0.0, took)
        if one(seconds):
            at_work += 1
        else:
            took = max(seconds, 0.5 * took)
    return at_work


def held() -> dict[str, bytes]:
    """Files below the folder, but for messages and what a killed run leaves beside its target."""
    paths = [path for path in Path().rglob("*") if path.is_file() and path.name != "stderr"]
    ours = [p for p in paths if not any(part.startswith(".dh2urdf-") for part in p.parts)]
    return {str(path): path.read_bytes() for path in ours}


class Writer:
    """A verb, what it writes, and how long that takes."""

    def __init__(self, verb: str) -> None:
        self.verb, self.line, before = verb, VERBS[verb], held()
        begin = time.monotonic()
        status = wait(start(self.line))
        self.took = time.monotonic() - begin
        assert status in (0, 1), f"{self.line}: status {status}: {Path('stderr').read_text()}"
        self.new = held()
        self.names = [name for name in self.new if before.get(name) != self.new[name]]
        assert self.names, f"{self.line}: wrote nothing"

    def older(self) -> None:
        """Put old files where it writes."""
        for name in self.names:
            Path(name).write_bytes(OLD)

    def whole(self, *kinds: str) -> None:
        """Nothing is missing, and each file is old or new."""
        found = held()
        assert found.keys() == self.new.keys(), f"{self.verb}: other files: {list(found)}"
        for name, content in found.items():
            kind = "new" if content == self.new[name] else "old" if content == OLD else "half"
            expected = kinds if name in self.names else ("new",)
            assert kind in expected, f"{self.verb}: {name}: {kind}, {len(content)} bytes"

    def killed(self, times: int, rng: random.Random) -> int:
        """Kill it at random moments until it was so often still at work; how often it was."""

        def one(wait_for: float) -> bool:
            self.older()
            at_work = killed_after(wait_for, start(self.line))
            self.whole("old", "new")
            return at_work

        return killed_at_work(one, self.took, times, rng)

    def refused(self, what: str, first) -> None:
        """Run it where it cannot write: one message, status 2, everything as it was."""
        self.older()
        beside = sorted(Path().rglob(".dh2urdf-*"))
        status = wait(start(self.line, first))
        said = Path("stderr").read_text()
        assert status == 2, f"{self.verb}, {what}: status {status}: {said}"
        assert "Traceback" not in said, f"{self.verb}, {what}: {said}"
        assert said.count("dh2urdf: ") == 1, f"{self.verb}, {what}: {said}"
        assert sorted(Path().rglob(".dh2urdf-*")) == beside, f"{self.verb}, {what}: left behind"
        self.whole("old")


def gone_on_with(times: int, rng: random.Random) -> int:
    """Kill a map at random moments while it is at work; begun again, it ends as if it never was."""
    begin = time.monotonic()
    assert wait(start(MAP)) == 0, Path("stderr").read_text()
    took, whole = time.monotonic() - begin, held()

    def one(wait_for: float) -> bool:
        shutil.rmtree("a.zarr")
        at_work = killed_after(wait_for, start(MAP))
        assert wait(start(MAP)) == 0, f"map: {Path('stderr').read_text()}"
        now = held()
        other = {name for name in whole.keys() | now.keys() if whole.get(name) != now.get(name)}
        assert not other, f"map: {sorted(other)}"
        return at_work

    at_work = killed_at_work(one, took, times, rng)
    shutil.rmtree("a.zarr")
    return at_work


def full() -> None:
    """A disk that takes 20 bytes of each file."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (20, 20))


@contextlib.contextmanager
def forbidden():
    """Folders in which only their owner may write, for who is not the owner."""
    folders = [path for path in [Path(), *Path().rglob("*")] if path.is_dir()]
    for folder in folders:
        folder.chmod(0o555)
    yield lambda: os.setuid(65534)
    for folder in folders:
        folder.chmod(0o777)


def tried(verb: str, times: int, rng: random.Random) -> int:
    """All faults of a verb; how often it was killed at work."""
    writer = Writer(verb)
    at_work = writer.killed(times, rng)
    for path in Path().rglob(".dh2urdf-*"):
        if path.is_file():
            path.unlink()
    writer.refused("full disk", full)
    if os.geteuid() == 0:  # who may become another user
        with forbidden() as another:
            Path("stderr").chmod(0o666)
            writer.refused("no permission", another)
    return at_work


if __name__ == "__main__":
    prepare(Path(sys.argv[1]))
    generator = random.Random(int(sys.argv[3]))
    try:
        for name in sys.argv[4:] or [*VERBS, "map"]:
            count = int(sys.argv[2])
            kills = (
                gone_on_with(count, generator) if name == "map" else tried(name, count, generator)
            )
            print(name, kills, flush=True)
    except AssertionError as fault:
        sys.exit(str(fault))
