"""Inverse kinematics: a target to drag, every solution as a ghost and as a line of a table."""

import threading
from collections.abc import Callable
from typing import Any

import numpy as np

from dh2urdf.dh_io import Units
from dh2urdf.drawing.surfaces import Drawing, TableDrawing
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array, pose, quaternion_to_matrix
from dh2urdf.viewer.arm_scene import Ghosts, set_poses
from dh2urdf.viewer.door import by_visitor
from dh2urdf.viewer.tabs import html
from dh2urdf.viewer.tabs.branches import Answer, answer, branch_table
from dh2urdf.viewer.tabs.pose_field import PoseField
from dh2urdf.viewer.tabs.redundancy import Redundancy
from dh2urdf.workspace import common_axis, task_of

MOST_GHOSTS = 16
"""Ghosts at a time: what a chain of six joints can have at most."""

GIZMO = 0.22
"""Size of the target's handles, as a share of the arm's size."""


class IKTab:
    """The target, its solutions, the redundant joint.

    ``lock`` is held while the arm is moved or rebuilt, ``on_move`` called with a configuration
    that the arm should take, ``on_target`` with the visitor who switched the target on.
    """

    def __init__(
        self,
        server: Any,
        tab: Any,
        lock: threading.RLock,
        on_move: Callable[[Array], None],
        on_target: Callable[[Any], None],
    ) -> None:
        self.server, self.lock = server, lock
        self.on_move, self.on_target = on_move, on_target
        self.ghosts: Ghosts | None = None
        self.target: Any = None
        self.answer: Answer | None = None
        self._wanted: Array | None = None
        self._busy = threading.Lock()
        gui = server.gui
        with tab:
            self.active = gui.add_checkbox("Target", False)
            self.show_ghosts = gui.add_checkbox("Ghosts", True)
            self.within = gui.add_checkbox("Within limits", True)
            self.task = gui.add_dropdown("Reach", ("pose", "position+axis", "position"))
            self.field = PoseField(gui, self._typed)
            self.redundancy = Redundancy(gui, self._held)
            self.status = gui.add_html(html.message("Switch the target on and drag it."))
            self.listed = gui.add_html("")
            self.go = gui.add_button_group("Move to", ("1",), visible=False)
        for handle in (self.active, self.show_ghosts, self.within, self.task):
            handle.on_update(by_visitor(self._switched))
        self.go.on_click(by_visitor(lambda _: self._go(int(self.go.value) - 1)))

    def build(self, robot: Robot, drawing: Drawing, q: Array, units: Units) -> None:
        """Prepare for another arm."""
        self.robot, self.q, self.units = robot, np.array(q), units
        for old in (self.ghosts, self.target):
            if old:
                old.remove()
        self.ghosts = Ghosts(self.server, drawing, MOST_GHOSTS, self._go)
        scale, axes = GIZMO * max(robot.chain.size, 1e-3), dragged_axes(robot)
        style: Any = {"line_width": 3.0, "depth_test": False, "visible": False}
        controls = self.server.scene.add_transform_controls
        self.target = controls("/target", scale=scale, active_axes=axes, **style)
        self.target.on_update(self._dragged)
        self.task.value = default_task(robot)
        self.redundancy.build(robot, q, units)
        self._place_target(robot.fk(q))
        self._show_answer(None)
        self.target.visible = self.active.value
        if self.active.value:
            self.solve(robot.fk(q))

    def set_units(self, units: Units) -> None:
        """Show the same in other units."""
        self.units = units
        self.redundancy.build(self.robot, self.q, units)
        self.field.show(self._T, units)
        self._show_answer(self.answer)

    def show(self, q: Array) -> None:
        """Follow the arm to q (n,), which some other tab moved."""
        self.q, T = np.array(q), self.robot.fk(q)
        if not self.active.value:
            self._place_target(T)
        elif float(np.abs(T - self._T).max()) > 1e-7:
            self._place_target(T)
            self.solve(T)

    def solve(self, T: Array, *, follow: bool = False) -> None:
        """Solve for a target, show what there is; the arm follows to the nearest."""
        self._T = T
        self.field.show(T, self.units)
        if self.answer is None:
            self.status.content = html.message("Solving. The first time takes some seconds.")
        task, within, locked = self.task.value, self.within.value, self.redundancy.locked
        found = answer(self.robot, T, self.q, task=task, within=within, locked=locked)
        if follow and found.nearest is not None:
            self._take(found, found.nearest)
        else:
            self._show_answer(found)

    def _take(self, found: Answer, q: Array) -> None:
        """Move the arm to a solution q (n,)."""
        self.q = np.array(q)
        self._show_answer(found.at(self.q))
        self.redundancy.show(self.q)
        self.on_move(self.q)

    def _show_answer(self, found: Answer | None) -> None:
        self.answer = found
        assert self.ghosts is not None
        rows = found.q[:MOST_GHOSTS] if found is not None else np.empty((0, self.robot.n))
        shown = rows if self.show_ghosts.value else rows[:0]
        if isinstance(self.ghosts.drawing, TableDrawing):
            shown = self.robot.chain_configuration(shown)  # of all joints of the table
        self.ghosts.show(list(shown), skip=found.current if found is not None else -1)
        self.go.visible = len(rows) > 0
        if found is None:
            self.status.content = html.message("Switch the target on and drag it.")
            self.listed.content = ""
            return
        if len(rows):
            self.go.options = tuple(str(k + 1) for k in range(len(rows)))
        self.status.content = html.message(found.words, "info" if len(rows) else "bad")
        self.listed.content = branch_table(found, self.robot, self.units) if len(rows) else ""

    def _place_target(self, T: Array) -> None:
        self._T = np.array(T)
        self.field.show(self._T, self.units)
        set_poses([self.target], T[None])

    def _typed(self, T: Array, visitor: Any) -> None:
        """Bring the target, switched on where it was not, to a pose that was typed."""
        with self.lock, self.server.atomic():
            if not self.active.value:
                self.active.value = self.target.visible = True
                self.on_target(visitor)
            self._place_target(T)
            self.solve(T, follow=True)

    def _switched(self, event: Any) -> None:
        with self.lock:
            self.target.visible = self.active.value
            if not self.active.value:
                self._show_answer(None)
                return
            if event.target is self.active:
                self._place_target(self.robot.fk(self.q))
                self.on_target(event.client)
            self.solve(self._T)

    def put_away(self) -> None:
        """Switch the target and the ghosts off."""
        if self.active.value:
            self.active.value = False
            self.target.visible = False
            self._show_answer(None)

    def _dragged(self, event: Any) -> None:
        """Solve for the latest place of the target; places passed meanwhile are skipped."""
        self._wanted = _pose(event.target)
        while self._wanted is not None and self._busy.acquire(blocking=False):
            try:
                while (T := self._wanted) is not None:
                    self._wanted = None
                    with self.lock, self.server.atomic():
                        self.solve(T, follow=True)
            finally:
                self._busy.release()

    def _go(self, k: int) -> None:
        """Move the arm to solution k."""
        with self.lock, self.server.atomic():
            if self.answer is not None and 0 <= k < len(self.answer.q):
                self._take(self.answer, self.answer.q[k])

    def _held(self, locked: dict[int, float]) -> str:
        """Move the arm through its self-motion; a word where that is not possible."""
        with self.lock, self.server.atomic():
            T = self._T if self.active.value else self.robot.fk(self.q)
            try:
                within = self.within.value
                found = self.robot.ik(T, seed=self.q, within_limits=within, locked=locked)
            except Dh2UrdfError as error:
                return str(error).partition("\n")[0]
            if not len(found):
                return "No configuration reaches the pose with the joint there."
            self.q = np.array(found.q[0])
            self._T = T
            if self.active.value:
                self.solve(T)
            self.on_move(self.q)
        return ""


def default_task(robot: Robot) -> str:
    """What a target that is dragged about can ask of an arm of this kind."""
    return "position+axis" if robot.n == 5 else task_of(robot).name


def dragged_axes(robot: Robot) -> tuple[bool, bool, bool]:
    """Axes of the tip along which the target slides; not across the plane of a planar arm."""
    axis, flat = common_axis(robot)
    if axis is None or not flat or robot.n > 3:
        return True, True, True
    across = np.abs(robot.chain.tool[axis, :3]) > 1.0 - 1e-9
    x, y, z = (not bool(a) for a in across)
    return x, y, z


def _pose(handle: Any) -> Array:
    """Pose of a handle of the scene, its quaternion brought to unit length, shape (4, 4)."""
    w, *xyz = np.array(handle.wxyz, float) / np.linalg.norm(handle.wxyz)
    return pose(quaternion_to_matrix(np.array([*xyz, w])), handle.position)
