"""The joints: a slider each, within its limits, and where the tip is."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dh2urdf.dh_io import Kind, Units
from dh2urdf.drawing.readings import scale_of, sign_of
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.door import by_visitor
from dh2urdf.viewer.tabs import html

TURN = 2 * math.pi
"""Range of a slider [rad] where a joint has no limit."""


PLACES = {"m": 5, "mm": 2, "deg": 2, "rad": 4}
"""Digits after the point of a slider, by unit."""


def kinds_of(robot: Robot) -> list[Kind]:
    """What each joint's value measures."""
    return [Kind.LENGTH if slides else Kind.ANGLE for slides in robot.slides]


class JointsTab:
    """Sliders in the units chosen; ``on_move`` is called when a visitor moves one."""

    def __init__(self, gui: Any, tab: Any, on_move: Callable[[Array], None]) -> None:
        self.gui, self.tab, self.on_move = gui, tab, on_move
        self.sliders: list[Any] = []
        self.parts: list[Any] = []

    def build(self, robot: Robot, q: Array, units: Units) -> None:
        """Make the sliders of a robot."""
        self.clear()
        self.robot, self.units = robot, units
        self.kinds = kinds_of(robot)
        self.scale = np.array([scale_of(units, kind) for kind in self.kinds])
        self.low, self.high = robot.bounded(max(robot.chain.size, 0.1), TURN)
        with self.tab:
            self.readout = self.gui.add_html("")
            for k, name in enumerate(robot.joint_names):
                self.sliders.append(self._slider(k, name, float(q[k])))
            self.buttons = self.gui.add_button_group("Pose", ("Zero", "Random"))
        self.buttons.on_click(by_visitor(self._pressed))
        self.parts = [*self.sliders, self.readout, self.buttons]
        self.show(q)

    def _slider(self, k: int, name: str, value: float) -> Any:
        places = PLACES[self.units.of(self.kinds[k])]
        step = round(0.1**places, places)
        low, high = (round(float(v * self.scale[k]), places) for v in (self.low[k], self.high[k]))
        at, widest = self._clipped(k, value, low, high), round(max(high, low + step), places)
        label = f"{name} [{sign_of(self.units, self.kinds[k])}]"
        slider = self.gui.add_slider(label, low, widest, step, at)
        slider.on_update(by_visitor(lambda event: self._slid(event, k)))
        return slider

    def _clipped(self, k: int, value: float, low: float, high: float) -> float:
        places = PLACES[self.units.of(self.kinds[k])]
        return min(max(round(float(value * self.scale[k]), places), low), high)

    def _slid(self, event: Any, k: int) -> None:
        """A visitor moved slider k."""
        q = self.q.copy()
        q[k] = min(self.high[k], max(self.low[k], event.target.value / self.scale[k]))  # no NaN
        self.on_move(q)

    def _pressed(self, _: Any) -> None:
        if self.buttons.value == "Zero":
            self.on_move(np.clip(np.zeros(self.robot.n), self.low, self.high))
        else:
            self.on_move(self.robot.random_configuration())

    def show(self, q: Array) -> None:
        """Set the sliders to q (n,) and read the tip's pose out."""
        self.q = np.array(q)
        for k, slider in enumerate(self.sliders):
            value = self._clipped(k, float(q[k]), slider.min, slider.max)
            if abs(slider.value - value) > 0.6 * slider.step:
                slider.value = value
        what = f"{self.robot.tip} in {self.robot.base}"
        self.readout.content = html.pose(self.robot.fk(self.q), what, self.units)

    def clear(self) -> None:
        """Take the sliders out of the panel."""
        for part in self.parts:
            part.remove()
        self.parts, self.sliders = [], []
