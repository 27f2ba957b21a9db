"""The only door to viser: a quiet server on a port that was free."""

import contextlib
import errno
import io
import socket
import threading
from collections.abc import Callable
from typing import Any

from dh2urdf.doors import integer, text
from dh2urdf.exceptions import ConfigurationError, MissingExtraError, ServerError

try:
    import viser
except ImportError:
    raise MissingExtraError("viewer", "showing an arm in the browser") from None


LOOPBACK = ("127.0.0.1", "localhost", "::1")
"""Hosts that only this machine can reach."""

FIRST_PORT = 8080
"""Where the search for a free port begins when none is asked for."""

PORTS = 200
"""Ports tried from there on."""


def start_server(host: str, port: int | None) -> Any:
    """A viser server, silent, without the button that opens a tunnel to the outside.

    ServerError where the port is in use, or the host is no address of this machine.
    """
    if port is not None:
        integer(port, "port", 0, 65535, ConfigurationError)
    text(host, "host")
    chosen = _free_port(host, port)
    server: Any = quietly(
        lambda: viser.ViserServer(host=host, port=chosen, label="dh2urdf", verbose=False)
    )
    if port and server.get_port() != port:
        server.stop()
        raise _in_use(port)
    server.request_share_url = lambda *_, **__: None  # no tunnel: nothing leaves the machine
    server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
    return server


def quietly(call: Callable[[], Any]) -> Any:
    """Call something of viser's that prints; stdout is for results."""
    with contextlib.redirect_stdout(io.StringIO()):
        return call()


def by_visitor(call: Callable[[Any], object]) -> Callable[[Any], object]:
    """The call for what a visitor does; what the program itself sets has no client."""
    return lambda event: None if event.client is None else call(event)


def send(visitor: Any, title: str, suffix: str, data: bytes) -> str:
    """Send a visitor a file named after a title, with only what file systems take; its name."""
    kept = "".join(c if c.isalnum() or c in "-_" else "_" for c in title)
    name = f"{kept.strip('_') or 'robot'}.{suffix}"
    visitor.send_file_download(name, data, save_immediately=True)
    return name


def png(visitor: Any, patience: float) -> bytes:
    """The scene as a visitor sees it, as a PNG; ServerError where his browser sends none."""
    import imageio.v3 as imageio

    camera = visitor.camera
    size = {"height": int(camera.image_height), "width": int(camera.image_width)}
    try:
        pixels = visitor.get_render(**size, transport_format="png", timeout=patience)
    except TimeoutError:
        raise ServerError("the browser sent no picture") from None
    return bytes(imageio.imwrite("<bytes>", pixels, extension=".png"))


def later(seconds: float, call: Callable[..., object], *values: Any) -> threading.Timer:
    """A call in the background after some time; it does not keep the program running."""
    timer = threading.Timer(seconds, call, values)
    timer.daemon = True
    timer.start()
    return timer


def _free_port(host: str, port: int | None) -> int:
    """The port asked for, any for 0, the next free one for None."""
    for candidate in range(FIRST_PORT, FIRST_PORT + PORTS) if port is None else [port]:
        try:
            with _bound(host, candidate) as probe:
                return int(probe.getsockname()[1])
        except ServerError:
            raise
        except OSError:
            continue
    if port is not None:
        raise _in_use(port)
    raise ServerError(f"no free port between {FIRST_PORT} and {FIRST_PORT + PORTS - 1} on {host}")


def _in_use(port: int) -> ServerError:
    return ServerError(f"port {port} is in use; leave the port out for the next free one")


def _bound(host: str, port: int) -> socket.socket:
    """A socket that listens at an address, which shows that it is free."""
    try:
        family, _, _, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
    except (socket.gaierror, UnicodeError) as error:
        raise ServerError(f"host {host!r}: {getattr(error, 'strerror', error)}") from None
    try:
        return socket.create_server(address[:2], family=family)
    except OSError as error:
        if error.errno == errno.EADDRNOTAVAIL:
            raise ServerError(f"host {host!r} is not an address of this machine") from None
        raise
