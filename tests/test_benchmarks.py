"""The benchmarks: the short run answers rightly, the referee is strict, the README shows a run."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import dh2urdf
from benchmarks import families, machine, referee
from benchmarks.apart import do_apart
from benchmarks.arms import ARMS, arm_named
from benchmarks.clock import interleaved
from benchmarks.compare import fastest, seconds
from benchmarks.peers import IK_PEERS
from benchmarks.peers.forward import BUILDERS
from benchmarks.render import BEGIN, END, PAGES, between, shown
from benchmarks.results import LATEST, Results, Row
from benchmarks.sections import limit_rows, solver_rows
from benchmarks.targets import target_rows
from benchmarks.work.edges import EDGES

ROOT = Path(__file__).parents[1]


def ours(results, work):
    """Our rows of a piece of work."""
    return [r for r in results.of(work) if r.contestant == "dh2urdf"]


def finds_every_solution(quick):
    """Ours finds all that anybody finds, nothing wrong, with residuals at rounding."""
    for work in ("ik one, public", "ik one, bare", "ik batch"):
        rows = ours(quick, work)
        assert rows
        for row in rows:
            assert (row.recall, row.wrong) == (1.0, 0), row
            assert row.residual < 1e-9, row


def covers_every_class(quick):
    """One arm a class is solved, by one call and in a batch."""
    for work in ("ik one, public", "ik batch"):
        solved = {arm_named(r.arm).family for r in ours(quick, work)}
        assert solved >= {a.family for a in ARMS} - {"any 6R"}


def places_batches_rightly(quick):
    """FK of a batch differs from the referee by rounding only."""
    assert ours(quick, "fk batch")
    for row in ours(quick, "fk batch"):
        assert row.residual < 1e-13


def solves_the_edges(quick):
    """Every edge pose has solutions, as many as ever anybody returned for isolated ones."""
    counts = {r.arm: r.extra["solutions"] for r in ours(quick, "ik edge")}
    assert set(counts) == {e.key for e in EDGES}
    least = {
        "ur5 home": 1,
        "ur5 elbow straight": 5,
        "ur5 wrist at zero": 6,
        "puma560 stretched": 4,
        "puma560 wrist at 1e-6": 8,
        "puma560 wrist at zero": 7,
        "puma560 all zero": 7,
    }
    assert all(counts[key] >= value for key, value in least.items()), counts


def imports_no_pinocchio(quick):
    """What comes with ``import dh2urdf`` is NumPy."""
    (row,) = ours(quick, "import")
    assert row.extra.get("loaded", []) == []


def whole_processes_take_longer_than_the_interpreter(quick):
    """The processor time of a command is that of its process, in the unit of its wall time."""
    rows = {r.contestant: r for r in quick.of("process")}
    bare = rows.pop("Python itself")
    assert set(rows) >= {"convert", "extract", "fk"}
    assert all(r.processor > bare.processor > 1e-3 for r in rows.values())


def names_machine_versions_and_commit(quick):
    """A figure can be traced to what it was measured on."""
    named = {"commit", "machine", "versions", "load_average", "others", "seconds"}
    assert set(quick.about) == named
    assert quick.about["versions"].keys() >= {"numpy", "kernels", "pin"}


def names_every_peer_that_is_missing(quick):
    """A peer takes part or is left out with a reason; the Pinocchio loop takes part."""
    there = {r.contestant for r in quick.rows}
    for name in {entry.name for entry in IK_PEERS} | set(BUILDERS):
        absent = any(key == name or key.startswith(f"{name}, ") for key in quick.left_out)
        assert name in there or absent, name
    assert there >= {"dh2urdf", "Pinocchio loop"}


def test_the_short_run_answers_rightly(tmp_path):
    """``python -m benchmarks --quick`` ends well with any peers or none, and all of it is right."""
    out = tmp_path / "quick.json"
    done = subprocess.run(
        [sys.executable, "-m", "benchmarks", "--quick", "--out", str(out)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    quick = Results.load(out)
    for holds in (
        finds_every_solution,
        covers_every_class,
        places_batches_rightly,
        solves_the_edges,
        imports_no_pinocchio,
        whole_processes_take_longer_than_the_interpreter,
        names_machine_versions_and_commit,
        names_every_peer_that_is_missing,
    ):
        holds(quick)


@pytest.mark.parametrize(
    ("way", "reason"),
    [
        ("crash", "ended by SIGSEGV"),
        ("raise", "RuntimeError: no such arm"),
        ("hang", "no end after 5 s"),
    ],
)
def test_a_peer_that_breaks_its_process_is_named_and_left_out(way, reason):
    """The work is done without it; the others' rows are there once."""
    results = Results()
    assert do_apart(results, "tests.helpers.broken_work", ("bad", way), patience=5.0) == ""
    assert [row.contestant for row in results.rows] == ["good"]
    assert results.left_out == {f"bad, broken_work bad {way}": reason}


