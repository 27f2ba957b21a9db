"""The command line: one verb a module, results on stdout, everything else on stderr.

Exit status: 0 done, 1 checked and found wrong or no solution, 2 bad usage or bad input,
130 interrupted.
"""

import codecs
import io
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from itertools import takewhile
from typing import Any

from dh2urdf.cli.progress import note
from dh2urdf.exceptions import Dh2UrdfError, UnreachedError

__all__ = ["main"]

VERBS = {
    "convert": "Turn DH tables into URDF files that Pinocchio has checked.",
    "extract": "Find the DH table of a URDF by frame assignment.",
    "check": "Say what the consumers of a URDF would say of it.",
    "compare": "Say whether two arms are the same, up to what, and where they differ.",
    "show": "Print a table, its transforms and the solver of its inverse kinematics.",
    "list": "List the tables that ship with the package.",
    "fk": "Place the tip: forward kinematics of a table or a URDF.",
    "ik": "Find every configuration that reaches a pose.",
    "path": "Find one joint motion through a file of poses.",
    "figure": "Draw an arm with its DH frames.",
    "workspace": "Draw what an arm can reach.",
    "map": "Map what an arm reaches, on one machine or many, to a Zarr store.",
    "place": "Find where a robot should stand for a file of poses.",
    "export": "Take the arm along: its solver as source code, or a ROS 2 package.",
    "view": "Look at an arm in the browser.",
}
"""Each is the function ``<verb>_`` of ``dh2urdf.cli.verbs.<verb>``, loaded when it is called."""

ROOMS = {"path": "ik.path"}
"""Modules of verbs that stand in a folder."""

PLAIN = {"\u2212": "-", "\u2500": "-", "\u2026": "...", "\u00b0": "deg", "\u03c0": "pi"}
"""Signs of ours as a terminal without them shows them."""


def main(argv: Sequence[str] | None = None) -> None:
    """Run one verb and exit with its status."""
    tokens = list(sys.argv[1:] if argv is None else argv)
    debug, before, unraised = "--debug" in tokens, dict[int, Any](), sys.unraisablehook
    try:
        before = _catch_interrupts()
        _open_streams()
        status = _run([t for t in tokens if t != "--debug"])
        sys.stdout.flush()
    except Dh2UrdfError as error:
        if debug:
            raise
        status = _failed(error, tokens)
    except OSError as error:
        if debug:
            raise
        status = _lost_output(error)
    except ImportError as error:
        if debug:
            raise
        status = _failed(Dh2UrdfError(_unloaded(error)), tokens)
    except BaseException as error:
        if not _is_interrupt(error):
            raise
        note("interrupted")
        status = 130
    finally:
        sys.unraisablehook = unraised
        if before:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before.items():
            signal.signal(number, handler)
    if argv is None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # nothing is left to interrupt
    sys.exit(status)


def _catch_interrupts() -> dict[int, Any]:
    """Let Ctrl-C interrupt again, a second later, what has caught it on its way to `main`.

    One that fell where nothing can be raised, as in a callback of the interpreter, says nothing.
    Returns the handlers that were there; none in a program that has a timer running or handlers
    that Python does not know, whose signals stay as they are.
    """

    def interrupt(*_: object) -> None:
        signal.setitimer(signal.ITIMER_REAL, 1.0)
        raise KeyboardInterrupt

    def unraised(lost: "sys.UnraisableHookArgs") -> None:
        if not isinstance(lost.exc_value, KeyboardInterrupt):
            sys.__unraisablehook__(lost)

    numbers = signal.SIGINT, signal.SIGALRM
    before: dict[int, Any] = {number: signal.getsignal(number) for number in numbers}
    if None in before.values() or any(signal.getitimer(signal.ITIMER_REAL)):
        return {}
    with suppress(ValueError):  # of a thread, which gets no signals
        for number in before:
            signal.signal(number, interrupt)
        sys.unraisablehook = unraised
        return before
    return {}


