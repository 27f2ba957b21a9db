"""`compare`: the same arm in other words is the same, a mistake is found and its row is named."""

import math
import re
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from dh_product import dh_frames, rigid
from example_robots import PANDA, UR5
from hypothesis import given, settings
from hypothesis import strategies as st
from mistaken import KINDS, mistake, product, rewritten, with_row
from strategies import FACTORY, tables

import dh2urdf
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.exceptions import ArgumentError, TableError, UrdfError

TABLES = dh2urdf.list_tables()
FREEDOMS = [
    {},
    {"base": True},
    {"tool": True},
    {"zeros": True},
    {"directions": True},
    {"base": True, "tool": True, "zeros": True, "directions": True},
]


def single_mistakes(count, seed=0):
    """Shipped tables, each with one mistake that makes another arm of it, if only by its zeros."""
    rng = np.random.default_rng(seed)
    while count:
        table = dh2urdf.load_table(str(rng.choice(TABLES)))
        kind = str(rng.choice(KINDS))
        made = mistake(table, kind, rng)
        if made is None:
            continue
        q = rng.uniform(-1, 1, (5, table.n))
        poses = [[dh_frames(t, x)[-1] for x in q] for t in (table, made[0])]
        if np.abs(np.subtract(*poses)).max() > 1e-4:
            count -= 1
            yield table, *made, kind


def test_200_single_mistakes_are_found_and_named_with_their_rows():
    """Each table differs, and what is said of it is what was done, in the row where it was done."""
    for table, wrong, rows, kind in single_mistakes(200):
        found = dh2urdf.compare(table, wrong)
        assert not found.equal, (table.name, kind)
        assert [m.kind for m in found.mistakes] == [kind], (table.name, kind, str(found))
        named = set(found.mistakes[0].rows)
        assert named == rows, (table.name, kind, str(found))
        assert found.differences
        assert rows <= {d.row for d in found.differences} or kind == "order of rows"
        assert found.mistakes[0].text in str(found)


def test_a_mistake_is_named_in_tables_of_other_frames():
    """Of an arm with a mistake, given by its axes alone, the row is told, or it is the same arm."""
    rng, told = np.random.default_rng(1), 0
    for table, wrong, rows, kind in single_mistakes(24, seed=3):
        other = rewritten(dh_to_chain(wrong), rng, base=True, tool=True)
        found = dh2urdf.compare(table, other)
        if not found.same:
            told += 1
            assert any(rows <= set(m.rows) for m in found.mistakes), (table.name, kind, str(found))
    assert told > 12


@pytest.mark.parametrize("freedom", FREEDOMS, ids=lambda f: " ".join(f) or "frames")
def test_the_same_arm_in_other_frames_is_the_same(freedom):
    """Every shipped arm with other base, tool, zeros, directions and frames on its axes."""
    rng = np.random.default_rng(len(freedom))
    for name in TABLES:
        a = dh_to_chain(dh2urdf.load_table(name))
        b = rewritten(a, rng, **freedom)
        found = dh2urdf.compare(a, b)
        assert found.same, (name, str(found))
        assert found.equal or freedom
        assert found.differences == found.mistakes == ()
        B, Y = (rigid(o.xyz, o.rpy) for o in (found.base, found.tool))
        for q in rng.uniform(-2, 2, (4, a.n)):
            there = q * found.directions + found.offsets
            made = B @ product(b.links, b.prismatic, there) @ Y
            assert np.abs(made - product(a.links, a.prismatic, q)).max() < 1e-9, name


@given(tables(max_joints=7), st.integers(0, 1000))
@settings(max_examples=60)
def test_random_tables_are_the_same_as_themselves_rewritten(table, seed):
    """Whatever the rows are, fixed ones, near-parallel axes and sliding joints among them."""
    a = dh_to_chain(table)
    b = rewritten(a, np.random.default_rng(seed), **FREEDOMS[-1])
    assert dh2urdf.compare(table, b).same


def test_the_other_convention_and_the_freedom_of_parallel_axes_leave_nothing_to_say():
    """A table in the other convention, and d moved from one parallel axis to the next."""
    for name in ("ur5", "franka_fer", "omron_cobra600", "stanford"):
        table = dh2urdf.load_table(name)
        other = "standard" if table.convention == "modified" else "modified"
        found = dh2urdf.compare(table, dh2urdf.to_convention(table, other))
        assert (found.equal, found.differences) == (True, ())
    ur5 = dh2urdf.load_table("ur5")
    moved = with_row(with_row(ur5, 1, d=0.3), 3, d=ur5.rows[3].d - 0.3)
    assert dh2urdf.compare(ur5, moved).equal
    assert dh2urdf.compare(FACTORY, with_row(FACTORY, 2, theta=FACTORY.rows[2].theta + 1)).same


@pytest.mark.parametrize("joint", range(6))
def test_a_zero_and_a_direction_are_stated_with_their_values(joint):
    """One joint of B has another zero, or moves the other way; nothing else is said."""
    ur5 = dh2urdf.load_table("ur5")
    theta = ur5.rows[joint].theta
    found = dh2urdf.compare(ur5, with_row(ur5, joint, theta=theta + math.radians(30)))
    assert found.up_to == (
        f"zero of joint {joint + 1}: q{joint + 1} of B = q{joint + 1} of A − 30°",
    )
    assert found.offsets[joint] == pytest.approx(-math.radians(30), abs=1e-12)
    found = dh2urdf.compare(ur5, with_row(ur5, joint, sign=-1))
    assert found.directions == tuple(-1 if k == joint else 1 for k in range(6))
    assert found.mistakes[0].text == f"row {joint + 1}: the joint moves the other way"


