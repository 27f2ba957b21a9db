"""The referee: forward kinematics written apart from every contestant, and what it says of them.

The product of the table's rows in plain NumPy (Spong, eq. 3.10; Craig, eq. 3.6), nothing of
``dh2urdf`` but the numbers of the table.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dh2urdf import DHConvention, DHTable

__all__ = ["EXACT", "SAME", "Verdict", "fk", "judge", "residuals", "zero_frames"]

Array = NDArray[np.float64]

EXACT = 1e-8
"""Residual [m and rad] up to which a configuration counts as a solution."""

SAME = 1e-4
"""Two solutions whose joints all agree to this angle [rad] count once."""


def _rot_z(angle: Array) -> Array:
    T = np.zeros((*np.shape(angle), 4, 4))
    c, s = np.cos(angle), np.sin(angle)
    T[..., 0, 0], T[..., 0, 1], T[..., 1, 0], T[..., 1, 1] = c, -s, s, c
    T[..., 2, 2] = T[..., 3, 3] = 1.0
    return T


def _link(d: float, a: float, alpha: float, convention: DHConvention) -> tuple[Array, Array]:
    """Constant steps before and after the joint's turn about z."""
    c, s = np.cos(alpha), np.sin(alpha)
    cross = np.array([[1.0, 0, 0, a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])
    along = np.eye(4)
    along[2, 3] = d
    if convention is DHConvention.STANDARD:
        return np.eye(4), along @ cross
    return cross, along


def fk(table: DHTable, q: Array) -> Array:
    """``T_base_tool`` of configurations q (m, n) of revolute joints, shape (m, 4, 4)."""
    T = np.broadcast_to(table.base.matrix, (len(q), 4, 4))
    for row, qi in zip(table.rows, q.T, strict=True):
        before, after = _link(row.d, row.a, row.alpha, table.convention)
        T = T @ before @ _rot_z(row.sign * qi + row.theta) @ after
    return T @ table.tool.matrix


def zero_frames(table: DHTable) -> tuple[Array, Array, Array]:
    """Axes (n, 3) that turn with positive q, points on them (n, 3), tool (4, 4), all at q = 0."""
    T, axes, points = table.base.matrix, [], []
    for row in table.rows:
        before, after = _link(row.d, row.a, row.alpha, table.convention)
        frame = T @ before
        axes.append(row.sign * frame[:3, 2])
        points.append(frame[:3, 3])
        T = frame @ _rot_z(np.float64(row.theta)) @ after
    return np.array(axes), np.array(points), T @ table.tool.matrix


def residuals(T_found: Array, T: Array) -> Array:
    """Larger of position [m] and orientation error [rad] of poses (k, 4, 4), shape (k,).

    The angle between two orientations is ``2 asin(|R_1 - R_2|_F / sqrt(8))``.
    """
    position = np.linalg.norm(T_found[..., :3, 3] - T[..., :3, 3], axis=-1)
    chord = np.linalg.norm(T_found[..., :3, :3] - T[..., :3, :3], axis=(-2, -1))
    angle = 2.0 * np.arcsin(np.minimum(chord / np.sqrt(8.0), 1.0))
    return np.maximum(position, angle)


@dataclass(frozen=True)
class Verdict:
    """What one contestant gave for a set of poses.

    ``exact[i]`` are the distinct solutions of pose i that hold, ``claimed`` counts all that were
    returned, ``wrong`` those above 1e-6, ``worst`` is the largest residual of those below it.
    """

    exact: tuple[Array, ...]
    claimed: int
    wrong: int
    worst: float

    @property
    def found(self) -> int:
        """Number of distinct solutions that hold."""
        return sum(len(q) for q in self.exact)

    def recall(self, truth: Sequence[Array]) -> float:
        """Share of the known solutions that were found."""
        known = sum(len(t) for t in truth)
        found = sum(
            int(_is_among(t, own).sum()) for t, own in zip(truth, self.exact, strict=True) if len(t)
        )
        return found / known if known else 1.0


def _is_among(q: Array, others: Array) -> NDArray[np.bool_]:
    """True for rows of q (k, n) that some row of the others (l, n) equals up to full turns."""
    if not len(others):
        return np.zeros(len(q), bool)
    gap = q[:, None] - others[None]
    gap = np.abs(gap - 2.0 * np.pi * np.round(gap / (2.0 * np.pi)))
    among: NDArray[np.bool_] = (gap.max(axis=2) < SAME).any(axis=1)
    return among


def distinct(q: Array) -> Array:
    """Rows of q (k, n) that differ, the first of each."""
    kept = q[:0]
    for row in q:
        if not _is_among(row[None], kept)[0]:
            kept = np.vstack([kept, row])
    return kept


def judge(table: DHTable, Ts: Array, answers: Sequence[Array]) -> Verdict:
    """Measure each configuration of each pose's answer (k_i, n) against the pose."""
    exact, claimed, wrong, worst = [], 0, 0, 0.0
    for T, answer in zip(Ts, answers, strict=True):
        q = np.asarray(answer, float).reshape(-1, len(table.rows))
        error = residuals(fk(table, q), T)
        claimed += len(q)
        wrong += int((error > 1e-6).sum())
        worst = max(worst, float(error[error <= 1e-6].max(initial=0.0)))
        exact.append(distinct(q[error <= EXACT]))
    return Verdict(tuple(exact), claimed, wrong, worst)


def truth(verdicts: Sequence[Verdict], known: Array) -> list[Array]:
    """All solutions of each pose that anybody found, the generating one (m, n) included."""
    return [
        distinct(np.vstack([own[None], *(v.exact[i] for v in verdicts)]))
        for i, own in enumerate(known)
    ]
