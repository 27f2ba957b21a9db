"""The page that solves a typed table: in a real Chromium, from file://, without a network."""

import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from browser import ARTIFACTS, chromium
from conftest import HTML
from structured import random_tables

import dh2urdf
from dh2urdf import DHTable, JointType, Origin

pytest.importorskip("sphinx", reason="the page is made by the tools of the extra docs")

from docs.extensions import solver_page, wasm

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(chromium() is None, reason="no Chromium: apt-get install chromium"),
]

SOLVE = """([table, poses, within]) => {
    const solver = solverOf(withNumbers({...table}));
    if (solver.refused) return {refused: solver.refused};
    return {name: solver.name, found: poses.map(T => solver.solve(T, within))};
}"""

OPENINGS = 3
"""How often the page is opened: what else the machine does is not the page's time."""

SAME = 1e-6
"""Joint distance [rad or m] at which two solutions are one."""


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """The page as the site has it, made here where the site is not built."""
    if (HTML / solver_page.PAGE).is_file():
        return HTML / solver_page.PAGE
    if wasm.compiler() is None:
        pytest.skip("no compiler for WebAssembly: apt-get install clang lld")
    path = tmp_path_factory.mktemp("page") / solver_page.PAGE
    path.write_text(solver_page.page_text(), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def opened(browser, path):
    """The page, ready; how long it took, what it asked for and its errors."""
    context = browser.new_context(viewport={"width": 1400, "height": 860})
    context.set_offline(True)
    page = context.new_page()
    seen = SimpleNamespace(page=page, asked=[], errors=[])
    page.on("request", lambda request: seen.asked.append(request.url))
    page.on("pageerror", lambda error: seen.errors.append(str(error)))
    page.on("console", lambda said: seen.errors.append(said.text))
    seen.seconds = []
    for _ in range(OPENINGS):
        started = time.monotonic()
        page.goto(path.as_uri())
        page.wait_for_selector("body[data-ready=yes]")
        seen.seconds.append(time.monotonic() - started)
    yield seen
    context.close()
    assert [url for url in seen.asked if not url.startswith(("file:", "data:"))] == []
    assert seen.errors == []


@pytest.fixture
def page(opened):
    """The page with the arm that it begins with."""
    opened.page.evaluate("get('presets').value = 'ur5e'; start(get('presets').selectedIndex)")
    return opened.page


def picture(page, name):
    """Keep a picture among the artefacts."""
    ARTIFACTS.mkdir(exist_ok=True)
    page.screenshot(path=ARTIFACTS / f"{name}.png")


def turned_round(table):
    """The same arm from its tool to its base: rows of the other convention, in reverse order."""
    rows = [[-r.theta, -r.d, -r.a, -r.alpha] for r in reversed(table.rows)]
    other = "modified" if table.convention == "standard" else "standard"
    return DHTable.from_array(rows, convention=other)


def lacking(robot, Ts, found, task):
    """Isolated solutions of the package that the page lacks and has no doubt about."""
    turns = ~robot.slides
    for T, answer in zip(Ts, found, strict=True):
        has = np.array([s["q"] for s in answer["found"]]).reshape(-1, robot.n)
        known = robot.ik(T, within_limits=False, task=task)
        assert len(has) <= len(known) or answer["doubt"]
        assert all(s["residual"] <= 1e-9 for s in answer["found"])
        for q, free in zip(known.q, known.free_joints, strict=True):
            gaps = has - q
            gaps[:, turns] = np.remainder(gaps[:, turns] + np.pi, 2 * np.pi) - np.pi
            if not free and not answer["doubt"] and not (np.abs(gaps) <= SAME).all(axis=1).any():
                yield q


def compared(page, table, q):
    """Name of the page's solver, which found what the package finds at q (m, n)."""
    robot = dh2urdf.Robot.from_dh(table)
    Ts = robot.fk(q)
    given = [solver_page.preset(table), Ts.reshape(-1, 16).tolist(), False]
    answer = page.evaluate(SOLVE, given)
    assert "refused" not in answer, (table.name, answer)
    task = "position" if "for the position" in answer["name"] else "pose"
    assert list(lacking(robot, Ts, answer["found"], task)) == [], table.name
    return answer["name"]


def drawn(table, count, seed):
    """Configurations anywhere and, one in four, on multiples of 45 degrees [rad, m]."""
    rng = np.random.default_rng(seed)
    slides = [row.joint_type is JointType.PRISMATIC for row in table.joints]
    q = rng.uniform(-3.0, 3.0, (count, len(slides)))
    q[::4] = np.pi / 4.0 * np.round(q[::4] / (np.pi / 4.0))
    return q * np.where(slides, 0.2, 1.0)


def test_page_is_small_and_ready_in_two_seconds(opened, path):
    """It has less than a megabyte, and an arm with its solutions two seconds after it is opened."""
    assert path.stat().st_size < 1_000_000
    assert min(opened.seconds) < 2.0, opened.seconds
    assert opened.page.locator("#solutions tbody tr").count() == 8


def test_solutions_are_the_packages_for_every_arm_to_begin_with(page):
    """All isolated solutions of 40 poses, singular ones among them, where none is in doubt."""
    names = page.evaluate("page.presets.map(preset => preset.name)")
    assert len(names) > 45
    kinds = set()
    for k, name in enumerate(names):
        table = dh2urdf.load_table(name)
        kinds.add(compared(page, table, drawn(table, 40, k)))
    assert {"spherical wrist", "three parallel axes", "general 6R", "planar arm"} <= kinds


def test_arms_are_seen_from_their_tools(page):
    """Shoulders that are spherical and parallel axes at the wrist, of either convention."""
    kinds = set()
    for k, name in enumerate(("puma560", "abb_irb140_modified", "ur5", "unitree_z1", "xarm6")):
        table = turned_round(dh2urdf.load_table(name))
        kinds.add(compared(page, table, drawn(table, 20, k)))
    assert kinds == {"spherical shoulder", "three parallel axes, from the tool", "general 6R"}


def test_tables_that_people_type_are_solved_or_refused_with_the_reason(page):
    """Right angles, equal and zero lengths, signs: solved as the package does, or named useless."""
    solved = 0
    for k, table in enumerate(random_tables(60, seed=5)):
        robot = dh2urdf.Robot.from_dh(table)
        if robot.solver.name == "joints to spare":
            answer = page.evaluate(SOLVE, [solver_page.preset(table), [], False])
            assert "all six directions" in answer["refused"]
        else:
            compared(page, table, drawn(table, 8, k))
            solved += 1
    assert solved > 15


@pytest.mark.parametrize("scale", [1e-3, 40.0, 1000.0])
def test_arms_of_any_size_are_solved_in_a_unit_of_their_own(page, scale):
    """A toy and a crane have the solutions of the arm, slides among them, and true residuals."""
    for name in ("ur5", "stanford", "xarm6", "omron_cobra600"):
        table = dh2urdf.load_table(name)
        q = drawn(table, 12, 3)
        q[:, dh2urdf.Robot.from_dh(table).slides] *= scale
        rows = [
            replace(
                row,
                a=row.a * scale,
                d=row.d * scale,
                lower=None,
                upper=None,
                mass=None,
                com=None,
                inertia=None,
            )
            for row in table.rows
        ]
        other = replace(table, rows=tuple(rows), base=Origin(), tool=Origin())
        assert "refused" not in compared(page, other, q)


def test_limits_leave_out_what_they_forbid(page):
    """Within limits there are those solutions that the package has within them."""
    robot = dh2urdf.Robot.from_dh("puma560")
    Ts = robot.fk(np.stack([robot.random_configuration(k) for k in range(30)]))
    given = [solver_page.preset("puma560"), Ts.reshape(-1, 16).tolist(), True]
    found = page.evaluate(SOLVE, given)["found"]
    assert [len(answer["found"]) for answer in found] == [len(robot.ik(T)) for T in Ts]


def test_families_are_shown_inside_the_limits(page):
    """Within limits, singular solutions too, each a member of its family that is inside."""
    robot, rng = dh2urdf.Robot.from_dh("mycobot_280"), np.random.default_rng(0)
    q = 0.5 * np.pi * rng.integers(-1, 2, (60, robot.n))
    q[:, 5] = rng.uniform(-3.1, 3.1, 60)
    Ts = robot.fk(np.clip(q, robot.lower, robot.upper))
    given = [solver_page.preset("mycobot_280"), Ts.reshape(-1, 16).tolist(), True]
    found = [s for answer in page.evaluate(SOLVE, given)["found"] for s in answer["found"]]
    assert sum(bool(s["free"]) for s in found) > 30
    for s in found:
        assert s["residual"] <= 1e-9
        assert (robot.lower - SAME <= s["q"]).all(), s
        assert (s["q"] <= robot.upper + SAME).all(), s


def test_what_the_page_does_not_cover_it_refuses(page):
    """Seven joints, and three that are not parallel, have no solver here, and the page says so."""
    for name, why in (("kuka_iiwa14", "one to spare"), ("cylindrical", "other than parallel")):
        answer = page.evaluate(SOLVE, [solver_page.preset(name), [], False])
        assert why in answer["refused"]


def typed(page, label, text):
    """Type into the field of a name, and leave it."""
    field = page.get_by_label(label, exact=True)
    field.fill(text)
    field.press("Tab")


def test_a_typed_table_is_the_arm_that_is_solved(page):
    """Cells take expressions and units; the rows make the planar arm, whose elbows are two."""
    while page.locator("#fewer").is_enabled() and page.locator("#table tbody tr").count() > 3:
        page.click("#fewer")
    for i in (1, 2, 3):
        for letter, text in (("θ", "0"), ("d", "0"), ("a", f"{4 - i}00mm"), ("α", "0")):
            typed(page, f"{letter} of row {i}", text)
    assert page.locator("#solver").inner_text() == "Solver: planar arm."
    typed(page, "a of row 1", "0.9/2 m")
    typed(page, "θ of row 1", "pi/4")
    rows = page.evaluate("state.table.rows.map(row => [row.theta, row.d, row.a, row.alpha])")
    assert np.allclose(rows, [[np.pi / 4, 0, 0.45, 0], [0, 0, 0.2, 0], [0, 0, 0.1, 0]])
    assert page.locator("#count").inner_text() == "2 solutions"
    picture(page, "solver_planar")


def test_limits_that_exclude_each_other_are_refused(page):
    """The cell is marked, one line says why, and the arm keeps its limits."""
    before = page.evaluate("JSON.stringify(state.table)")
    typed(page, "upper limit of row 1", "-1000")
    says = "upper limit of row 1: the lower limit would lie above the upper one"
    assert page.locator("#fault").inner_text() == says
    assert page.evaluate("JSON.stringify(state.table)") == before


@pytest.mark.parametrize("text", ["", "1+", "(2", "2)", "alert(1)", "1e99", "90kg", "3m", "1/0"])
def test_a_cell_that_is_no_number_is_marked_and_changes_nothing(page, text):
    """One line says where; the arm stays as it was, and a number mends it."""
    before = page.evaluate("JSON.stringify(state.table)")
    typed(page, "α of row 1", text)
    assert page.locator("#fault").inner_text().startswith("α of row 1: ")
    assert page.locator("#table input.wrong").count() == 1
    assert page.evaluate("JSON.stringify(state.table)") == before
    typed(page, "α of row 1", "90")
    assert page.locator("#fault").inner_text() == ""
    assert page.locator("#table input.wrong").count() == 0


def test_a_typed_pose_is_solved_and_out_of_reach_is_said(page):
    """Chosen solutions reach it; far away there are none, and the joints stay."""
    T = np.array(page.evaluate("state.T")).reshape(4, 4)
    typed(page, "z", "400")
    page.locator("#solutions tbody tr").nth(2).click()
    reached = np.array(page.evaluate("fk(state.q)")).reshape(4, 4)
    assert np.allclose(reached[:3, 3], [*T[:2, 3].round(6), 0.4], atol=1e-6)
    assert np.allclose(reached[:3, :3], T[:3, :3], atol=1e-4)
    picture(page, "solver_solutions")
    typed(page, "x", "5 m")
    assert "out of reach" in page.locator("#count").inner_text()
    assert page.locator("#solutions tbody tr").count() == 0
    assert page.evaluate("state.q.every(Number.isFinite)")


def test_a_singular_pose_is_told_with_its_free_joints(page):
    """With its arm along axis 1 the joint is free, and the page warns that there may be more."""
    page.evaluate("get('presets').value = 'puma560'; start(get('presets').selectedIndex)")
    page.evaluate("state.q = [0, 0, -Math.PI / 2, 0, 0, 0]; aim(fk(state.q))")
    assert page.locator("#solutions tbody").inner_text().count("q₄ q₆") > 0
    picture(page, "solver_singular")


def test_base_and_tool_of_an_arm_are_told_and_taken_away(page):
    """Arms that have them say so; without them the rows alone are the arm."""
    assert not page.locator("#ends").is_visible()
    name = next(n for n in page.evaluate("page.presets.map(preset => preset.name)")
                if not np.array_equal(dh2urdf.load_table(n).tool.matrix, np.eye(4)))  # fmt: skip
    page.select_option("#presets", name)
    page.click("#bare")
    assert not page.locator("#ends").is_visible()
    bare = replace(dh2urdf.load_table(name), base=Origin(), tool=Origin())
    q = page.evaluate("state.q")
    assert np.allclose(dh2urdf.Robot.from_dh(bare).fk(q).ravel(), page.evaluate("state.T"))


def test_sliders_move_the_arm_and_its_pose(page):
    """The pose is the one of the joints, and they are among the solutions."""
    slider = page.get_by_label("q2", exact=True)
    slider.fill("-0.5")
    q = page.evaluate("state.q")
    assert abs(q[1] + 0.5) < 1e-9
    assert np.allclose(dh2urdf.Robot.from_dh("ur5e").fk(q).ravel(), page.evaluate("state.T"))
    page.click("#zero")
    assert page.evaluate("state.q.every(v => Math.abs(v) < 1e-9)")


def test_ghosts_are_drawn_in_their_colours(page):
    """Each solution's colour of its row is somewhere in the picture."""
    colours = page.evaluate(
        """() => { draw(); const {width, height} = canvas;
        const v = pen.getImageData(0, 0, width, height).data, seen = new Set();
        for (let k = 0; k < v.length; k += 4)
          seen.add((v[k] >> 4) * 256 + (v[k + 1] >> 4) * 16 + (v[k + 2] >> 4));
        return seen.size; }"""
    )
    assert colours > 20
