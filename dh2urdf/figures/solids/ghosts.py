"""Other configurations drawn behind the arm: those that look alike share a colour and a line."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from dh2urdf.drawing.arm import DrawnArm
from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.figures.style import INK, plain
from dh2urdf.transforms import Array

ALIKE = 1e-6
"""Distance of all joints, as a share of the arm's size, up to which two arms look alike."""


class Ghost(NamedTuple):
    """Joints (n,), their colour, what the key says of it; which of those given it is, from 0.

    One that looks like the arm itself is not drawn: its colour is that of ink.
    """

    q: Array
    colour: str
    name: str
    number: int = -1

    @property
    def is_drawn(self) -> bool:
        """False for one that the arm itself covers."""
        return self.colour != INK


def group_ghosts(
    arm: DrawnArm, q: Array, ghosts: Sequence[Array], names: Sequence[str]
) -> list[Ghost]:
    """Ghosts with their colours, beside the arm at q (n,); those that look alike are one.

    There may be fewer names than ghosts.
    """
    places = [arm.frames(one)[:, :3, 3] for one in (q, *ghosts)]
    groups: list[list[int]] = [[0]]
    for k in range(1, len(places)):
        near = (g for g in groups if np.abs(places[g[0]] - places[k]).max() < ALIKE * arm.size)
        if (group := next(near, None)) is None:
            groups.append(group := [])
        group.append(k)
    padded = ["", *map(plain, names), *[""] * (len(ghosts) - len(names))]
    out = []
    for rank, group in enumerate(groups):
        own = [padded[k] for k in group if padded[k]]
        if rank == 0:
            out += [Ghost(q, INK, f"as drawn: {merged_name(own)}")] if own else []
            continue
        colour = BRANCH_COLOURS[(rank - 1) % len(BRANCH_COLOURS)]
        number = group[0] - 1
        out.append(Ghost(ghosts[number], colour, merged_name(own), number))
    return out


def merged_name(names: Sequence[str]) -> str:
    """Names of several as one: ``elbow up, wrist flip or no flip``."""
    parts = [name.split(", ") for name in names]
    if len({len(p) for p in parts}) != 1:
        return " / ".join(names)
    return ", ".join(_alternatives(column) for column in zip(*parts, strict=True))


def _alternatives(words: Sequence[str]) -> str:
    """Different endings behind their common first word."""
    different = list(dict.fromkeys(words))
    head = different[0].partition(" ")[0]
    if len(different) == 1 or any(word.partition(" ")[0] != head for word in different):
        return " or ".join(different)
    return f"{head} " + " or ".join(word.partition(" ")[2] for word in different)
