"""Tasks ``position`` and ``position+axis``, and arms with joints to spare."""

import itertools
import math

import ik_referee as referee
import numpy as np
import pytest
from dh_product import rows, turn
from ik_referee import GAP, RESIDUAL
from margins import assert_apart, assert_margin
from test_short_chains import HALF, chain_of

import dh2urdf
from dh2urdf.ik.arm import Task, spare_joints, task_error
from dh2urdf.ik.arm.solver_order import select_solver

STEPS = {
    "any axes": ((0.2, 0.3, 0.7), (-0.1, 0.4, -1.1), (0.3, 0.2, 0.4)),
    "right angles": ((0.3, 0, HALF), (0, 0.5, 0), (0, 0.4, 0)),
    "offsets": ((0.3, 0.1, HALF), (0.1, 0.5, HALF), (0.2, 0.4, 0)),
}
KINDS = ["".join(k) for n in (1, 2, 3) for k in itertools.product("RP", repeat=n)]


def distances(chain, q, T):
    return np.linalg.norm(referee.forward(chain, q)[..., :3, 3] - T[..., :3, 3], axis=-1)


@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("kinds", KINDS)
def test_positions_of_any_three_joints(kinds, steps):
    """Every kind of one to three joints: all rows reach the point, the original is among them."""
    chain = chain_of(kinds, STEPS[steps][: len(kinds)])
    if spare_joints(chain, Task.POSITION):
        pytest.skip("slides in a plane or a joint through the tool: covered by the spare joints")
    solver = select_solver(chain, Task.POSITION)
    q = referee.draw(chain, 200, 3)
    Ts = referee.forward(chain, q)
    found = referee.solve(chain, Ts, solver=solver)
    solutions, owner = referee.rows_of(found)
    assert_margin(found.residual[referee.exists(found)], RESIDUAL)
    assert_margin(distances(chain, solutions, Ts[owner]), RESIDUAL)
    assert_margin(referee.misses(chain, found, q), GAP)
    assert not found.free[referee.exists(found)].any()
    assert_apart(referee.distances(chain, found), GAP)


@pytest.mark.parametrize("steps", STEPS)
@pytest.mark.parametrize("kinds", ["RRR", "RRP", "RPR", "PRR"])
def test_no_position_that_a_search_finds_is_missing(kinds, steps):
    """Newton on the three equations from 200 starts finds no configuration that is missing."""
    chain = chain_of(kinds, STEPS[steps])
    if spare_joints(chain, Task.POSITION):
        pytest.skip("covered by the spare joints")
    solver = select_solver(chain, Task.POSITION)
    for target in referee.draw(chain, 3, 4):
        T = referee.forward(chain, target)
        solutions = referee.solve(chain, T[None], solver=solver).of(0)[0]
        q = referee.draw(chain, 200, 5)
        for _ in range(60):
            e = T[:3, 3] - referee.forward(chain, q)[:, :3, 3]
            J = referee.jacobians(chain, q)[:, :3]
            A = J @ J.swapaxes(1, 2) + 1e-12 * np.eye(3)
            step = (J.swapaxes(1, 2) @ np.linalg.solve(A, e[..., None]))[..., 0]
            q += np.clip(step, -0.3, 0.3)
        others = q[distances(chain, q, T) < 1e-12]
        if len(others):
            assert_margin(referee.gaps(chain, solutions, others[:, None]).min(axis=1), 1e-5)


def test_beyond_the_reach_of_a_position_arm_is_nothing():
    """1e-6 m over the stretched arm none; on it one."""
    chain = chain_of("RRR", ((0.3, 0, HALF), (0, 0.5, 0), (0, 0.4, 0)))
    solver = select_solver(chain, Task.POSITION)
    best = np.linalg.norm(referee.forward(chain, referee.draw(chain, 1, 0)[0])[:3, 3])
    assert best > 0
    straight = stretched(chain)
    T = referee.forward(chain, straight)
    shoulder = chain.points[1]
    out = (T[:3, 3] - shoulder) / np.linalg.norm(T[:3, 3] - shoulder)
    assert referee.solve(chain, T[None], solver=solver).count[0] in (1, 2)
    T[:3, 3] += 1e-6 * out
    assert referee.solve(chain, T[None], solver=solver).count[0] == 0


