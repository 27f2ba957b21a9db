"""A general 6R arm whose links change a little: its plan without choosing eliminations again."""

from __future__ import annotations

import numpy as np

from dh2urdf.kernels.elimination import close_loop, left_coefficients
from dh2urdf.kernels.general_6r import Array, Plan, _flat, _short_links

__all__ = ["replan_general_6r"]


def replan_general_6r(plan: Plan, links: Array) -> Plan:
    """The plan of an arm with other links (7, 4, 4), with the eliminations of a plan.

    Some 20 times faster than :func:`dh2urdf.kernels.general_6r.plan_general_6r`. Eliminations
    that are good for one arm are so for nearly all that differ in the value of a held joint.
    """
    turns, choices = plan[5], plan[6]
    short = _short_links(links)
    size = float(max(np.linalg.norm(short[1:6, :3, 3], axis=1).max(), 1e-300))
    chain = _flat(short[1:6])
    chain[:, 3::4] /= size
    lefts = np.zeros((len(choices), 14, 27))
    loop, samples = np.zeros((6, 12)), np.zeros((14, 27))
    for k, (shift, reverse) in enumerate(choices):
        close_loop(chain, np.eye(4)[:3].ravel(), shift, reverse, loop)
        left_coefficients(loop, samples, lefts[k])
    ends = np.linalg.inv(short[[0, 6]])
    return (_flat(links), chain, ends[0], ends[1], size, turns, choices, lefts)
