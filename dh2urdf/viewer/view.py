"""The view itself: one arm, one configuration, and the tabs that show and move it."""

import logging
import threading
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.dh import DHTable
from dh2urdf.dh.print import title
from dh2urdf.drawing.arm import drawn_arm, table_of, zero_configuration
from dh2urdf.drawing.surfaces import Drawing, TableDrawing
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.arm_scene import ArmScene
from dh2urdf.viewer.door import LOOPBACK, later, quietly, start_server
from dh2urdf.viewer.frames_scene import FramesScene, RowScene
from dh2urdf.viewer.options import Options
from dh2urdf.viewer.reach_scene import ReachScene
from dh2urdf.viewer.stage import cast_shadows, light, look_at, set_stage
from dh2urdf.viewer.step_scene import StepScene
from dh2urdf.viewer.tabs.editor import page_title
from dh2urdf.viewer.tabs.ik_tab import IKTab
from dh2urdf.viewer.tabs.joints_tab import JointsTab
from dh2urdf.viewer.tabs.table_tab import TableTab
from dh2urdf.viewer.tabs.worked_tab import WorkedTab
from dh2urdf.viewer.urdf_drawing import urdf_drawing

CLOSE = 1.15
"""From the row that is explained to the eye, against the arm's size."""

SHADOWS_AFTER = 3.0
"""From a visitor's coming to the sun's shadows [s]; the first picture does not wait for them."""

PANEL = 400
"""Width of the panel [px]."""

logger = logging.getLogger("dh2urdf")


def view(
    robot: Robot, q: ArrayLike | None = None, *, host: str = "127.0.0.1", port: int | None = None
) -> "ArmView":
    """Show an arm in the browser.

    Parameters
    ----------
    robot : Robot
    q : array_like, shape (n,), optional
        Configuration to start from [rad] or [m]; zero, or what the limits allow nearest to it.
    host : str
        Address to listen on; by default only this machine can reach the view.
    port : int, optional
        That port and no other, 0 for any; without it the next free one from 8080.

    Returns
    -------
    ArmView
        The server runs beside the program until :meth:`ArmView.stop`.

    Raises
    ------
    MissingExtraError, ServerError, ConfigurationError
    """
    return ArmView(robot, q, host=host, port=port)


