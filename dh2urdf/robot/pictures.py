"""The pictures of a robot; what draws them lies above and is loaded when asked for."""

from collections.abc import Container
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from numpy.typing import ArrayLike

from dh2urdf.exceptions import Dh2UrdfError
from dh2urdf.transforms import Array

FRAME = '<iframe srcdoc="{page}" style="width:100%;height:{height}px;border:0"></iframe>'
"""The page of an arm within another page."""

HEIGHT = 620
"""Of that [px]."""


class Picture(Protocol):
    """A matplotlib figure."""

    def savefig(self, fname: str | Path, **options: Any) -> None:
        """Write it to a file."""


class ArmView(Protocol):
    """The arm in the browser."""

    url: str
    q: Array

    def stop(self) -> None:
        """Close the page and its server."""


class RobotPictures:
    """What :class:`dh2urdf.Robot` shows of itself.

    A notebook shows the arm with sliders, as ``dh2urdf view ARM -o arm.html`` writes it.
    """

    def _repr_mimebundle_(
        self, include: Container[str] | None = None, exclude: Container[str] | None = None
    ) -> dict[str, str]:
        """Text, and the page that works offline, in a frame of its own."""
        bundle = {"text/plain": repr(self)}
        wanted = include is None or "text/html" in include
        if wanted and not (exclude and "text/html" in exclude):
            try:
                page = str(import_module("dh2urdf.page").page_html(self))
            except Dh2UrdfError:  # an arm that cannot be drawn has its text
                return bundle
            page = page.replace("&", "&amp;").replace('"', "&quot;")
            bundle["text/html"] = FRAME.format(page=page, height=HEIGHT)
        return bundle

    def figure(self, q: ArrayLike | None = None, **options: Any) -> Picture:
        """Draw the arm with its DH frames and table (extra ``plot``).

        Parameters
        ----------
        q : array_like, shape (n,), optional
            Configuration [rad] or [m]; zero where the limits allow it.
        options
            Those of :func:`dh2urdf.figures.figure`: style, ghosts, view, ...

        Returns
        -------
        matplotlib.figure.Figure
            It shows itself in a notebook; ``dh2urdf.figures.save_picture`` writes it.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        """
        picture: Picture = import_module("dh2urdf.figures").figure(self, q, **options)
        return picture

    def view(self, q: ArrayLike | None = None, **options: Any) -> ArmView:
        """Show the arm in the browser (extra ``viewer``); the server runs beside the program.

        Parameters
        ----------
        q : array_like, shape (n,), optional
            Configuration to start from.
        options
            Those of :func:`dh2urdf.viewer.view`: host, port, ...

        Returns
        -------
        ArmView
            Has ``url`` and ``stop()``; set ``q`` to move the arm.

        Raises
        ------
        MissingExtraError
            viser is not installed.
        """
        shown: ArmView = import_module("dh2urdf.viewer").view(self, q, **options)
        return shown
