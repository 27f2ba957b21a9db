"""Levenberg's steps from many starts: what comes near a pose, a solution or not.

Where singularities meet, steps end beside a solution, in a valley that leads to it.
"""

import math
from typing import Annotated

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, NO_JOINT, approach, same
from dh2urdf.kernels.newton import POSE, make_damped
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.shapes import AnyChain, Counts, Floats, Poses

STEPS, STUCK = 50, 8
"""Steps from a start, and how many without a better residual end them."""

DONE = 1e-14
"""Residual [m and rad] at which nothing is left to gain."""

NEAR = 0.01
"""Residual [m and rad] of what comes near."""

APART = 1e-3
"""Joint distance [rad or m] at which two of these are two; solutions are so a thousandth of it."""

FEW = 24
"""Starts after which a pose is given up that nothing came near to."""


def come_near(chain, goal, patience, q, best, dq, damped):
    """Levenberg's steps from q (n,); the least residual, and in q the configuration that has it.

    ``patience``: how many times as many steps as usual there may be.
    """
    most = patience * STEPS, patience * STUCK, ACCEPT, DONE
    return approach(chain, goal, most, q, best, dq, damped)


@entry()
def search_starts(
    chain: AnyChain,
    starts: Annotated[Floats, "starts", "n"],
    unit: float,
    Ts: Poses,
    seeds: Annotated[Floats, "poses", "seeds", "n"],
    many: Counts,
):
    """Append to ``seeds`` (m, k, n), ``many[i]`` of pose Ts[i], what starts (s, n) lead near to.

    ``unit`` is the size of the arm [m].
    """
    joints, n = chain[1], starts.shape[1]
    trial, best, dq, damped = np.empty(n), np.empty(n), np.empty(n), make_damped(n)
    for i in range(Ts.shape[0]):
        goal, least = (POSE, Ts[i], unit), math.inf
        for s in range(starts.shape[0]):
            if s == FEW and least > NEAR and many[i] == 0:
                break
            trial[:] = starts[s]
            residual = come_near(chain, goal, 1, trial, best, dq, damped)
            least = min(least, residual)
            if not residual <= NEAR or many[i] >= seeds.shape[1]:
                continue
            reach, known = (1e-3 * APART if residual <= ACCEPT else APART), False
            for k in range(many[i]):
                known = known or same(joints, seeds[i, k], trial, reach, NO_JOINT)
            if not known:
                seeds[i, many[i]] = trial
                many[i] += 1