def test_base_and_tool_are_stated_with_their_values():
    """The flange of the Panda, and an arm that stands on a table."""
    panda = dh2urdf.load_table("franka_fer")
    found = dh2urdf.compare(panda, replace(panda, tool=dh2urdf.Origin()))
    assert found.up_to == ("tool: that of A stands at xyz (0, 0, 0.107) m in that of B",)
    assert "tool xyz (0, 0, 0.107) m in A, none in B; the tool is 0.107 m off at q = 0" in str(
        found
    )
    found = dh2urdf.compare(panda, replace(panda, base=dh2urdf.Origin((0, 0.5, 0.8))))
    assert found.base.xyz == pytest.approx((0, -0.5, -0.8))


def test_the_words_are_those_of_the_row():
    """Both values, and the way that the tool is off by them at q = 0, as the DH product has it."""
    table = dh2urdf.load_table("denso_vs6556")
    wrong = with_row(table, 2, alpha=-table.rows[2].alpha)
    line = str(dh2urdf.compare(table, wrong)).splitlines()
    line = next(text for text in line if text.startswith("  row 3"))
    pattern = (
        r"  row 3: alpha (−?)90° in A, (−?)90° in B; the tool is ([\d.]+) m and 180° off at q = 0"
    )
    signs = re.fullmatch(pattern, line)
    assert signs[1] != signs[2]
    tools = [dh_frames(t, np.zeros(6))[-1][:3, 3] for t in (table, wrong)]
    assert float(signs[3]) == pytest.approx(math.dist(*tools), abs=5e-4)


def test_other_arms_are_not_the_same():
    """Shipped arms differ from the next in the alphabet, but for those that are one arm twice."""
    alike = {"franka_fr3", *(name for name in TABLES if name.endswith("_modified"))}
    for name, other in list(pairwise(TABLES))[::2]:
        found = dh2urdf.compare(name, other)
        assert not found.same or other in alike or "rpr" in name, (name, other)
        assert found.same or found.differences
    kinds = dh2urdf.compare("planar_rr", "rpr_new_frame").differences[0]
    assert (kinds.quantity, kinds.a, kinds.b) == ("joints", "RR", "RPR")


def test_roundings_of_a_file_are_nearly_the_same():
    """1.5708 for pi/2 is told as near, with the tolerance that takes it, which then does."""
    ur5 = dh2urdf.load_table("ur5")
    rows = tuple(replace(row, alpha=round(row.alpha, 4)) for row in ur5.rows)
    rounded = replace(ur5, rows=rows, base=dh2urdf.Origin((0.1, 0, 0), (0.3, 0, 0)))
    found = dh2urdf.compare(ur5, rounded)
    assert (found.same, 1e-6 < found.max_error < 3e-5) == (False, True)
    enough = re.search(r"--tolerance (\S+) takes it", str(found))[1]
    assert dh2urdf.compare(ur5, rounded, tolerance=float(enough)).same
    assert not dh2urdf.compare("ur5", "ur5e").same


def test_robot_descriptions_and_robots_are_compared(tmp_path):
    """URDFs of others, and ours; the table that a file carries is told of by its rows."""
    assert dh2urdf.compare("franka_fer", PANDA, tip="panda_link8").equal
    found = dh2urdf.compare("ur5", UR5, base="base_link", tip="tool0")
    assert (found.same, found.up_to) == (True, ("zero of joint 1: q1 of B = q1 of A + 180°",))
    robot = dh2urdf.Robot.from_urdf(UR5, "base", "tool0")
    assert dh2urdf.compare("ur5", robot).equal
    table = dh2urdf.load_table("ur5")
    dh2urdf.write_urdf(with_row(table, 1, a=-0.4), tmp_path / "arm.urdf")
    found = dh2urdf.compare(table, tmp_path / "arm.urdf")
    assert [(d.row, d.quantity, d.a, d.b) for d in found.differences] == [(2, "a", -0.425, -0.4)]
    assert found.differences[0].tool_error == pytest.approx(0.025)


def test_forty_tables_are_marked_within_seconds(tmp_path):
    """A loop over files, half of them wrong, in processor time."""
    solution = dh2urdf.load_table("puma560")
    rng, wrong = np.random.default_rng(2), 0
    for k in range(40):
        made = mistake(solution, KINDS[k % len(KINDS)], rng) if k % 2 else None
        dh2urdf.save_table(made[0] if made else solution, tmp_path / f"{k}.yaml")
    begun = time.process_time()
    for k in range(40):
        wrong += not dh2urdf.compare(solution, tmp_path / f"{k}.yaml").equal
    assert time.process_time() - begun < 4.0
    assert wrong >= 15


def test_what_is_no_arm_is_refused_with_one_message():
    """Other objects, files that are not there, and tolerances beyond their bounds."""
    with pytest.raises(ArgumentError, match=r"arm: expected a DHTable.*got 3"):
        dh2urdf.compare("ur5", 3)
    with pytest.raises(dh2urdf.exceptions.NameNotFoundError):
        dh2urdf.compare("ur5", "ur55")
    with pytest.raises(UrdfError):
        dh2urdf.compare("ur5", "<robot/>")
    with pytest.raises(TableError):
        dh2urdf.compare("ur5", "nowhere.yaml")
    for tolerance in (0, 1, math.nan, "1"):
        with pytest.raises(ArgumentError, match="tolerance"):
            dh2urdf.compare("ur5", "ur5", tolerance=tolerance)
