"""The page as a file: small, whole, harmless, and never over somebody else's."""

import json
import re

import numpy as np
import pytest

from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.exceptions import ConfigurationError, OutputError, OutputExistsError
from dh2urdf.page import page_html, save_page
from dh2urdf.robots import list_tables


def data_of(page):
    """What the page knows of the arm."""
    (text,) = re.findall(r'<script type="application/json" id="arm">(.*?)</script>', page, re.S)
    return json.loads(text)


@pytest.mark.parametrize("name", list_tables())
def test_every_arm_makes_a_small_page(name):
    """Under 1 MB, with as many rows and sliders as joints and no address to load from."""
    robot = Robot.from_dh(name)
    page = page_html(robot)
    assert len(page.encode()) < 1_000_000
    data = data_of(page)
    assert [joint["name"] for joint in data["joints"]] == list(robot.joint_names)
    assert len(data["rows"]) == robot.table.n
    loads = re.sub(r'<script type="application/json".*?</script>|<footer>.*', "", page, flags=re.S)
    assert not re.search(r"https?:|//cdn|@import|url\(|\bsrc=|<link", loads)


def test_text_of_a_table_stays_text():
    """A name that closes the script or opens a tag does neither."""
    evil = "</script><script>document.title='owned'</script><!--"
    page = page_html(Robot.from_dh(DHTable((DHRow(a=1.0, name=evil),), "standard", evil)))
    assert page.count("<script") == 2
    assert data_of(page)["name"] == evil
    assert "<!--" not in page


def test_page_starts_where_it_is_told():
    """q is the start; a bad one is refused."""
    robot = Robot.from_dh("planar_rr")
    assert data_of(page_html(robot, [0.5, -0.25]))["start"] == [0.5, -0.25]
    with pytest.raises(ConfigurationError, match="joint_1, joint_2"):
        page_html(robot, [1.0])


def test_somebody_elses_page_stays(tmp_path):
    """Ours is replaced, another one with force only, and other suffixes are refused."""
    robot, path = Robot.from_dh("planar_rr"), tmp_path / "arm.html"
    save_page(robot, path)
    assert save_page(robot, path) == path
    path.write_text("<html>mine</html>")
    with pytest.raises(OutputExistsError, match="force"):
        save_page(robot, path)
    save_page(robot, path, force=True)
    assert "planar_rr" in path.read_text(encoding="utf-8")
    with pytest.raises(OutputError, match=r"\.html or \.htm"):
        save_page(robot, tmp_path / "arm.pdf")


def test_arm_without_a_table_gets_one(tmp_path):
    """A URDF's page stands on the table found for it, with the URDF's own joint names."""
    path = tmp_path / "arm.urdf"
    path.write_text(
        '<robot name="r"><link name="a"/><link name="b"/><link name="c"/>'
        '<joint name="turn" type="revolute"><parent link="a"/><child link="b"/>'
        '<origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="2" effort="1" velocity="1"/></joint>'
        '<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/>'
        '<origin xyz="0.3 0 0.1"/><axis xyz="1 0 0"/>'
        '<limit lower="0" upper="0.4" effort="1" velocity="1"/></joint></robot>'
    )
    data = data_of(page_html(Robot.from_urdf(path)))
    assert [(j["name"], j["slides"]) for j in data["joints"]] == [("turn", False), ("slide", True)]
    assert np.shape(data["tool"]) == (16,)