def _is_interrupt(error: BaseException | None) -> bool:
    """Tell Ctrl-C from other errors, also where the interpreter or a library wrapped it."""
    return error is not None and (
        isinstance(error, KeyboardInterrupt)
        or _is_interrupt(error.__cause__)
        or _is_interrupt(error.__context__)
    )


def _run(tokens: list[str]) -> int:
    from cyclopts import App, CycloptsError, Parameter, UnusedCliTokensError

    from dh2urdf import __version__
    from dh2urdf.cli.options import MARK, check_together, marked, plain

    app = App(
        name="dh2urdf",
        help="From a Denavit-Hartenberg table to a verified URDF and every inverse-kinematics "
        "solution.",
        version=__version__,
        suppress_keyboard_interrupt=False,
        default_parameter=Parameter(negative=()),
        help_epilogue="--debug shows the traceback of an error.",
    )
    for verb, summary in VERBS.items():
        place = f"dh2urdf.cli.verbs.{ROOMS.get(verb, verb)}:{verb}_"
        own = (
            {} if verb in tokens[:1] else {"help": summary}
        )  # else its docstring, read when loaded
        app.command(place, name=verb, **own)
    app.register_install_completion_command()
    try:
        command, bound, _ = app.parse_args(marked(tokens), exit_on_error=False, print_error=False)
    except UnusedCliTokensError as error:
        words = ", ".join(map(repr, plain(error.unused_tokens or [])))
        raise Dh2UrdfError(f"{tokens[0]}: more values than it takes: {words}") from None
    except CycloptsError as error:
        message = str(error).replace(MARK, "").replace("Unknown option: ", "unknown option ")
        raise Dh2UrdfError(message) from None
    given = {name: plain(value) for name, value in bound.arguments.items()}
    check_together(command.__name__.rstrip("_"), given)
    bound.arguments.update(given)
    result = command(*bound.args, **bound.kwargs)
    return result if isinstance(result, int) else 0


def _open_streams() -> None:
    """Replace streams that are closed; let no sign that a terminal lacks stop an answer."""
    for name, flags in (("stdin", os.O_RDONLY), ("stdout", os.O_RDONLY), ("stderr", os.O_WRONLY)):
        if getattr(sys, name) is None:  # writing to stdout then fails as on a full disk
            mode = "r" if name == "stdin" else "w"
            setattr(sys, name, open(os.open(os.devnull, flags), mode))  # noqa: SIM115
    codecs.register_error("spelt", _spelt)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="spelt")


def _spelt(error: UnicodeError) -> tuple[str, int]:
    """What stands for a sign that cannot be encoded."""
    assert isinstance(error, UnicodeEncodeError)
    sign = error.object[error.start]
    return PLAIN.get(sign, sign.encode("ascii", "backslashreplace").decode()), error.start + 1


def _failed(error: Dh2UrdfError, tokens: list[str]) -> int:
    """Say what was wrong, with ``--json`` on stdout too; the status."""
    note(f"dh2urdf: {error}")
    if "--json" in takewhile(lambda token: token != "--", tokens):
        from dh2urdf.cli.output import emit_error

        try:
            emit_error(tokens[0] if tokens[0] in VERBS else "", error)
            sys.stdout.flush()
        except OSError as lost:
            return _lost_output(lost)
    return 1 if isinstance(error, UnreachedError) else 2


def _unloaded(error: BaseException) -> str:
    """Which library cannot be loaded, and what small systems need for it."""
    while error.__cause__ or error.__context__:
        error = error.__cause__ or error.__context__ or error
    gomp = "; on Debian and Ubuntu, apt-get install libgomp1" if "libgomp" in str(error) else ""
    return f"a library cannot be loaded: {error}{gomp}"


def _lost_output(error: OSError) -> int:
    """Say that stdout cannot be written, unless who reads it has seen enough; the status."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    if isinstance(error, BrokenPipeError):
        return 0
    note(f"dh2urdf: {error.filename or 'standard output'}: {error.strerror}")
    return 2
