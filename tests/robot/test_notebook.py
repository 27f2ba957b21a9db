"""What a notebook shows of a robot and of what it answers."""

import html
import re

import numpy as np
import pytest

import dh2urdf
from dh2urdf.page import page_html


def test_a_robot_shows_its_page_in_a_frame():
    """The frame's document, unescaped, is the page that `view -o` writes."""
    robot = dh2urdf.Robot.from_dh("planar_rr")
    bundle = robot._repr_mimebundle_()
    assert bundle["text/plain"] == repr(robot)
    srcdoc = re.fullmatch(r'<iframe srcdoc="([^"]*)"[^>]*></iframe>', bundle["text/html"])
    assert html.unescape(srcdoc[1]) == html.unescape(page_html(robot))
    assert list(robot._repr_mimebundle_(include={"text/plain"})) == ["text/plain"]
    assert list(robot._repr_mimebundle_(exclude={"text/html"})) == ["text/plain"]


@pytest.mark.parametrize(("name", "unit"), [("ur5", "\N{DEGREE SIGN}"), ("gantry_wrist", "mm")])
def test_solutions_are_a_table_in_degrees_and_millimetres(name, unit):
    """A row for each solution, its joint values in the unit of the heading."""
    robot = dh2urdf.Robot.from_dh(name)
    q = 0.5 * (robot.lower + robot.upper) + 0.1
    found = robot.ik(robot.fk(q), within_limits=False)
    text = found._repr_html_()
    assert text.count("<tr>") == 1 + len(found)
    assert f"{robot.joint_names[0]} [{unit}]" in text
    shown = np.where(robot.slides, 1000.0 * found.q, np.degrees(found.q))[0, 0]
    assert f">{shown.round(3):g}".replace("-", "\N{MINUS SIGN}") in text


def test_no_solution_and_free_joints_are_said():
    """An empty answer is a sentence; the free joints of a singular family have their names."""
    robot = dh2urdf.Robot.from_dh("puma560")
    far = np.eye(4)
    far[0, 3] = 9.0
    assert robot.ik(far)._repr_html_() == "<p>no solution</p>"
    found = robot.ik(robot.fk([0.3, -1.0, 1.0, 0.4, 0.0, 0.2]), within_limits=False)
    free = ", ".join(robot.joint_names[j] for j in (3, 5))
    assert f"free: {free}" in found._repr_html_()


def test_formulas_show_as_markdown():
    """Every block of formulas stands between two pairs of dollar signs."""
    pytest.importorskip("sympy")
    text = dh2urdf.Robot.from_dh("planar_rr").symbolic_ik()._repr_markdown_()
    assert text.count("$$") == 2 * text.count(r"\begin{aligned}") > 0
