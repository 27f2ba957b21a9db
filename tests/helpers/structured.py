"""Tables and configurations that people type: right angles, lengths that are zero or equal."""

import math
from dataclasses import replace

import numpy as np

import dh2urdf
from dh2urdf.dh import DHRow, DHTable

NOISE = (0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Sizes of what is added to every joint [rad or m]."""

GRIDS = (90, 45, 30, 15)
"""Steps of the grids of joint values [deg]."""

SHARES = ("all", "one", "two")
"""How many joints are on the grid; the others are random."""

ROUNDINGS = (None, 4, 9)
"""Decimals that a table's angles [rad] are rounded to."""

TWISTS = (0.0, math.pi / 2, -math.pi / 2, math.pi)
LENGTHS = (0.0, 0.0, 0.1, 0.2, 0.3, 0.4, -0.1, -0.2)
PARAMETERS = ("theta", "d", "a", "alpha")


def structured_configurations(arm, m, seed):
    """Configurations (m, n) on grids, each with its noise; slides on a grid of 0.1 m."""
    rng = np.random.default_rng(seed)
    step = np.radians(rng.choice(GRIDS, (m, 1)))
    on_grid = step * np.round(rng.uniform(-math.pi, math.pi, (m, arm.n)) / step)
    on_grid[:, arm.prismatic] = 0.1 * rng.integers(0, 4, (m, arm.n))[:, arm.prismatic]
    anywhere = rng.uniform(-math.pi, math.pi, (m, arm.n))
    anywhere[:, arm.prismatic] *= 0.1
    order = np.argsort(rng.random((m, arm.n)), axis=1)
    share = rng.choice((arm.n, arm.n, 1, 2), (m, 1))
    q = np.where(order < share, on_grid, anywhere)
    return q + rng.choice(NOISE, (m, 1)) * rng.standard_normal(q.shape)


def rounded(table, decimals):
    """The table with its angles as a file has them that was written with so many decimals."""
    if decimals is None:
        return table
    rows = (
        replace(row, theta=round(row.theta, decimals), alpha=round(row.alpha, decimals))
        for row in table.rows
    )
    return replace(table, rows=tuple(rows))


def _variant(table, rng):
    """Another arm of the kind: other lengths, and a zero one set, or one zero, or an angle turned.

    Lengths are whole centimetres.
    """
    rows = list(table.rows)
    kind = rng.integers(3)
    for i, row in enumerate(rows):
        scale = rng.uniform(0.6, 1.4, 2)
        cells = {"d": row.d * scale[0], "a": row.a * scale[1]}
        rows[i] = replace(row, **{key: round(float(cell), 2) for key, cell in cells.items()})
    i = int(rng.integers(len(rows)))
    if rows[i].origin is None and kind == 1:
        key = str(rng.choice(["d", "a"]))
        rows[i] = replace(rows[i], **{key: 0.1 if getattr(rows[i], key) == 0.0 else 0.0})
    elif rows[i].origin is None and kind == 2:
        key = str(rng.choice(["theta", "alpha"]))
        rows[i] = replace(rows[i], **{key: getattr(rows[i], key) + math.pi / 2})
    return replace(table, rows=tuple(rows), name=f"{table.name}*")


def shipped_tables():
    """The tables that ship, but those of which values move joints together.

    The referee has chains of joints alone, and they have grids of their own.
    """
    every = map(dh2urdf.load_table, dh2urdf.list_tables())
    return [table for table in every if table.joint_map is None]


def variant_tables(count, seed=0):
    """Tables of six joints or seven that differ from those that ship."""
    rng = np.random.default_rng(seed)
    tables = [table for table in shipped_tables() if len(table.rows) in (6, 7)]
    return [_variant(tables[rng.integers(len(tables))], rng) for _ in range(count)]


def random_tables(count, seed=0, joints=6):
    """Tables of right angles and lengths of few values, either convention."""
    rng, tables = np.random.default_rng(seed), []
    for k in range(count):
        rows = []
        for _ in range(joints):
            theta, alpha = rng.choice(TWISTS, 2).tolist()
            d, a = rng.choice(LENGTHS, 2).tolist()
            rows.append(DHRow(theta, d, a, alpha, sign=int(rng.choice((1, 1, 1, -1)))))
        convention = ("standard", "modified")[k % 2]
        tables.append(DHTable(tuple(rows), convention, name=f"random {seed}/{k}"))
    return tables


def sliding_tables(count, seed=0):
    """Such tables of six joints of which one, two or three slide, in any place."""
    rng, tables = np.random.default_rng(seed + 1), []
    for k, table in enumerate(random_tables(count, seed)):
        slides = rng.permutation(6)[: 1 + k % 3]
        rows = (
            replace(row, joint_type="prismatic") if i in slides else row
            for i, row in enumerate(table.rows)
        )
        tables.append(replace(table, rows=tuple(rows), name=f"sliding {seed}/{k}"))
    return tables


def bent_tables(count, seed=0):
    """Such tables with slides, each with a twist that is no right angle."""
    rng, tables = np.random.default_rng(seed + 2), []
    for table in sliding_tables(count, seed):
        rows, i = list(table.rows), int(rng.integers(6))
        rows[i] = replace(rows[i], alpha=float(rng.choice((0.8, 1.65, -2.2, math.pi / 4))))
        tables.append(replace(table, rows=tuple(rows), name=f"bent {table.name}"))
    return tables


def table_line(table):
    """The rows of a table in one line, angles in degrees, for a report."""
    cells = []
    for row in table.rows:
        theta, alpha = (f"{math.degrees(x):.12g}" for x in (row.theta, row.alpha))
        sign = " -" if row.sign < 0 else ""
        kind = "P" if row.joint_type == "prismatic" else ""
        cells.append(f"({theta},{row.d:g},{row.a:g},{alpha}){sign}{kind}")
    return f"{table.name} {table.convention.value}: {' '.join(cells)}"
