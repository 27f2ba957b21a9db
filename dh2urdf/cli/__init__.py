"""The command line: one verb a module, results on stdout, everything else on stderr.

Exit status: 0 done, 1 checked and found wrong or no solution, 2 bad usage or bad input,
130 interrupted.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence

from dh2urdf.exceptions import Dh2UrdfError

__all__ = ["main"]

VERBS = {
    "convert": "Turn DH tables into URDF files that Pinocchio has checked.",
    "extract": "Find the DH table of a URDF by frame assignment.",
    "check": "Say what the consumers of a URDF would say of it.",
    "show": "Print a table, its transforms and the solver of its inverse kinematics.",
    "list": "List the tables that ship with the package.",
    "fk": "Place the tip: forward kinematics of a table or a URDF.",
    "ik": "Find every configuration that reaches a pose.",
    "figure": "Draw an arm with its DH frames.",
    "workspace": "Draw what an arm can reach.",
    "view": "Look at an arm in the browser.",
}
"""Each is the function ``<verb>_`` of ``dh2urdf.cli.<verb>_verb``, loaded when it is called."""

_NEGATIVE = re.compile(r"-(?=.*[\dπi])(?:[\d.,()*/+e-]|pi|π|deg|rad|mm|cm|m)+")
"""A value such as ``-pi/2`` or ``-90deg``, which is not an option."""


def main(argv: Sequence[str] | None = None) -> None:
    """Run one verb and exit with its status."""
    tokens = list(sys.argv[1:] if argv is None else argv)
    debug = "--debug" in tokens
    tokens = ["0" + t if _NEGATIVE.fullmatch(t) else t for t in tokens if t != "--debug"]
    try:
        status = _run(tokens)
        sys.stdout.flush()
    except Dh2UrdfError as error:
        if debug:
            raise
        sys.stderr.write(f"dh2urdf: {error}\n")
        status = 2
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        status = 0
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        status = 130
    sys.exit(status)


def _run(tokens: list[str]) -> int:
    from cyclopts import App, Parameter

    from dh2urdf import __version__

    app = App(
        name="dh2urdf",
        help="From a Denavit-Hartenberg table to a verified URDF and every inverse-kinematics "
        "solution.",
        version=__version__,
        suppress_keyboard_interrupt=False,
        result_action="return_value",
        default_parameter=Parameter(negative=()),
        help_epilogue="--debug shows the traceback of an error.",
    )
    for verb, summary in VERBS.items():
        app.command(f"dh2urdf.cli.{verb}_verb:{verb}_", name=verb, help=summary)
    app.register_install_completion_command()
    result = app(tokens)
    return result if isinstance(result, int) else 0