class ArmView:
    """An arm in the browser; everyone who looks sees and moves the same one.

    Attributes
    ----------
    url : str
        Where to look.
    robot : Robot
        The arm shown; another one after the table was edited.
    q : array, shape (n,)
        Its configuration; set it to move the arm.
    """

    def __init__(
        self, robot: Robot, q: ArrayLike | None = None, *, host: str, port: int | None
    ) -> None:
        config = zero_configuration(robot, q)
        self._lock = threading.RLock()
        self._stopped = threading.Event()
        self._server: Any = start_server(host, port)
        shown = "localhost" if host in {*LOOPBACK, "0.0.0.0", "::"} else host
        self.url = f"http://{shown}:{self._server.get_port()}"
        if host not in LOOPBACK:
            logger.warning("the view listens on %s: other machines can reach and move it", host)
        self._row = 0
        self._scenes: list[Any] = []
        self._row_scene: RowScene | None = None
        self._reach: ReachScene | None = None
        self._server.gui.main_panel.dock_right()
        self._server.gui.main_panel.set_width(PANEL)
        tabs = self._server.gui.add_tab_group()
        self._joints = JointsTab(self._server.gui, tabs.add_tab("Joints"), self._moved)
        table_tab = tabs.add_tab("DH table")
        self._ik = IKTab(self._server, tabs.add_tab("IK"), self._lock, self._moved, self._target_on)
        worked_tab = tabs.add_tab("Worked solution")
        self._worked = WorkedTab(self._server.gui, worked_tab, self._step)
        self._table = TableTab(self._server.gui, table_tab, self._explain, self._edited)
        self._titled = self._server.gui.add_html("")
        self._options = Options(
            self._server.gui,
            self._switch_units,
            self._switch_frames,
            self._switch_meshes,
            lambda: (self.robot, self.q),
        )
        light(self._server)
        with self._lock:
            self._build(robot, config)
        self._shadows: threading.Timer | None = None
        self._server.on_client_connect(self._welcome)

    @property
    def q(self) -> Array:
        """Configuration shown, shape (n,) [rad] or [m]."""
        return self._q.copy()

    @q.setter
    def q(self, value: ArrayLike) -> None:
        self._moved(zero_configuration(self.robot, value))

    def show_reach(self, found: Any) -> None:
        """Show where a share of the orientations is reached, which is chosen in the panel.

        ``found`` is a map of :func:`dh2urdf.workspace.reach_map`, or the path of its Zarr group.

        Raises
        ------
        ArgumentError, UnreachedError, MissingExtraError
        """
        with self._lock:
            fresh = ReachScene(self._server, found)
            self._hide_reach()
            self._reach = fresh

    def _hide_reach(self) -> None:
        if self._reach is not None:
            self._reach.remove()
            self._reach = None

    def wait(self) -> None:
        """Wait until :meth:`stop` is called or the program is interrupted."""
        while not self._stopped.wait(0.5):
            pass

    def stop(self) -> None:
        """Stop the server; pages that are open lose their connection."""
        if not self._stopped.is_set():
            self._stopped.set()
            if self._shadows is not None:
                self._shadows.cancel()
            quietly(self._server.stop)

    def _welcome(self, _: Any) -> None:
        """Let shadows fall once the first visitor has seen a picture."""
        if self._shadows is None:
            self._shadows = later(SHADOWS_AFTER, cast_shadows, self._server)

    def _build(self, robot: Robot, q: Array) -> None:
        """Show another arm."""
        arm = drawn_arm(table_of(robot))
        own, notes = urdf_drawing(robot)
        drawing: Drawing = own if own and self._options.meshes.value else TableDrawing(arm)
        with self._server.atomic():
            for scene in self._scenes:
                scene.remove()
            self.robot, self._arm, self._q = robot, arm, q
            self._options.meshes.visible = own is not None
            self._scene = ArmScene(self._server, drawing)
            self._frames = FramesScene(self._server, arm)
            self._step_scene = StepScene(self._server, arm.size)
            self._scenes = [self._scene, self._frames, self._step_scene]
            self._name()
            self._joints.build(robot, q, self._options.units)
            self._table.build(arm.table, self._options.units)
            self._ik.build(robot, drawing, q, self._options.units)
            self._worked.build(robot)
            for note in notes:
                self._table.say(note)
            self._stage = set_stage(self._server, robot, arm, drawing, q)
            self._show_row(self._table.row)
            self._redraw()

    def _name(self) -> None:
        """Say in the title and over the tabs which arm it is, by which convention."""
        name = title(self._arm.table).partition("\n")[0]
        self._server.gui.set_panel_label(name)
        self._titled.content = page_title(f"{name} · dh2urdf")

    def _moved(self, q: Array) -> None:
        """Move the arm to q (n,), whoever asked for it."""
        with self._lock, self._server.atomic():
            self._q = np.array(q)
            self._redraw()

    def _redraw(self) -> None:
        q = self.robot.chain_configuration(self._q)  # of all joints of the table
        self._scene.show(q if isinstance(self._scene.drawing, TableDrawing) else self._q)
        self._frames.set_visible(
            self._options.frames.value, self._options.names.value, self._table.row
        )
        self._frames.show(q)
        self._joints.show(self._q)
        self._ik.show(self._q)
        marks = self._worked.show(self._q)
        if marks or self._step_scene.marks:
            self._step_scene.show(marks)
        if self._row_scene:
            self._row_scene.show(q)
            self._table.explain(self._row_scene.picture, self._row_scene.steps)

    def _explain(self, i: int, visitor: Any = None) -> None:
        """Explain row i, 0 for none, and bring the eye of who asked near to it."""
        with self._lock, self._server.atomic():
            if i:
                self._ik.put_away()
                self._worked.put_away()
            self._show_row(i)
            self._redraw()
        self._bring_near(visitor)

    def _bring_near(self, visitor: Any) -> None:
        """Bring the eye of a visitor, if one asked, to the row explained or to the whole arm."""
        row = self._row_scene.picture if self._row_scene else None
        if visitor is not None and row is None:
            look_at(visitor, *self._stage)
        elif visitor is not None and row is not None:
            start, end = row.T_prev[:3, 3], row.T_next[:3, 3]
            extent = float(np.linalg.norm(end - start))
            look_at(visitor, (start + end) / 2, max(CLOSE * self._arm.size, 2.2 * extent))

    def _target_on(self, visitor: Any) -> None:
        """Put the explained row away when the target comes up."""
        if self._table.row:
            self._table.choose(0)
            self._explain(0, visitor)

    def _step(self) -> None:
        """Draw the step of the worked solution that was chosen, alone."""
        with self._lock, self._server.atomic():
            if self._worked.step and self._table.row:
                self._table.choose(0)
                self._show_row(0)
            self._see_through(self._table.row)
            self._redraw()

    def _see_through(self, row: int) -> None:
        """See through the arm where a row, a step or all frames are drawn within it."""
        inside = row > 0 or self._worked.step > 0 or self._options.frames.value
        self._scene.set_translucent(inside)

    def _show_row(self, i: int) -> None:
        if self._row_scene:
            self._row_scene.remove()
            self._row_scene = None
        if i:
            self._row_scene = RowScene(self._server, self._arm, i, self._options.units)
            self._row_scene.step = self._table.step
        else:
            self._table.explain(None)
        self._see_through(i)

    def _switch_frames(self) -> None:
        with self._lock, self._server.atomic():
            self._see_through(self._table.row)
            self._redraw()

    def _switch_units(self) -> None:
        with self._lock, self._server.atomic():
            self._joints.build(self.robot, self._q, self._options.units)
            self._table.build(self._arm.table, self._options.units)
            self._ik.set_units(self._options.units)
            self._show_row(self._table.row)
            self._redraw()

    def _switch_meshes(self) -> None:
        with self._lock:
            self._build(self.robot, self._q)

    def _edited(self, table: DHTable, visitor: Any = None) -> None:
        """Rebuild the arm from an edited table; joints that it kept stay where they are."""
        robot = Robot.from_dh(table)
        with self._lock:
            self._hide_reach()
            old = dict(zip(self.robot.joint_names, self._q.tolist(), strict=True))
            q = np.array([old.get(name, 0.0) for name in robot.joint_names])
            self._build(robot, np.clip(q, robot.lower, robot.upper))
        self._bring_near(visitor)

    def _repr_html_(self) -> str:
        return (
            f'<iframe src="{self.url}" style="width:100%;height:560px;border:0"></iframe>'
            f'<p><a href="{self.url}">{self.url}</a></p>'
        )

    def __repr__(self) -> str:
        return f"<ArmView of {self.robot.model.name} at {self.url}>"

    def __enter__(self) -> "ArmView":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
