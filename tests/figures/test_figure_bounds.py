"""Pictures of the longest chains, and arguments that no picture can have."""

import time

import numpy as np
import pytest

from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.bounds import JOINTS
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.figures import figure, picture_bytes, save_picture, workspace_figure


def test_a_figure_of_the_longest_chain_takes_seconds():
    """Sixty joints are drawn, labels and all, in a small part of a minute."""
    rows = [DHRow(d=0.05, a=0.05 * (i % 2), alpha=(0.5, -0.5, 0, 1)[i % 4]) for i in range(JOINTS)]
    robot = Robot.from_dh(DHTable(tuple(rows), "standard", "long"))
    start = time.process_time()
    picture_bytes(figure(robot), "png")
    assert time.process_time() - start < 30.0


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda robot: figure(robot, view=(np.nan, 0)), "view"),
        (lambda robot: figure(robot, view=(0.0, np.inf)), "view"),
        (lambda robot: figure(robot, view=(1.0,)), "view"),
        (lambda robot: figure(robot, view="x"), "view"),
        (lambda robot: workspace_figure(robot, at=np.inf), "at"),
        (lambda robot: workspace_figure(robot, at="x"), "at"),
        (lambda robot: workspace_figure(robot, rpy=[1, 2]), "rpy"),
        (lambda robot: workspace_figure(robot, rpy=[0, np.nan, 0]), "rpy"),
        (lambda robot: workspace_figure(robot, points=10**9), "points"),
        (lambda robot: workspace_figure(robot, orientations=0), "orientations"),
        (lambda robot: robot.view(port="x"), "port"),
        (lambda robot: robot.view(port=10**30), "port"),
        (lambda robot: robot.view(host="x" * 300, port=0), "host"),
        (lambda robot: save_picture(figure(robot), "x.png", dpi=np.nan), "dpi"),
        (lambda robot: save_picture(figure(robot), "x.png", dpi=1e9), "dpi"),
    ],
)
def test_arguments_of_pictures_are_refused_by_name(call, word, tmp_path, monkeypatch):
    """What is not finite, of another shape or beyond its bounds is named; nothing is written."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Dh2UrdfError, match=word):
        call(Robot.from_dh("puma560"))
    assert list(tmp_path.iterdir()) == []
