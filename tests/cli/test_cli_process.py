"""The command line as a process: interrupted, without a stdout, on a terminal without signs."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from dh2urdf import cli

IK = ["ik", "ur5", "--xyz", "0.4", "0.2", "0.3", "--rpy", "0", "3", "0"]
LONG = ["workspace", "ur5", "-o", "x.png", "--points", "200", "--orientations", "1000"]
START = """
import sys, dh2urdf.cli as cli
begin = cli._open_streams
cli._open_streams = lambda: (begin(), print(end="go", flush=True))
cli.main(sys.argv[1:])
"""


HEAD = "convention: standard\nunits: {length: m, angle: deg}\n"


def shell(command, **environment):
    """Run a command of the shell, in which ``dh2urdf`` stands for the command line."""
    command = command.replace("dh2urdf", f"{sys.executable} -m dh2urdf")
    streams = {"capture_output": True, "text": True, "encoding": "utf-8"}
    env = {**os.environ, **environment}
    return subprocess.run(command, shell=True, check=False, env=env, **streams)


def begun(code, *argv, cwd=None):
    """A process of this Python that has said that it is going."""
    command, pipe = [sys.executable, "-c", code, *argv], subprocess.PIPE
    process = subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, cwd=cwd)
    assert process.stdout.read(2) == "go"
    return process


@pytest.mark.parametrize("argv", [IK, LONG], ids=["ik", "workspace"])
def test_an_interrupt_at_any_moment_is_one_word_and_status_130(argv, tmp_path):
    """Once `main` has begun, Ctrl-C ends the process with one word and leaves no file."""
    for moment in (0.0, 0.003, 0.01, 0.02, 0.04, 0.06, 0.09, 0.13, 0.18, 0.25):
        process = begun(START, *argv, cwd=tmp_path)
        time.sleep(moment)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
        finished = argv is IK and process.returncode == 0
        assert finished or (process.returncode, err) == (130, "interrupted\n")
        assert list(tmp_path.iterdir()) == []


SWALLOW = """
import time, dh2urdf.cli as cli
def run(tokens):
    print(end="go", flush=True)
    try:
        time.sleep(60)
    except BaseException:
        pass
    time.sleep(60)
cli._run = run
cli.main(["ik"])
"""

LOSE = """
import time, dh2urdf.cli as cli
class Slow:
    def __del__(self):
        time.sleep(60)
def run(tokens):
    print(end="go", flush=True)
    Slow()
    time.sleep(60)
cli._run = run
cli.main(["ik"])
"""


def test_a_library_that_cannot_be_loaded_is_one_message(tmp_path):
    """Where Pinocchio lacks a system library, as on slim images, that is named."""
    (tmp_path / "pinocchio.py").write_text(
        "raise ImportError('libgomp.so.1: cannot open shared object file: No such file')"
    )
    done = shell("dh2urdf fk ur5 0 0 0 0 0 0", PYTHONPATH=f"{tmp_path}:{os.getcwd()}")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("dh2urdf: a library cannot be loaded: libgomp.so.1")
    assert done.stderr.endswith("apt-get install libgomp1\n")


@pytest.mark.parametrize("code", [SWALLOW, LOSE], ids=["except", "callback"])
def test_an_interrupt_that_is_lost_on_its_way_comes_again(code):
    """A bare ``except``, or a callback that cannot raise, delays Ctrl-C by a second, no more."""
    process = begun(code)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=50)
    assert (process.returncode, err) == (130, "interrupted\n")


def test_a_program_that_calls_the_command_line_keeps_its_signals():
    """Handlers of Ctrl-C and the alarm are those of before; a timer of the program's runs on."""
    numbers = signal.SIGINT, signal.SIGALRM
    before = [signal.getsignal(number) for number in numbers]
    with pytest.raises(SystemExit):
        cli.main(["list"])
    assert [signal.getsignal(number) for number in numbers] == before
    signal.setitimer(signal.ITIMER_REAL, 1000.0)
    try:
        with pytest.raises(SystemExit):
            cli.main(["list"])
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 0.0
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


@pytest.mark.parametrize("verb", ["list", "list --json", "convert ur5 -o -", "show ur5", "--help"])
@pytest.mark.parametrize("place", ["> /dev/full", ">&-"])
def test_a_stdout_that_cannot_be_written_is_one_message(verb, place):
    """A full disk and a closed stdout: status 2 and one line on stderr."""
    done = shell(f"dh2urdf {verb} {place}")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("dh2urdf: standard output: ")
    assert done.stderr.count("\n") == 1


def test_a_stderr_that_cannot_be_written_changes_no_status(tmp_path):
    """A message that nobody can read is lost, and the status says what happened."""
    arm, urdf = tmp_path / "arm.yaml", tmp_path / "arm.urdf"
    arm.write_text(HEAD + "joints: [{d: 0, a: 30, alpha: 0}]\n")
    assert "warning" in shell(f"dh2urdf convert {arm} -o {urdf}").stderr
    urdf.unlink()
    for line, status in (("fk nope", 2), (f"convert {arm} -o {urdf}", 0), ("fk ur5 x", 2)):
        assert shell(f"dh2urdf {line} 2> /dev/full").returncode == status
    assert urdf.exists()


def test_closed_stdin_and_stderr_do_not_disturb():
    """Without stderr the answer is complete; without stdin the source is said to be empty."""
    assert shell("dh2urdf convert ur5 -o - 2>&-").stdout.endswith("</robot>\n")
    done = shell("dh2urdf convert - <&-")
    assert (done.returncode, done.stdout) == (2, "")
    assert "empty" in done.stderr


def test_a_terminal_without_our_signs_shows_their_spelling(tmp_path):
    """In ASCII a minus is a hyphen, JSON keeps every name, and nothing fails."""
    table = "name: größe\nconvention: standard\nunits: {length: m, angle: deg}\njoints:\n"
    (tmp_path / "a.yaml").write_text(table + "  - {theta: 0, d: -0.5, a: 0, alpha: 0}\n", "utf-8")
    for environment in ({"PYTHONIOENCODING": "ascii"}, {"LC_ALL": "C", "PYTHONUTF8": "0"}):
        done = shell(f"dh2urdf fk {tmp_path}/a.yaml 0", **environment)
        assert done.returncode == 0
        assert "xyz [m]: 0  0  -0.5" in done.stdout.replace("\N{MINUS SIGN}", "-")
        done = shell(f"dh2urdf show {tmp_path}/a.yaml --json", **environment)
        assert json.loads(done.stdout)["name"] == "größe"
        for verb in ("list", "--help", "ik ur5 --help", "show ur5", f"show {tmp_path}/a.yaml"):
            done = shell(f"dh2urdf {verb}", **environment)
            assert (done.returncode, done.stderr) == (0, "")
