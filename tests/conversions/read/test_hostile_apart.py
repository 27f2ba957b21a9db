"""Any xacro and any MJCF: an arm, or one message in time.

The readers run in a process of their own. Here it is forked from one that has imported them, so
that hundreds of files are quick.
"""

import os
import re
import select
import subprocess
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import mujoco  # noqa: F401
import pinocchio  # noqa: F401
import pytest
import xacro  # noqa: F401
from hostile import hostile, outcome
from hypothesis import strategies as st
from test_hostile_robots import MJCF, TEXTS

from dh2urdf import extract_dh
from dh2urdf.conversions.read import apart

SECONDS = 3
XACRO = (
    "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'>{}<link name='a'/><link name='b'/>"
    "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='0 0 {}'/>"
    "<axis xyz='{}'/><limit lower='{}' upper='1' effort='1' velocity='1'/></joint></robot>"
)
TERMS = [
    *("1", "0.5", "pi", "h", "nope", "h.x", '""', "[1]", "{}", "1/0", "sin(1)", "-", "None"),
    *("9**9", '"a"*9', "__import__", "().__class__", "lambda: 1", "range(9)", 'load_yaml("x")'),
]
TERM = st.lists(st.sampled_from(TERMS), min_size=1, max_size=3).map(" + ".join)
COMPUTED = st.one_of(TERM.map("${{{}}}".format), TERM.map("$(eval {})".format))
PLAIN = st.sampled_from(
    [t for t in TEXTS if "<" not in t] + ["$(arg x)", "$(find x)", "${", "$(", "$$"]
)
VALUE = st.one_of(COMPUTED, PLAIN)
EXTRAS = [
    *("<xacro:property name='h' value='{}'/>", "<xacro:arg name='x' default='{}'/>", "<xacro:h/>"),
    *("<xacro:if value='{}'><link name='c'/></xacro:if>", "<xacro:include filename='{}'/>"),
    *(
        "<xacro:macro name='m' params='p:={}'/>",
        "<xacro:m p='{}'/>",
        "<xacro:insert_block name='{}'/>",
    ),
]
EXTRA = st.lists(st.tuples(st.sampled_from(EXTRAS), VALUE), max_size=3)
CHANGES = st.lists(st.tuples(st.integers(0, 40), st.sampled_from(TEXTS)), min_size=1, max_size=3)


def forked(command, *, timeout, cwd, **_):
    """A process that reads as `apart` does, and no end after its time."""
    ready, done = os.pipe()
    with warnings.catch_warnings(action="ignore", category=DeprecationWarning):
        child = os.fork()  # which Python 3.12 advises against beside threads
    if child == 0:
        status = 3
        try:
            for stream in range(3):
                os.dup2(os.open(os.devnull, os.O_RDWR), stream)
            os.chdir(cwd or os.getcwd())
            status = apart._main(*command[3:])
        finally:
            os._exit(status)
    os.close(done)
    late = not select.select([ready], [], [], timeout)[0]
    if late:
        os.kill(child, 9)
    os.close(ready)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    if late:
        raise subprocess.TimeoutExpired(command, timeout)
    return subprocess.CompletedProcess(command, code)


@pytest.fixture(autouse=True, scope="module")
def _quick():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(apart.subprocess, "run", forked)
        patch.setattr(apart, "APART_SECONDS", SECONDS)
        yield


def read(text, suffix):
    """What extraction makes of a file with this text."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"arm{suffix}"
        path.write_text(text, encoding="utf-8", errors="replace")
        found = outcome(extract_dh, path)
        assert [p.name for p in Path(folder).iterdir()] == [path.name]
        return found


@hostile(extra=EXTRA, z=VALUE, axis=VALUE, lower=VALUE)
def test_any_xacro_is_an_arm_or_refused(extra, z, axis, lower):
    """Expressions, arguments, macros and texts of every kind, where xacro evaluates them."""
    body = "".join(what.replace("{}", value) for what, value in extra)
    read(XACRO.format(body, z, axis, lower), ".xacro")


@hostile(changes=CHANGES)
def test_any_mjcf_is_an_arm_or_refused(changes):
    """A value in place of any attribute's."""
    places = list(re.finditer(r"'([^']*)'", MJCF))
    text = MJCF
    for k, value in sorted(changes, reverse=True):
        place = places[k % len(places)]
        text = text.replace(place[0], "'" + value.replace("<", "&lt;") + "'", 1)
    read(text, ".xml")
