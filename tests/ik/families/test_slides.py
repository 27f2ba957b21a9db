"""Six joints of which some slide, with neither a wrist nor another closed form."""

import itertools
import math

import numpy as np
import pytest
from ik_checks import check_all
from ik_referee import arm, forward, gaps, regularity, search, solve
from margins import assert_margin

from dh2urdf.ik.arm.solver_order import select_solver

REACH = 1.0
"""How far slides move either way [m]; the arms have links of up to 0.7 m."""


def classes(slides):
    """Kinds of six joints with so many slides: ``PRRRRR``, ``RPRRRR``, ..."""
    for places in itertools.combinations(range(6), slides):
        yield "".join("P" if i in places else "R" for i in range(6))


def slider(kinds, right_angled, seed=0):
    """An arm of six random rows, its twists right angles or random ones."""
    rng = np.random.default_rng([seed, right_angled, *map(ord, kinds)])
    rows = rng.uniform((-0.5, -0.5, -3.1), (0.5, 0.5, 3.1), (6, 3))
    if right_angled:
        rows[:, 2] = rng.choice((-1, 1), 6) * math.pi / 2
    return arm(tuple(map(tuple, rows.tolist())), kinds, seed)


def configurations(chain, m, seed, least=1e-3):
    """Random configurations (m, 6), one in three near a singularity, none nearer than ``least``."""
    rng, found = np.random.default_rng(seed), np.empty((0, 6))
    span = np.where(chain.prismatic, REACH, math.pi)
    while len(found) < m:
        q = rng.uniform(-span, span, (4 * m, 6))
        sigma = regularity(chain, q)
        near = np.argsort(sigma)[: m // 3]
        some = np.concatenate([q[near], q[: m - len(near)]])
        found = np.concatenate([found, some[regularity(chain, some) > least]])
    return found[:m]


KINDS = list(classes(1))


@pytest.mark.parametrize("right_angled", [False, True])
@pytest.mark.parametrize("kinds", KINDS)
def test_the_generating_configuration_is_among_distinct_solutions(kinds, right_angled):
    """Any class of joints: at 400 poses all solutions reach them, and one is what made the pose."""
    chain = slider(kinds, right_angled)
    q = configurations(chain, 400, seed=1)
    Ts = forward(chain, q)
    found = solve(chain, Ts)
    check_all(chain, q, found, Ts)
    assert select_solver(chain).name == f"general {kinds}"


@pytest.mark.parametrize("kinds", KINDS)
def test_a_search_from_100_starts_finds_no_other_solution(kinds):
    """Counts are those of Newton's method from random starts."""
    for right_angled in (False, True):
        chain = slider(kinds, right_angled, seed=1)
        Ts = forward(chain, configurations(chain, 2, seed=2))
        found = solve(chain, Ts)
        for i, T in enumerate(Ts):
            others = search(chain, T, i, starts=100)
            assert_margin(gaps(chain, found.of(i)[0], others[:, None]).min(axis=1), 1e-6)
            assert len(others) <= found.count[i]
