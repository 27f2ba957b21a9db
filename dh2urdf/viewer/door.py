"""The only door to viser: a quiet server on a port that was free."""

from __future__ import annotations

import contextlib
import errno
import io
import socket
from collections.abc import Callable
from typing import Any

from dh2urdf.doors import integer, text
from dh2urdf.exceptions import ConfigurationError, MissingExtraError, ServerError

try:
    import viser
except ImportError:
    raise MissingExtraError("viewer", "showing an arm in the browser") from None

__all__ = ["LOOPBACK", "quietly", "start_server"]

LOOPBACK = ("127.0.0.1", "localhost", "::1")
"""Hosts that only this machine can reach."""

FIRST_PORT = 8080
"""Where the search for a free port begins when none is asked for."""

PORTS = 200
"""Ports tried from there on."""


def start_server(host: str, port: int | None) -> Any:
    """A viser server, silent, without the button that opens a tunnel to the outside.

    Parameters
    ----------
    host : str
    port : int, optional
        That port and no other; 0 for any free one. Without it: the next free one from 8080.

    Raises
    ------
    ServerError
        The port is in use, or the host is not an address of this machine.
    """
    if port is not None:
        integer(port, "port", 0, 65535, ConfigurationError)
    text(host, "host")
    chosen = _free_port(host) if port is None else _checked_port(host, port)
    server: Any = quietly(
        lambda: viser.ViserServer(host=host, port=chosen, label="dh2urdf", verbose=False)
    )
    if port and server.get_port() != port:
        server.stop()
        raise ServerError(_in_use(port))
    server.request_share_url = _no_tunnel
    server.gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
    return server


def quietly(call: Callable[[], Any]) -> Any:
    """Call something of viser's that prints; stdout is for results."""
    with contextlib.redirect_stdout(io.StringIO()):
        return call()


def _no_tunnel(*_: object, **__: object) -> None:
    """Stand in for the request of a public address: nothing leaves the machine."""


def _free_port(host: str) -> int:
    for port in range(FIRST_PORT, FIRST_PORT + PORTS):
        if _bindable(host, port):
            return port
    raise ServerError(f"no free port between {FIRST_PORT} and {FIRST_PORT + PORTS - 1} on {host}")


def _checked_port(host: str, port: int) -> int:
    if port == 0:
        with _bound(host, 0) as probe:
            return int(probe.getsockname()[1])
    if not _bindable(host, port):
        raise ServerError(_in_use(port))
    return port


def _in_use(port: int) -> str:
    return f"port {port} is in use; leave the port out for the next free one"


def _bindable(host: str, port: int) -> bool:
    try:
        _bound(host, port).close()
    except ServerError:
        raise
    except OSError:
        return False
    return True


def _bound(host: str, port: int) -> socket.socket:
    """A socket bound to an address, which shows that it is free.

    Raises
    ------
    ServerError
        No such host.
    """
    try:
        family, kind, proto, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
    except (socket.gaierror, UnicodeError) as error:
        raise ServerError(f"host {host!r}: {getattr(error, 'strerror', error)}") from None
    probe = socket.socket(family, kind, proto)
    try:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        probe.bind(address)
        probe.listen(1)
    except OSError as error:
        probe.close()
        if error.errno == errno.EADDRNOTAVAIL:
            raise ServerError(f"host {host!r} is not an address of this machine") from None
        raise
    return probe
