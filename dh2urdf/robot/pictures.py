"""The pictures of a robot; what draws them lies above and is loaded when asked for."""

from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from numpy.typing import ArrayLike

from dh2urdf.transforms import Array


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
    """What :class:`dh2urdf.Robot` shows of itself."""

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
