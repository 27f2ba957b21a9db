"""A relation between two arms drawn to where they differ least: Gauss and Newton on SE(3)."""

from dataclasses import replace

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.comparison.relation import Relation, poses
from dh2urdf.kernels.chain import chain_jacobian_batch
from dh2urdf.transforms import Array, pose, product, rotation

STEPS = 8
"""Steps from a relation that is off by a thousandth; each squares the error."""


def refined(relation: Relation, a: SerialChain, b: SerialChain, qs: Array) -> Relation:
    """Base, tool and offsets of least squares over configurations (m, n)."""
    truth = poses(a, qs)
    for _ in range(STEPS):
        error, J = _linear(relation, truth, b, qs)
        step = np.asarray(np.linalg.lstsq(J, error, rcond=1e-9)[0], float)
        relation = replace(
            relation,
            base=product(_exp(step[:6]), relation.base),
            tool=product(relation.tool, _exp(step[6:12])),
            offsets=relation.offsets + step[12:],
        )
        if np.abs(step).max() < 1e-13:
            break
    return relation


def _linear(relation: Relation, truth: Array, b: SerialChain, qs: Array) -> tuple[Array, Array]:
    """The errors, 6 m numbers, and what small twists and offsets do to them: (6 m, 12 + n)."""
    links = b.links.copy()
    links[0], links[-1] = product(relation.base, links[0]), product(links[-1], relation.tool)
    there = np.ascontiguousarray(relation.configurations(qs))
    J = np.empty((len(qs), 6, b.n))
    chain_jacobian_batch(links, b.prismatic, there, J)
    T = relation.poses(b, qs)
    R, p = T[:, :3, :3], T[:, :3, 3]
    off = product(truth[:, :3, :3], np.swapaxes(R, -1, -2))
    turned = 0.5 * (off - np.swapaxes(off, -1, -2))[:, [2, 0, 1], [1, 2, 0]]
    error = np.concatenate([truth[:, :3, 3] - p, turned], axis=-1)
    by_base, by_tool = np.zeros((len(qs), 6, 6)), np.zeros((len(qs), 6, 6))
    by_base[:, :3, :3] = by_base[:, 3:, 3:] = np.eye(3)
    by_base[:, :3, 3:] = np.cross(np.eye(3)[None], p[:, None, :]).swapaxes(-1, -2)
    by_tool[:, :3, :3] = by_tool[:, 3:, 3:] = R
    return error.ravel(), np.concatenate([by_base, by_tool, J], axis=-1).reshape(-1, 12 + b.n)


def _exp(twist: Array) -> Array:
    """A small motion (linear, angular) as a rigid pose, to first order."""
    angle = float(np.linalg.norm(twist[3:]))
    return pose(rotation(twist[3:] / angle, angle) if angle > 0 else np.eye(3), twist[:3])
