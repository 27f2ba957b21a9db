"""The relation between two arms, measured: as they stand, by their axes, by least squares."""

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.comparison.alignment import aligned
from dh2urdf.comparison.refine import refined
from dh2urdf.comparison.relation import CONFIGURATIONS, Relation, plain_relations, poses
from dh2urdf.conversions.chains import configurations
from dh2urdf.transforms import Array, pose_error

SLACKS = (1e-9, 1e-6, 1e-3)
"""Slack [rad, arm's sizes] with which axes are laid on each other. Axes that are parallel but for
rounding have their common normal anywhere, so the tight one is tried first; what the wide one
finds is drawn together by least squares."""

NEAR = 1e-2
"""Error [rad, arm's sizes] up to which two arms are nearly the same, and are told how."""

ROUNDING = 1e-13
"""Error [m per m of all lengths] that is rounding, whatever the tolerance."""

Cost = Callable[[Relation], float]


class Related(NamedTuple):
    """The best relation and its largest error [m and rad]; None where nothing comes near."""

    relation: Relation | None
    error: float


def allowed(a: SerialChain, b: SerialChain, tolerance: float) -> float:
    """Largest difference [m and rad] of two arms that count as the same."""
    far = max(float(np.abs(chain.links[:, :3, 3]).sum()) for chain in (a, b))
    return max(tolerance, ROUNDING * far)


def relate(a: SerialChain, b: SerialChain, qs: Array, tolerance: float, cost: Cost) -> Related:
    """The relation of which the least has to be said, over configurations (m, n) of A.

    Where none holds within the tolerance, the nearest one.
    """
    truth, limit = poses(a, qs), allowed(a, b, tolerance)

    def best(relations: Iterable[Relation]) -> list[tuple[float, Relation]]:
        """Relations that hold, or else the nearest one."""
        made = [(pose_error(relation.poses(b, qs), truth), relation) for relation in relations]
        held = [one for one in made if one[0] <= limit]
        return held or sorted(made, key=lambda one: one[0])[:1]

    found = best(plain_relations(a, b))
    if found[0][0] <= limit and cost(found[0][1]) == 0:
        return Related(found[0][1], found[0][0])
    for slack in SLACKS:
        laid = [r.simplest(a, b, slack).wrapped(b) for r in aligned(a, b, slack)]
        found += best(laid)
        if found[-1][0] <= limit:
            break
        if slack == SLACKS[-1]:
            found += best(refined(r, a, b, qs).wrapped(b) for r in laid)
    held = [one for one in found if one[0] <= limit]
    if held:
        error, relation = min(held, key=lambda one: cost(one[1]))
        return Related(relation, error)
    error, nearest = min(found, key=lambda one: one[0])
    return Related(nearest if error <= NEAR * max(1.0, a.size) else None, error)


def holds(a: SerialChain, b: SerialChain, tolerance: float) -> bool:
    """Whether two arms are the same up to base, tool, zeros and directions."""
    if not np.array_equal(a.prismatic, b.prismatic):
        return False
    qs = configurations(a, CONFIGURATIONS, a.size)
    truth, limit = poses(a, qs), allowed(a, b, tolerance)
    return any(
        pose_error(relation.with_tool(a, b).poses(b, qs), truth) <= limit
        for slack in SLACKS[:2]
        for relation in aligned(a, b, slack)
    )
