"""Below the tabs: units of all of them, what the scene shows, what is taken away."""

from collections.abc import Callable
from typing import Any

from dh2urdf.dh_io import Units
from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.page import page_html
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array
from dh2urdf.viewer.door import by_visitor, png, send

SIGNS = {"deg": "°", "rad": "rad"}

UNITS = {f"{m}, {sign}": Units(m, a) for m in ("m", "mm") for a, sign in SIGNS.items()}
"""Units to choose from, by what they are called."""

TAKEN = ("Picture", "Page")
"""What is sent to the visitor: the scene as he sees it, the arm as one HTML file."""

PATIENCE = 60.0
"""For a visitor's browser to draw the picture [s]."""


class Options:
    """Switches and buttons; each callback is called when a visitor changed one."""

    def __init__(
        self,
        gui: Any,
        on_units: Callable[[], None],
        on_frames: Callable[[], None],
        on_meshes: Callable[[], None],
        shown: Callable[[], tuple[Robot, Array]],
    ) -> None:
        self.shown = shown
        self.choice = gui.add_dropdown("Units", tuple(UNITS), initial_value=next(iter(UNITS)))
        self.frames = gui.add_checkbox("DH frames", False)
        self.names = gui.add_checkbox("Names of axes", True)
        self.meshes = gui.add_checkbox("Meshes of the URDF", True, visible=False)
        self.save = gui.add_button_group("Save", TAKEN)
        self.choice.on_update(by_visitor(lambda _: on_units()))
        self.frames.on_update(by_visitor(lambda _: on_frames()))
        self.names.on_update(by_visitor(lambda _: on_frames()))
        self.meshes.on_update(by_visitor(lambda _: on_meshes()))
        self.save.on_click(by_visitor(self._send))

    @property
    def units(self) -> Units:
        """Units of all tabs."""
        return UNITS[self.choice.value]

    def _send(self, event: Any) -> None:
        """Send a picture or the page of the arm as it stands to the visitor who asked."""
        robot, q = self.shown()
        try:
            if self.save.value == TAKEN[0]:
                send(event.client, robot.model.name, "png", png(event.client, PATIENCE))
            else:
                send(event.client, robot.model.name, "html", page_html(robot, q).encode())
        except Dh2UrdfError as error:
            event.client.add_notification("Nothing was saved", str(error), color="red")
