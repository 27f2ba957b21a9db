"""Random arms of every class that has a solver, made by what makes the class."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from coupled_arms import painter, palletiser

import dh2urdf
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.exceptions import NoSolverError
from tests.referee.tasks import TASKS

KEYS = ("theta", "d", "a", "alpha")

Rows = list[dict[str, float]]


def any_rows(rng: np.random.Generator, n: int) -> Rows:
    """Rows without any structure; twists are not within 0.3 of being parallel."""
    rows = rng.uniform((-3, -0.4, -0.4, 0.3), (3, 0.4, 0.4, 2.8), (n, 4))
    rows[:, 3] *= rng.choice((-1, 1), n)
    return [dict(zip(KEYS, row.tolist(), strict=True)) for row in rows]


def with_zeros(n: int, *zeros: tuple[int, str]) -> Callable[[np.random.Generator], Rows]:
    """Rows of which some parameters, by joint and name, are zero."""

    def make(rng: np.random.Generator) -> Rows:
        rows = any_rows(rng, n)
        for joint, key in zeros:
            rows[joint - 1][key] = 0.0
        return rows

    return make


WRIST = ((4, "a"), (5, "a"), (5, "d"))
SHOULDER = ((1, "a"), (2, "a"), (2, "d"))
"""What is zero where the last three axes meet, or the first three."""

OFF = 1e-6
"""How far nearly parallel axes are from it [rad]."""


def nearly(make: Callable[[np.random.Generator], Rows]) -> Callable[[np.random.Generator], Rows]:
    """The same with every angle off by a little."""

    def off(rng: np.random.Generator) -> Rows:
        rows = make(rng)
        for row in rows:
            row["alpha"] += OFF * rng.uniform(-1, 1)
        return rows

    return off


PARALLEL = with_zeros(6, (2, "alpha"), (3, "alpha"))

MAKERS: dict[str, tuple[Callable[[np.random.Generator], Rows], str]] = {
    "spherical wrist": (with_zeros(6, *WRIST), ""),
    "wrist with a slide": (with_zeros(6, *WRIST), "123"),
    "three parallel": (PARALLEL, ""),
    "spherical shoulder": (with_zeros(6, *SHOULDER), ""),
    "three parallel in the wrist": (with_zeros(6, (3, "alpha"), (4, "alpha")), ""),
    "planar": (with_zeros(3, (1, "alpha"), (2, "alpha")), ""),
    "three slides": (with_zeros(6), "3 of 6"),
    "one slide": (with_zeros(6), "123456"),
    "four joints": (with_zeros(4), ""),
    "five joints": (with_zeros(5), ""),
    "nearly parallel": (nearly(PARALLEL), ""),
    "nearly a wrist": (nearly(with_zeros(6, *WRIST)), ""),
    "two parallel": (with_zeros(6, (2, "alpha")), ""),
    "general": (with_zeros(6), ""),
    "seven joints, one held": (with_zeros(7), ""),
    "seven with a wrist, one held": (with_zeros(7, (5, "a"), (6, "a"), (6, "d")), ""),
}
"""By the class's name: its rows, and which joint slides."""

COUPLED = (palletiser, painter)
"""Arms whose joints move together, which get other lengths."""


def table_of(name: str, seed: int) -> DHTable:
    """A random arm of a class."""
    rng = np.random.default_rng([seed, len(name), *name.encode()])
    if name == "coupled":
        made = COUPLED[int(rng.integers(len(COUPLED)))]()
        rows = (
            replace(r, d=r.d * rng.uniform(0.6, 1.4), a=r.a * rng.uniform(0.6, 1.4))
            for r in made.rows
        )
        return replace(made, rows=tuple(rows))
    if name in TASKS:
        make, sliding = with_zeros(TASKS[name].joints), ""
    else:
        make, sliding = MAKERS[name]
    rows, slides = make(rng), set[int]()
    if sliding == "3 of 6":
        slides = set((rng.permutation(6)[:3] + 1).tolist())
    elif sliding:
        slides = {int(rng.choice(list(sliding)))}
    kinds = ("prismatic" if i in slides else "revolute" for i in range(1, len(rows) + 1))
    free = tuple(
        DHRow(**row, joint_type=kind, lower=-math.pi, upper=math.pi)
        for row, kind in zip(rows, kinds, strict=True)
    )
    return DHTable(free, "standard", name=f"{name} {seed}")


def shipped() -> Iterator[DHTable]:
    """Arms that ship and have a solver of the whole pose."""
    for name in dh2urdf.list_tables():
        table = dh2urdf.load_table(name)
        try:
            solved = dh2urdf.Robot.from_dh(table).solver is not None
        except NoSolverError:
            solved = False
        if solved:
            yield table


CLASSES = ["shipped", *MAKERS, "coupled", *TASKS]
