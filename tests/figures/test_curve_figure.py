"""The plot of what an elimination leaves."""

import numpy as np

import dh2urdf
from dh2urdf.figures import curve_figure


def test_every_real_root_is_a_dot_on_the_line():
    """As many dots as the step has roots, at their angles, and the line crosses zero there."""
    robot = dh2urdf.Robot.from_dh("xarm6")
    told = robot.explain_ik(robot.fk([0.3, -0.4, -0.5, 1.2, 0.7, -0.3]))
    curve = next(step.curve for step in told.steps if step.curve)
    figure = curve_figure(curve)
    _, line, dots = figure.axes[0].lines
    assert np.allclose(dots.get_xdata(), np.degrees(curve.roots))
    heights = np.interp(dots.get_xdata(), line.get_xdata(), line.get_ydata())
    assert np.abs(heights).max() < 0.3
    assert figure.axes[0].get_title(loc="left") == f"{len(curve.roots)} real roots"
