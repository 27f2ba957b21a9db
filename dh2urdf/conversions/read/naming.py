"""Names of links and joints in messages."""

import difflib
from collections.abc import Iterable

from dh2urdf.dh_io.files import shown
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError


def listed(names: Iterable[str]) -> str:
    """The first forty names, and how many more."""
    everyone = list(names)
    more = f" and {len(everyone) - 40} more" if len(everyone) > 40 else ""
    return ", ".join(map(shown, everyone[:40])) + more


def no_such(name: object, names: Iterable[str], owner: str) -> str:
    """What to say of a name that is not among those there are."""
    everyone = list(names)
    near = {other[:60]: other for other in everyone}
    close = difflib.get_close_matches(name[:60], near, 1) if isinstance(name, str) else []
    hint = f"; did you mean {shown(near[close[0]])!r}?" if close else ""
    said = repr(shown(name)) if isinstance(name, str) else found(name)
    return f"{said}; {owner} has {listed(everyone)}{hint}"


def link_name(name: object, what: str) -> str | None:
    """The name of an end of the chain, in characters that a file can have."""
    if name is None or isinstance(name, str):
        return None if name is None else name.encode(errors="replace").decode()
    raise ArgumentError(f"{what}: expected the name of a link, got {found(name)}")