def test_what_breaks_in_our_own_hands_is_a_failure():
    """Ours is never left out: the run says what went wrong and has no rows of it."""
    results = Results()
    assert "no such arm" in do_apart(results, "tests.helpers.broken_work", ("dh2urdf", "raise"))
    assert (results.rows, results.left_out) == ([], {})


def test_referee_rejects_and_counts():
    """A wrong row is wrong, a doubled one and one a full turn away count once."""
    arm = arm_named("ur5")
    q, T = arm.draw(1)
    answer = np.vstack([q, q + 1e-9, q + 2 * np.pi, q + 1e-3])
    verdict = referee.judge(arm.table, T, [answer])
    assert (verdict.claimed, verdict.wrong, verdict.found) == (4, 1, 1)
    known = referee.truth([verdict], q)
    assert verdict.recall(known) == 1.0
    assert referee.judge(arm.table, T, [answer[3:]]).recall(known) == 0.0


def test_referee_measures_small_and_large_turns():
    """The residual of a turned pose is the angle, up to half a turn."""
    for angle in (1e-12, 1e-3, 1.0, np.pi):
        c, s = np.cos(angle), np.sin(angle)
        T = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
        found = float(referee.residuals(T[None], np.eye(4))[0])
        assert found == pytest.approx(angle, rel=1e-3)


def test_every_contestant_has_its_turn_in_every_round():
    """Interleaved blocks run equally often, once more for warming up."""
    runs = {"a": 0, "b": 0}

    def block_of(name):
        def run():
            runs[name] += 1
            return 1

        return run

    timings = interleaved({name: block_of(name) for name in runs}, 1.0, least=4, most=4)
    assert runs == {"a": 5, "b": 5}
    assert all(t.rounds == 4 and t.low <= t.median <= t.high for t in timings.values())


def test_two_parallel_axes_are_timed_against_the_general_solver():
    """A row of the comparison: the family is faster, even on a loaded machine."""
    name, ours, theirs, ratio = families.row("xarm6", 100, 0.05)
    assert name == "xarm6"
    assert float(ours.split()[0]) < float(theirs.split()[0])
    assert float(ratio) > 1.0


def test_a_peer_that_misses_solutions_is_not_the_fastest():
    """Speed counts only with nine of ten known solutions."""
    rows = [
        Row("w", "a", "careless", 1e-6, recall=0.5),
        Row("w", "a", "careful", 1e-5, recall=0.99),
        Row("w", "a", "dh2urdf", 1e-7, recall=1.0),
    ]
    assert fastest(rows).contestant == "careful"


def test_a_search_is_shown_for_what_it_is():
    """Its share of all solutions is no figure; that of the others is."""
    rows = [
        Row("ik one, public", "ur5", name, 1e-5, recall=recall, wrong=0, residual=1e-9, extra=extra)
        for name, recall, extra in (("s", 0.125, {"searches": True}), ("a", 0.5, {}))
    ]
    found = {row[1]: row[6] for row in solver_rows(Results(rows=rows))}
    assert found == {"s": "one, by search", "a": "50 %"}


