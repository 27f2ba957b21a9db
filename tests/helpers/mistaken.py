"""Tables with one mistake in them, and tables that are another writing of the same arm."""

import math
from dataclasses import replace

import numpy as np
from dh_product import rigid, shift, turn

from dh2urdf.chain import SerialChain

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])

KINDS = (
    "sign of alpha",
    "a and d swapped",
    "theta left out",
    "convention",
    "degrees for radians",
    "order of rows",
    "mm for m",
)


def with_row(table, i, **cells):
    """The table with cells of row i (from 0)."""
    rows = list(table.rows)
    rows[i] = replace(rows[i], **cells)
    return replace(table, rows=tuple(rows))


def mistake(table, kind, rng):
    """The table with a mistake of a kind, and its rows (from 1); None where no row can have it."""
    rows = table.rows
    if kind == "convention":
        other = "standard" if table.convention == "modified" else "modified"
        return replace(table, convention=other), set()
    fits = {
        "sign of alpha": lambda r: abs(math.sin(r.alpha)) > 1e-3,
        "a and d swapped": lambda r: abs(r.a - r.d) > 1e-3,
        "theta left out": lambda r: abs(math.remainder(r.theta, 2 * math.pi)) > 1e-3,
        "degrees for radians": lambda r: abs(math.sin(r.alpha)) > 1e-3,
        "order of rows": lambda r: r is not rows[-1],
        "mm for m": lambda r: max(abs(r.a), abs(r.d)) > 1e-3,
    }[kind]
    possible = [i for i, row in enumerate(rows) if row.origin is None and fits(row)]
    if kind == "order of rows":  # a step behind the last joint moves the tool alone
        possible = [i for i in possible if rows[i + 1].origin is None]
    if not possible:
        return None
    i = int(rng.choice(possible))
    r = rows[i]
    if kind == "sign of alpha":
        return with_row(table, i, alpha=-r.alpha), {i + 1}
    if kind == "a and d swapped":
        return with_row(table, i, a=r.d, d=r.a), {i + 1}
    if kind == "theta left out":
        return with_row(table, i, theta=0.0), {i + 1}
    if kind == "degrees for radians":
        return with_row(table, i, alpha=math.degrees(r.alpha)), {i + 1}
    if kind == "mm for m":
        return with_row(table, i, a=1000 * r.a, d=1000 * r.d), {i + 1}
    moved = [*rows[:i], rows[i + 1], rows[i], *rows[i + 2 :]]
    return replace(table, rows=tuple(moved)), {i + 1, i + 2}


def motion(slides, value):
    """What a joint does."""
    return shift(2, value) if slides else turn(2, value)


def product(links, prismatic, q):
    """``T_base_tool`` of a chain, factor by factor."""
    T = links[0]
    for link, slides, value in zip(links[1:], prismatic, q, strict=True):
        T = T @ motion(slides, value) @ link
    return T


def pose(rng, size):
    """Any pose."""
    return rigid(rng.uniform(-size, size, 3), rng.uniform(-3, 3, 3))


def rewritten(chain, rng, *, base=False, tool=False, zeros=False, directions=False):
    """The chain with its frames elsewhere on (or, sliding, beside) their axes, and other ends."""
    links, n = np.array(chain.links), chain.n
    for k, slides in enumerate(chain.prismatic):
        on_axis = turn(2, rng.uniform(-3, 3)) @ shift(2, rng.uniform(-0.3, 0.3))
        if slides:
            on_axis = shift(0, rng.uniform(-0.3, 0.3)) @ shift(1, rng.uniform(-0.3, 0.3)) @ on_axis
        if zeros:
            links[k] = links[k] @ motion(
                slides, rng.uniform(-0.2, 0.2) if slides else rng.uniform(-3, 3)
            )
        if directions and rng.random() < 0.5:
            on_axis = on_axis @ FLIP
        links[k], links[k + 1] = links[k] @ on_axis, np.linalg.inv(on_axis) @ links[k + 1]
    links[0] = pose(rng, 1.0) @ links[0] if base else links[0]
    links[n] = links[n] @ pose(rng, 0.2) if tool else links[n]
    return SerialChain(links, chain.joint_types, chain.names, chain.lower, chain.upper)
