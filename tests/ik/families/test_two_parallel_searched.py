"""Structured poses of arms with two parallel axes and two that meet, against 400 starts each."""

from collections import Counter

import numpy as np
import pytest
from ik_referee import forward, residuals, search, shipped, solve
from structured import structured_configurations
from sweep import LEAST, MOST, REGULAR, ROUNDING, contains, smallest
from test_two_parallel import CLASSES, SHIPPED, random_chain

from dh2urdf.ik.arm.solver_order import select_solver

POSES = 10
"""Poses of an arm."""

REACHED = 4e-15
"""Residual [m and rad] of a singular end of a start that is a solution: along a valley starts end
where they are accepted, as far from it as their residual over the smallest singular value."""

EVERY = np.ones(6, bool)


def chains_of(piece):
    """Five arms that ship and five of right angles, of each class in turn."""
    chains, classes, seed = [shipped(name) for name in SHIPPED], list(CLASSES), 100 * piece
    while len(chains) < 2 * len(SHIPPED):
        geometry = classes[(piece + len(chains)) % len(classes)]
        chain = random_chain(geometry, "standard", seed, square=True)
        seed += 1
        if select_solver(chain).name == "two parallel axes":
            chains.append(chain)
    return chains


@pytest.mark.exhaustive
@pytest.mark.parametrize("piece", range(10))
def test_what_400_starts_find_the_polynomial_has_counted(piece):
    """Each of their solutions is a solution, or on a named family; regular ones are found alone.

    And the starts find all but a few of the regular solutions: so they are a second method.
    """
    count, lost = Counter(), []
    for number, chain in enumerate(chains_of(piece)):
        q = structured_configurations(chain, POSES, 1000 * piece + number)
        Ts = forward(chain, q)
        found = solve(chain, Ts)
        for i, T in enumerate(Ts):
            mine, _, _, masks = found.of(i)
            others = search(chain, T, seed=i)
            sigma = smallest(chain, others, EVERY)
            count["poses"] += 1
            count["found"] += int((smallest(chain, mine, EVERY) > REGULAR).sum())
            count["searched"] += int((sigma > REGULAR).sum())
            count["singular"] += int((sigma <= REGULAR).sum())
            for p, small in zip(others, sigma, strict=True):
                if small <= REGULAR and residuals(chain, p, T) > REACHED:
                    count["of a valley"] += 1
                    continue
                tolerance = float(np.clip(ROUNDING / max(small, 1e-300), LEAST, MOST))
                regular = small > REGULAR
                known = mine, np.where(regular, 0, masks), p, T, tolerance
                if not contains(chain, *known):
                    count["regular lost" if regular else "singular lost"] += 1
                    lost.append((number, q[i].tolist(), p.tolist(), float(small)))
    print(f"\npiece {piece}: {dict(count)}", *lost, sep="\n")
    assert count["regular lost"] == 0
    assert count["singular lost"] <= 1e-4 * count["singular"]
    assert count["searched"] >= 0.98 * count["found"]