def test_the_distance_from_the_limit_is_over_all_that_cannot_be_spared():
    """A ratio is the measured time over the sum of what is named."""
    parts = {"one pose": 1.2e-6, "entry": 1e-7, "batch, out": 2e-7, "arctangents": 4e-8}
    parts |= {"memory": 1e-8, "batch": 3e-7, "fresh memory": 2e-8, "fk": 2e-8, "fk: memory": 5e-9}
    results = Results(rows=[Row("limit", "ur5", name, t) for name, t in parts.items()])
    assert [row[4] for row in limit_rows(results)] == ["4 ×", "4 ×", "5 ×", "4 ×"]


def test_a_calibrated_arm_has_a_row_a_joint():
    """The peers' form of a UR5e as it left the factory is its chain, 2 mm from the nominal arm."""
    arm = arm_named("ur5e_calibrated")
    assert (arm.n, len(arm.table.rows)) == (6, 6)
    q, T = arm.draw(50)
    nominal = referee.fk(dh2urdf.load_table("ur5e"), q)
    own = dh2urdf.Robot.from_dh(ROOT / "benchmarks" / "arms" / "ur5e_calibrated.yaml").fk(q)
    assert np.abs(own - T).max() < 1e-12
    assert 5e-4 < np.linalg.norm((nominal - T)[:, :3, 3], axis=1).max() < 5e-3


def test_durations_have_three_digits_and_a_unit():
    """The unit fits the size."""
    assert [seconds(v) for v in (3.21e-8, 4.5e-6, 0.0123, 7.0, None)] == [
        "32.1 ns",
        "4.5 µs",
        "12.3 ms",
        "7 s",
        "–",
    ]


def test_results_come_back_from_their_file(tmp_path):
    """A results file holds all that a run found."""
    results = Results(True, [Row("w", "a", "b", 1.0, extra={"k": 2})], {"x": "not there"})
    results.save(tmp_path / "r.json")
    again = Results.load(tmp_path / "r.json")
    assert (again.rows, again.left_out, again.quick) == (results.rows, results.left_out, True)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.parent.name)
def test_pages_show_the_latest_results(page):
    """A page's block is what the results file renders to, letter by letter; else it is empty."""
    block = between(page.read_text())
    if not LATEST.exists():
        assert block == f"{BEGIN}{END}"
        return
    assert not json.loads(LATEST.read_text())["quick"]
    assert block == PAGES[page](shown(LATEST))


def test_a_target_is_met_or_missed_by_what_was_measured():
    """Nine times is not ten, and the page says what stands in the way."""

    def verdict(microseconds):
        results = Results(about={"others": 0.0, "versions": {"kernels": "v3 (gcc)"}})
        for name, value in (("dh2urdf", microseconds), ("EAIK", 8.0)):
            results.add(Row("ik batch", "ur5", name, value * 1e-6, threads=2))
        return next(row for row in target_rows(results) if row[0] == "the same on two threads")

    assert verdict(0.7)[2:] == ("ur5 700 ns, 11 ×", "met")
    assert verdict(0.9)[2] == "ur5 900 ns, 8.9 ×"
    assert verdict(0.9)[3].startswith("**missed**: ")


def test_what_others_used_is_what_we_did_not(monkeypatch):
    """Of five seconds that the machine worked, two are ours and three are the others'."""
    clock = {"machine": 100.0, "own": 10.0, "time": 0.0}
    monkeypatch.setattr(machine, "_machine_worked", lambda: clock["machine"])
    monkeypatch.setattr(machine, "worked", lambda: clock["own"])
    monkeypatch.setattr(machine.time, "perf_counter", lambda: clock["time"])
    watch = machine.Watch()
    clock.update(machine=105.0, own=12.0, time=4.0)
    assert watch.others() == pytest.approx(0.75)
    assert Results(about={"others": watch.others()}).busy
