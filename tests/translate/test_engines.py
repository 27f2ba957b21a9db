"""All forms of the kernels give the same bits for the same calls."""

import ctypes
from collections import Counter
from functools import cache

import numpy as np
import pytest

from dh2urdf.engine import INTERPRETED
from dh2urdf.translate.build import LEVELS, PLACE
from tests.translate import engines, replay, workload
from tests.translate.record import call, differing, interpreted, leaves, recorded

USUAL = ("gcc sanitized", "clang -O2", "zig -O3", "aarch64 -O3", "wasm32 -O2")
"""What the daily suite compiles, where the tools are there."""

ARMS = """
abb_irb120 abb_irb120~ abb_irb460 abb_irb4600_track abb_irb5400 cylindrical fanuc_crx10ia
fanuc_r1000ia80f franka_fer gantry kinova_gen3 planar_rr stanford ur5 ur5~ ur10e~ xarm5 xarm7
"""
"""Arms that need all of the entries, with our own."""

COUNT = 16
"""Configurations of each arm."""

MOST, OF_ALL = 6, 60
"""Calls of an entry that are kept for each arm, every day and of all arms."""

FAMILIES = """
abb_irb120 cylindrical fanuc_crx10ia gantry kuka_iiwa7 planar_rr stanford unitree_z1 ur5 ur5~ xarm5
"""
"""An arm of each family, and what watches over many of its poses."""

WATCHERS = ("gcc sanitized", "clang sanitized", "clang filled with NaN")

POSES, PARTS = 10_000, 50
"""Poses of each family, in parts whose calls fit into memory."""

SLOW = {
    "finish_followers_48": 1,
    "finish_followers_16": 4,
    "try_followers_48": 2,
    "sample_followers": 3,
    "finish_general_6r": 5,
    "solve_two_parallel": 2,
    "referee_doubtful": 2,
    "search_doubtful": 5,
    "search_poses": 1,
    "search_valleys": 1,
    "search_starts": 1,
    "search_known": 1,
    "follow_candidates": 1,
    "widen_wrists": 2,
    "widen_parallel": 1,
    "add_curves": 3,
    "onward": 1,
    "find_starts": 1,
    "sweep_pose": 1,
    "enter_all": 2,
    "nearest_of": 12,
    "walk_family": 4,
    "on_one_family": 2,
    "nearest_members": 9,
}
"""Entries that take seconds interpreted, and how many calls of them the daily suite has: those with
the smallest arguments, one pose before a batch, reach nearly all lines that the others do."""


@cache
def calls(whole=False):
    """Calls of all entries while arms answer: some of some, or most."""
    kept, chosen = (
        Counter(),
        workload.arms() if whole else [*ARMS.split(), *workload.OWN, "numbers"],
    )
    arm = ""

    def keep(name, _):
        kept[arm, name] += 1
        return kept[arm, name] <= (OF_ALL if whole else MOST)

    with recorded(keep) as found:
        for arm in chosen:
            for _ in workload.answers(arm, COUNT):
                pass
    return found


def check(found, after, least=1):
    """No number differs from what was recorded; tell the entries in which some do."""
    total = sum(x.size for row in after for x in row if hasattr(x, "size"))
    apart = Counter()
    for one, other in zip(found, after, strict=True):
        if n := differing(one.after, other):
            apart[one.entry] += n
    print(f"{len(found)} calls, {len({c.entry for c in found})} entries, {total} numbers", end=" ")
    assert not apart
    assert total >= least


def test_every_entry_is_called():
    """No entry is left out of the calls that are compared."""
    assert {one.entry for one in calls()} == set(INTERPRETED)


def by_python(some):
    """What the kernels as they are written leave behind calls."""
    with interpreted():
        return [call(INTERPRETED[one.entry], one.entry, one.given).after for one in some]


def daily(name, row):
    """The calls of an entry that the daily suite has interpreted."""
    if most := SLOW.get(name.rpartition(".")[2]):
        return sorted(row, key=lambda one: sum(np.size(x) for x in leaves(one.given)))[:most]
    return row[:: -(-len(row) // 18)]


@pytest.mark.parametrize("part", range(3))
def test_interpreted_kernels_agree(part):
    """The kernels as they are written, line by line in Python, on a part of the calls."""
    found = calls()  # which imports kernels
    some = [
        one
        for name in sorted(INTERPRETED)[part::3]
        for one in daily(name, [one for one in found if one.entry == name])
    ]
    check(some, by_python(some))


def by_level(level, some, folder):
    """What a level of the extension leaves behind calls."""
    program = ctypes.CDLL(str(replay.built(folder, replay.cc(), "replay.so", "-shared", "-fPIC")))
    extension = ctypes.CDLL(str(PLACE))
    if not getattr(extension, f"has_{level}")():
        pytest.skip("the processor has not got it")
    table = ctypes.c_char.in_dll(extension, f"entries_{level}")
    replay.written(some, folder / "calls")
    paths = (str(folder / name).encode() for name in ("calls", "after"))
    assert program.replay(ctypes.byref(table), *paths) == 0
    return replay.answers(some, folder / "after")


@pytest.mark.parametrize("level", LEVELS)
def test_levels_of_the_extension_agree(level, tmp_path):
    """The extension that is installed, as it is for each kind of processor."""
    check(calls(), by_level(level, calls(), tmp_path))


@pytest.mark.parametrize("name", USUAL)
def test_compilers_agree(name, tmp_path):
    """Programs of other compilers, of other processors, and with sanitizers."""
    check(calls(), engines.replayed(name, calls(), tmp_path))


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", engines.TABLE)
def test_compilers_agree_on_all_arms(name, tmp_path):
    """The same for every compiler, many calls of all arms."""
    check(calls(True), engines.replayed(name, calls(True), tmp_path))


@pytest.mark.exhaustive
@pytest.mark.parametrize("level", LEVELS)
def test_levels_agree_on_all_arms(level, tmp_path):
    """The same for the levels of the extension."""
    check(calls(True), by_level(level, calls(True), tmp_path))


@pytest.mark.exhaustive
def test_interpreted_kernels_agree_on_all_calls():
    """All calls of the daily suite."""
    check(calls(), by_python(calls()))


def batch(arm, part):
    """Calls while an arm answers for many poses at once, of which this is a part."""
    robot = workload.robot_of(arm)
    poses = workload.poses_of(robot, workload.configurations(robot, POSES, "many"))[part::PARTS]
    with recorded(lambda *_: True) as found:
        workload.robot_of(arm).ik_batch(poses, threads=1)
    return found


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", WATCHERS)
@pytest.mark.parametrize("arm", FAMILIES.split())
def test_nothing_undefined_in_many_poses(arm, name, tmp_path):
    """Sanitizers find nothing, and memory that nobody wrote decides nothing."""
    for part in range(PARTS):
        found = batch(arm, part)
        check(found, engines.replayed(name, found, tmp_path))
