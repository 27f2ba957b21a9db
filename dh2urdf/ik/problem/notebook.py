"""Solutions as a notebook shows them."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.grids import grid_html, number, paragraph
from dh2urdf.transforms import Array


class Listed(Protocol):
    """What of solutions is shown."""

    @property
    def q(self) -> Array:
        """Configurations (k, n)."""

    @property
    def residual(self) -> Array:
        """Of each, (k,)."""

    @property
    def branch(self) -> tuple[str, ...]:
        """Of each."""

    @property
    def free_joints(self) -> tuple[tuple[int, ...], ...]:
        """Of each."""


def solutions_html(found: Listed, chain: SerialChain) -> str:
    """A row for each solution: degrees or millimetres, branch, residual."""
    if not len(found.q):
        return paragraph("no solution")
    slides: list[bool] = chain.prismatic.tolist()
    units = ["mm" if slide else "\N{DEGREE SIGN}" for slide in slides]
    shown = np.where(chain.prismatic, 1000.0 * found.q, np.degrees(found.q)).round(3)
    header = ["", *(f"{name} [{u}]" for name, u in zip(chain.names, units, strict=True))]
    rows = []
    for i, (q, branch, free, residual) in enumerate(
        zip(shown.tolist(), found.branch, found.free_joints, found.residual, strict=True)
    ):
        notes = [branch] if branch else []
        notes += [f"free: {', '.join(chain.names[j] for j in free)}"] if free else []
        rows.append([str(i), *map(number, q), "; ".join(notes), f"{residual:.1e}"])
    many = f"{len(rows)} solutions" if len(rows) > 1 else "1 solution"
    keys = ["", *("d" if slide else "theta" for slide in slides), "", ""]
    return grid_html([*header, "branch", "residual"], rows, keys=keys, caption=many)
