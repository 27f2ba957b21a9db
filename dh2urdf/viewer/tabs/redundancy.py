"""The redundant joint of an arm with seven: held at a value, moved through the self-motion."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dh2urdf.dh_io import Kind, Units
from dh2urdf.drawing.readings import scale_of, sign_of
from dh2urdf.exceptions import NoSolverError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.door import by_visitor
from dh2urdf.viewer.tabs import html
from dh2urdf.viewer.tabs.joints_tab import PLACES, kinds_of


class Redundancy:
    """A choice of joint and a slider for it, there for arms with seven joints.

    ``on_hold`` is called with the joint and its value when a visitor moves the slider; it returns
    a word where the arm cannot follow, nothing where it does.
    """

    def __init__(self, gui: Any, on_hold: Callable[[dict[int, float]], str]) -> None:
        self.on_hold = on_hold
        self.robot: Any = None
        self.folder = gui.add_folder("Self-motion", visible=False)
        with self.folder:
            self.joint = gui.add_dropdown("Held joint", ("none",))
            self.slider = gui.add_slider("Value", -180.0, 180.0, 0.1, 0.0)
            self.note = gui.add_html("")
        self.joint.on_update(by_visitor(lambda _: self._range()))
        self.slider.on_update(by_visitor(self._slid))

    @property
    def locked(self) -> dict[int, float] | None:
        """The joint that is held and its value; None where the arm has no joint to spare."""
        if self.robot.n != 7:
            return None
        return {self.index: float(self.q[self.index])}

    @property
    def index(self) -> int:
        """Index of the joint that is held."""
        return int(self.robot.joint_names.index(self.joint.value))

    @property
    def kind(self) -> Kind:
        """What the held joint's value measures."""
        return kinds_of(self.robot)[self.index]

    @property
    def unit(self) -> str:
        """Name of its unit."""
        return self.units.of(self.kind)

    @property
    def scale(self) -> float:
        """What one [rad] or [m] of it is in the unit."""
        return scale_of(self.units, self.kind)

    def build(self, robot: Robot, q: Array, units: Units) -> None:
        """Prepare for another arm, or for other units."""
        known = robot is self.robot
        self.robot, self.q, self.units = robot, np.array(q), units
        self.folder.visible = robot.n == 7
        if robot.n != 7:
            return
        if not known:
            self.joint.options = robot.joint_names
            self.joint.value = robot.joint_names[default_joint(robot)]
        self._range()

    def show(self, q: Array) -> None:
        """Follow the arm to q (n,)."""
        self.q = np.array(q)
        if self.robot.n == 7:
            shown = round(float(q[self.index]) * self.scale, PLACES[self.unit])
            self.slider.value = min(max(shown, self.slider.min), self.slider.max)

    def _range(self) -> None:
        low, high = self.robot.lower[self.index], self.robot.upper[self.index]
        places = PLACES[self.unit]
        self.slider.min = round(max(float(low), -2 * math.pi) * self.scale, places)
        self.slider.max = round(min(float(high), 2 * math.pi) * self.scale, places)
        self.slider.step, self.slider.precision = round(0.1**places, places), places
        self.slider.label = f"Value [{sign_of(self.units, self.kind)}]"
        self.show(self.q)

    def _slid(self, _: Any) -> None:
        words = self.on_hold({self.index: self.slider.value / self.scale})
        self.note.content = html.message(words, "bad") if words else ""


def default_joint(robot: Robot) -> int:
    """The joint to hold: one whose rest is solved in closed form, the third where it can be.

    Arms with a spherical wrist keep it when the third joint is held; arms whose first three
    axes meet instead keep those when the last one is.
    """
    q = robot.random_configuration(0)
    for k in (2, 6, 4):
        try:
            name = robot.solver_for(locked={k: float(q[k])}).name
        except NoSolverError:
            continue
        if "general" not in name:
            return k
    return 2