def stretched(chain):
    """The elbow that takes the tool farthest from axis 2's point, by bisection of the slope."""
    q = np.array([0.3, 0.4, 0.0])

    def reach(t):
        p = referee.forward(chain, np.array([q[0], q[1], t]))[:3, 3]
        return np.linalg.norm(p - chain.points[1])

    t = max(np.linspace(-math.pi, math.pi, 721), key=reach)
    low, high = t - 0.01, t + 0.01
    for _ in range(200):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        low, high = (a, high) if reach(a) < reach(b) else (low, b)
    return np.array([q[0], q[1], 0.5 * (low + high)])


FIVE = {
    "any axes": ("RRRRR", ".2 .3 .7; -.1 .4 -1.1; .3 .2 .4; .1 -.2 1.3; .1 .2 .5"),
    "elbow, bent tool": ("RRRRR", ".3 .05 h; 0 .4 0; 0 .3 0; 0 0 h; .2 0 .6"),
    "three axes": ("RRR", ".2 .3 .7; -.1 .4 -1.1; .3 .2 .4"),
    "gantry, two axes": ("PPPRR", "0 0 h; 0 0 h; 0 0 0; .1 0 h; .2 .1 h"),
}


@pytest.mark.parametrize("name", FIVE)
def test_position_and_axis(name):
    """Up to five joints: the tool's origin and z are reached, the original is found."""
    kinds, steps = FIVE[name]
    chain = referee.arm(rows(steps), kinds)
    solver = select_solver(chain, Task.POSITION_AXIS)
    q = referee.draw(chain, 200, 6)
    Ts = referee.forward(chain, q)
    found = referee.solve(chain, np.ascontiguousarray(Ts @ turn(2, 0.7)), solver=solver)
    solutions, owner = referee.rows_of(found)
    error = referee.forward(chain, solutions) - Ts[owner]
    assert_margin(np.abs(error[:, :3, 2:]).max(axis=(1, 2)), RESIDUAL)
    assert_margin(referee.misses(chain, found, q), GAP)


def test_joint_about_the_tool_is_free_for_the_axis():
    """Five joints, the last about the tool's z: it is held, and named as free."""
    chain = chain_of("RRRRR", rows(".3 .05 h; 0 .4 0; 0 .3 0; 0 0 h; .2 0 0"))
    links = chain.links.copy()
    links[-1] = np.eye(4)
    links[-1][2, 3] = 0.2
    straight = type(chain)(links, chain.joint_types, chain.names, chain.lower, chain.upper)
    solver = select_solver(straight, Task.POSITION_AXIS)
    assert solver.name == "joints to spare"
    q = referee.draw(straight, 200, 7)
    Ts = referee.forward(straight, q)
    found = referee.solve(straight, Ts, solver=solver)
    solutions, owner = referee.rows_of(found)
    assert set(found.free[referee.exists(found)].tolist()) == {0b10000}
    error = referee.forward(straight, solutions) - Ts[owner]
    assert_margin(np.abs(error[:, :3, 2:]).max(axis=(1, 2)), RESIDUAL)
    assert_margin(referee.misses(straight, found, q * [1, 1, 1, 1, 0]), GAP)


def test_task_error_counts_what_the_task_asks_for():
    """Turning the tool about its z is no error of position+axis, tilting it none of position."""
    T = referee.random_pose(np.random.default_rng(0), 1.0)
    about_z, about_x = np.eye(4), np.eye(4)
    about_z[:2, :2] = about_x[1:3, 1:3] = [[0.8, -0.6], [0.6, 0.8]]

    def size(turn, task):
        return np.linalg.norm(task_error((T @ turn)[None], T, task))

    assert size(about_z, Task.POSITION_AXIS) < 1e-15
    assert size(about_x, Task.POSITION_AXIS) == pytest.approx(0.6)
    assert size(about_x, Task.POSITION) < 1e-15
    assert size(about_z, Task.POSE) == pytest.approx(0.6)


def test_a_joint_that_moves_alone_is_held_at_one_value():
    """No other value of the joint about the tool is tried: none could reach what rest does not."""
    chain = dh2urdf.Robot.from_dh("xarm5").chain
    solver = select_solver(chain, Task.POSITION_AXIS)
    assert solver.values == [(0.0,)]
