"""The joints: a slider each, within its limits, and where the tip is."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.door import by_visitor
from dh2urdf.viewer.tabs import html

TURN = 2 * math.pi
"""Range of a slider [rad] where a joint has no limit."""


class JointsTab:
    """Sliders in degrees and millimetres; ``on_move`` is called when a visitor moves one."""

    def __init__(self, gui: Any, tab: Any, on_move: Callable[[Array], None]) -> None:
        self.gui, self.tab, self.on_move = gui, tab, on_move
        self.sliders: list[Any] = []
        self.parts: list[Any] = []

    def build(self, robot: Robot, q: Array) -> None:
        """Make the sliders of a robot."""
        self.clear()
        self.robot = robot
        self.scale = np.where(robot.slides, 1000.0, 180.0 / math.pi)
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
        unit = "mm" if self.robot.slides[k] else "°"
        low, high = (round(float(v * self.scale[k]), 2) for v in (self.low[k], self.high[k]))
        at, widest = self._clipped(k, value, low, high), max(high, low + 0.01)
        slider = self.gui.add_slider(f"{name} [{unit}]", low, widest, 0.01, at)
        slider.on_update(by_visitor(lambda event: self._slid(event, k)))
        return slider

    def _clipped(self, k: int, value: float, low: float, high: float) -> float:
        return min(max(round(float(value * self.scale[k]), 2), low), high)

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
            if abs(slider.value - value) > 0.006:
                slider.value = value
        what = f"{self.robot.tip} in {self.robot.base}"
        self.readout.content = html.pose(self.robot.fk(self.q), what)

    def clear(self) -> None:
        """Take the sliders out of the panel."""
        for part in self.parts:
            part.remove()
        self.parts, self.sliders = [], []
