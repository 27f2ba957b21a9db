"""Five joints with axes 2, 3, 4 parallel, in lanes: the same solutions as by the closed loop."""

import math

import ik_checks as checks
import ik_referee as referee
import numpy as np
import pytest
from margins import assert_margin

import dh2urdf
from dh2urdf.ik.families.short import ShortChain
from dh2urdf.kernels.parallel_axes import solve_five_parallel

HALF = math.pi / 2

SHIPPED = [name for name in dh2urdf.list_tables() if referee.shipped(name).n == 5]

ODD = {
    "offsets everywhere": ((0.3, 0.05, 1.5708), (0.1, 0.4, 0), (-0.05, 0.3, 0), (0.02, 0.1, 0.9)),
    "leaning base": ((0.2, 0.1, 0.7), (0.02, 0.3, 0), (0.03, 0.35, 0), (0, 0.04, -1.2)),
    "no offsets": ((0.2, 0, -HALF), (0, 0.3, 0), (0, 0.3, 0), (0, 0, HALF)),
    "rounded": ((0.2, 0, -1.5708), (0, 0.3, 0), (0, 0.3, 0), (0, 0, 1.5708)),
}
"""Denavit-Hartenberg steps (d, a, alpha) before the last axis; the other shoulder of `rounded` is a
solution, nearly."""


def chain_of(name):
    if name in ODD:
        return referee.arm((*ODD[name], (0.1, 0.02, 0.3)), "RRRRR")
    return referee.shipped(name)


def both(chain):
    """The solver in lanes, and the one that always takes the loop."""
    fast, slow = ShortChain(chain), ShortChain(chain)
    slow.lanes = None
    assert fast.lanes is not None
    return fast, slow


def configurations(chain, kind, m, rng):
    """Anywhere; at whole parts of a turn; beside them; with the elbow nearly straight or folded."""
    if kind == "random":
        return referee.draw(chain, m, 3)
    if kind == "straight":
        q, (form, sign) = referee.draw(chain, m, 4), ShortChain(chain).lanes[1][2, [4, 6]]
        away = 10.0 ** rng.uniform(-9.0, -1.0, m)
        q[:, 2] = sign * (rng.integers(0, 2, m) * np.pi + away - form)
        return q
    q = rng.integers(-12, 13, (m, 5)) * np.pi / (12 if kind == "fine" else 4)
    if kind == "beside":
        q += 10.0 ** rng.uniform(-9.0, -2.0, (m, 1)) * rng.standard_normal((m, 5))
    return q


def assert_same(chain, found, other):
    """The same number of solutions at each pose, the same ones, the same free joints."""
    np.testing.assert_array_equal(found.count, other.count)
    for i in range(len(found.count)):
        mine, theirs = found.of(i), other.of(i)
        for q, mask in zip(mine[0], mine[3], strict=True):
            apart = referee.gaps(chain, theirs[0], q)
            assert apart.min() < 1e-5
            assert mask == theirs[3][apart.argmin()]


@pytest.mark.parametrize("kind", ["random", "quarters", "fine", "beside", "straight"])
@pytest.mark.parametrize("name", [*SHIPPED, *ODD])
def test_lanes_find_what_the_loop_finds(name, kind):
    """Within limits and without, seen from the base and from the tool."""
    for chain in (chain_of(name), chain_of(name).reversed()):
        fast, slow = both(chain)
        rng = np.random.default_rng(5)
        Ts = referee.forward(chain, configurations(chain, kind, 60, rng))
        for inside in (False, True):
            found = referee.solve(chain, Ts, inside, solver=fast)
            assert_same(chain, found, referee.solve(chain, Ts, inside, solver=slow))


@pytest.mark.parametrize("size", [1e-11, 3e-10, 9e-10, 3e-9, 1e-7])
@pytest.mark.parametrize("name", [*SHIPPED, *ODD])
def test_poses_that_are_nearly_reached_have_the_solutions_of_the_loop(name, size):
    """A pose that is off by about what a residual may be is not lost, and none is added."""
    chain, rng = chain_of(name), np.random.default_rng(6)
    fast, slow = both(chain)
    for kind in ("random", "straight"):
        Ts = referee.forward(chain, configurations(chain, kind, 60, rng))
        Ts[:, :3, 3] += size * rng.standard_normal((60, 3))
        found = referee.solve(chain, Ts, solver=fast)
        assert_same(chain, found, referee.solve(chain, Ts, solver=slow))


@pytest.mark.parametrize("name", [*SHIPPED, *ODD][:-1])
def test_solutions_are_complete_and_certified(name):
    """2,000 poses: all at rounding, none twice, the generating one among them."""
    chain = chain_of(name)
    q = referee.draw(chain, 2000, 9)
    Ts = referee.forward(chain, q)
    checks.check_all(chain, q, referee.solve(chain, Ts), Ts)


@pytest.mark.parametrize("name", SHIPPED)
def test_most_poses_need_no_loop(name):
    """Fewer than one in fifty random poses is in doubt; that one is the loop's."""
    chain = referee.shipped(name)
    Ts = referee.forward(chain, referee.draw(chain, 5000, 8))
    lanes = ShortChain(chain).lanes
    out = referee.Outputs.of(len(Ts), 8, 5)
    doubts = solve_five_parallel(lanes, Ts, False, out)
    assert doubts == (out.counts < 0).sum()
    assert_margin(doubts / len(Ts), 0.02, 1)
