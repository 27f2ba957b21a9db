"""``dh2urdf view``: the arm in the browser."""

from typing import Annotated

from cyclopts import Parameter

from dh2urdf.cli.options import Deg, Force, Link, PagePath, Values, whole
from dh2urdf.cli.output import emit, emit_json, parse_configuration, robot_of
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading


def view_(
    robot: str | None = None,
    /,
    *,
    q: Values = None,
    deg: Deg = False,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    output: PagePath = None,
    force: Force = False,
    host: str = "127.0.0.1",
    port: Annotated[int | None, whole(0, 65_535)] = None,
    map: str | None = None,
    open: Annotated[bool, Parameter(negative="--no-open")] = True,
    json: bool = False,
) -> None:
    """Look at an arm in the browser; Ctrl-C ends it.

    With -o, write a page that needs neither dh2urdf nor a network: for a course page or a mail.

    Parameters
    ----------
    robot
        A table file, the name of a table that ships, or a URDF, - for stdin; without it, a table
        with one joint to build on.
    q
        Configuration to start from: --q=0,-pi/2,90deg.
    host
        Address to listen on; the default is reached from this machine only.
    port
        That port and no other, 0 for any; default: the next free one from 8080.
    map
        A map of `dh2urdf map`, whose surface is shown around the arm.
    open
        Open the page in the browser.
    json
        One JSON object with the address, or the path, instead of text.
    """
    if output is not None:
        from dh2urdf.page import save_page

        arm = robot_of(robot or "", base, tip, reading)
        start = parse_configuration(q, arm, deg=deg) if q else None
        path = save_page(arm, output, start, force=force)
        emit_json("view", path=path) if json else emit(str(path))
        return
    from dh2urdf.robot import Robot
    from dh2urdf.viewer import view
    from dh2urdf.viewer.tabs.table_tab import new_table

    arm = robot_of(robot, base, tip, reading) if robot else Robot.from_dh(new_table())
    shown = view(arm, parse_configuration(q, arm, deg=deg) if q else None, host=host, port=port)
    with shown:
        if map is not None:
            shown.show_reach(map)
        if json:
            emit_json("view", url=shown.url, host=host)
        else:
            emit(shown.url)
        note("Ctrl-C ends the view")
        import sys

        sys.stdout.flush()
        if open:
            import webbrowser

            webbrowser.open(shown.url)
        shown.wait()
