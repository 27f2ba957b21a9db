"""Arms that no closed form covers, and all others, through the general 6R solver."""

import math

import numpy as np
import pytest
from general_6r_arms import ARMS
from ik_referee import (
    CLOSED_FORMS,
    GAP,
    RESIDUAL,
    arm,
    by_pinocchio,
    distances,
    draw,
    exists,
    forward,
    gaps,
    misses,
    pose_errors,
    regularity,
    rows_of,
    search,
    shipped,
    solve,
)
from margins import assert_apart, assert_margin

import dh2urdf
from dh2urdf.ik.arm import Task
from dh2urdf.ik.arm.solver_order import SOLVERS, imported, select_solver
from dh2urdf.ik.families.general_6r import General6R

NON_PIEPER = ["fanuc_crx10ia", "fanuc_crx10ia_l", "kinova_jaco2", "xarm6", "abb_gofa5"]


def generic(seed):
    """A chain of six random rows."""
    rng = np.random.default_rng(seed)
    rows = rng.uniform((-0.5, -0.5, -3.1), (0.5, 0.5, 3.1), (6, 3))
    return arm(tuple(map(tuple, rows.tolist())), seed=seed)


CHAINS = {name: shipped(name) for name in NON_PIEPER}
CHAINS |= {f"generic{seed}": generic(seed) for seed in range(8)}
CHAINS |= {"manseur_doty": arm(tuple(row[1:] for row in ARMS["manseur_doty"]))}


def sweep(chain, m, seed):
    """Solve random poses; the generating configurations, the poses and what was found."""
    q = draw(chain, m, seed)
    Ts = forward(chain, q)
    return q, Ts, solve(chain, Ts)


def check_sweep(chain, m, seed):
    """All contracts at random poses, and that each has its own configuration."""
    q, Ts, found = sweep(chain, m, seed)
    solutions, owner = rows_of(found)
    error = np.abs(forward(chain, solutions) - Ts[owner]).max(axis=(1, 2))
    assert_margin(error, RESIDUAL * max(1.0, chain.size))
    assert_margin(found.residual[exists(found)], RESIDUAL)
    assert np.median(found.residual[exists(found)]) <= 1e-13
    assert_apart(distances(chain, found), GAP, quantile=0.999)
    least = np.full(m, np.inf)
    np.minimum.at(least, owner, regularity(chain, solutions))
    assert not (found.count[least > 1e-3] % 2).any()
    allowed = np.maximum(GAP, 1e-12 / np.maximum(regularity(chain, q), 1e-12))
    assert_margin(misses(chain, found, q), allowed, quantile=0.999)


@pytest.mark.parametrize("name", CHAINS)
def test_the_generating_configuration_is_found(name):
    """Of 500 random poses each has its own configuration among distinct, certified solutions."""
    family = "two parallel axes" if name in NON_PIEPER else "general 6R"
    assert select_solver(CHAINS[name]).name == family
    check_sweep(CHAINS[name], 500, seed=2)


def test_four_solutions_with_nearly_one_value_of_a_joint_are_told_apart():
    """Four of the hidden joint's roots within 3e-4 rad, too near for the polynomial: none lost."""
    chain = CHAINS["fanuc_crx10ia_l"]
    q = np.array([2.20656721, 1.33197935e-4, 2.44543299, -1.23653899, -2.68161678, 0.34605454])
    q = q + np.random.default_rng(0).uniform(-1e-4, 1e-4, (50, 6))
    found = solve(chain, forward(chain, q))
    assert (found.count == 8).all()
    assert_margin(misses(chain, found, q), GAP)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", CHAINS)
def test_the_generating_configuration_is_found_in_100_000_poses(name):
    """Of 100,000 random poses each has its own configuration among its solutions."""
    for seed in range(20):
        check_sweep(CHAINS[name], 5_000, seed)


@pytest.mark.parametrize("name", NON_PIEPER)
def test_solutions_are_verified_by_pinocchio(name):
    """Pinocchio places the tip at the target, 1e-9, for all solutions within the limits."""
    robot = dh2urdf.Robot.from_dh(name)
    q = np.random.default_rng(0).uniform(robot.lower, robot.upper, (200, 6))
    Ts = by_pinocchio(robot, q)
    found = robot.ik_batch(Ts)
    solutions, owner = rows_of(found)
    assert_margin(pose_errors(by_pinocchio(robot, solutions), Ts[owner]), RESIDUAL)
    assert ((solutions >= robot.lower) & (solutions <= robot.upper)).all()
    assert_margin(misses(robot.chain, found, q), GAP)


@pytest.mark.parametrize("name", ["fanuc_crx10ia", "kinova_jaco2", "generic0", "manseur_doty"])
def test_the_count_is_that_of_an_independent_search(name):
    """Damped Newton from 1,000 random starts finds the same solutions and no others."""
    chain = CHAINS[name]
    _, Ts, found = sweep(chain, 1, seed=5)
    for i, T in enumerate(Ts):
        others = search(chain, T, seed=i, starts=1000)
        assert len(others) == found.count[i]
        mine = found.of(i)[0]
        assert_margin(gaps(chain, others[:, None], mine[None]).min(axis=1), GAP)


def test_sixteen_solutions_are_found_whole():
    """The arm of Manseur and Doty has poses with 16 solutions, the most that a 6R arm can have."""
    _, _, found = sweep(CHAINS["manseur_doty"], 2000, seed=0)
    assert found.count.max() == 16


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_the_general_solver_equals_the_closed_form(name):
    """Every shipped arm with a closed form has the same solutions by elimination."""
    chain = shipped(name)
    assert_equal_to_closed_form(chain, General6R(chain), 200)


def assert_equal_to_closed_form(chain, solver, poses):
    """At every regular one of random poses the solver has the solutions of the closed form."""
    Ts = forward(chain, draw(chain, poses, seed=4))
    closed = solve(chain, Ts)
    general = solve(chain, Ts, solver=solver)
    worst = []
    for i in range(len(Ts)):
        q, p = closed.of(i)[0], general.of(i)[0]
        if regularity(chain, q).min() < 1e-3:
            continue
        assert len(q) == len(p)
        worst.append(gaps(chain, q[:, None], p[None]).min(axis=1).max())
    assert_margin(worst, GAP)
    assert np.median(worst) < 1e-13


@pytest.mark.parametrize("name", ["puma560", "lite6", "denso_vs060"])
@pytest.mark.parametrize("elimination", [(5, 0), (2, 1)])
def test_wrist_partners_with_one_value_of_the_hidden_joint_are_both_found(name, elimination):
    """One elimination whose roots are all double, joint 2 being hidden, loses no partner."""
    solver = General6R(shipped(name))
    plan = solver.plan.copy()
    plan["trials"], plan["choices"][0, 0], plan["ready"] = 1, elimination, 0
    forced = General6R(shipped(name))
    forced.plan = plan
    assert_equal_to_closed_form(shipped(name), forced, 300)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ["puma560", "lite6", "abb_irb120", "staubli_tx2_60", "ur5"])
def test_the_general_solver_equals_the_closed_form_at_20_000_poses(name):
    """No solution is lost, clusters of roots included."""
    assert_equal_to_closed_form(shipped(name), General6R(shipped(name)), 20_000)


def test_most_poses_are_compared():
    """The comparison with the closed forms leaves out few poses as singular."""
    kept = [
        (regularity(shipped(name), draw(shipped(name), 40, seed=4)) >= 1e-3).mean()
        for name in CLOSED_FORMS
    ]
    assert len(CLOSED_FORMS) >= 25
    assert min(kept) >= 0.85


@pytest.mark.parametrize("name", ["xarm6", "fanuc_crx10ia"])
def test_limits_drop_what_no_turn_brings_inside(name):
    """Solutions within the limits are those without limits that some full turn brings inside."""
    robot = dh2urdf.Robot.from_dh(name)
    rng = np.random.default_rng(3)
    for _ in range(40):
        T = robot.fk(robot.random_configuration(rng))
        inside, anywhere = robot.ik(T), robot.ik(T, within_limits=False)
        turns = 2 * math.pi * np.arange(-2, 3)
        values = anywhere.q[:, :, None] + turns
        fits = (values >= robot.lower[:, None]) & (values <= robot.upper[:, None])
        assert len(inside) == np.count_nonzero(fits.any(axis=2).all(axis=1))


def test_no_joint_of_a_regular_solution_is_free():
    """Random poses of a generic arm have isolated solutions only."""
    chain = CHAINS["generic1"]
    assert not sweep(chain, 100, seed=1)[2].free.any()


def test_the_solver_explains_itself():
    """The explanation names the method, and each better class with what kept it away."""
    solver = select_solver(CHAINS["generic0"])
    assert str(solver) == "general 6R"
    text = solver.explain()
    assert "Raghavan" in text
    before = [imported(where).name for where in SOLVERS]
    for name in before[: before.index("general 6R")]:
        assert f"not {name}: " in text


def test_other_tasks_are_not_for_this_solver():
    """For a position alone the general solver says that it is not meant."""
    obstacle = General6R.obstacle(CHAINS["generic0"], Task.POSITION)
    assert obstacle == "it solves for the full pose, not for position"


@pytest.mark.parametrize("name", ["kinova_jaco2", "xarm6"])
def test_branches_that_meet_are_one_solution(name):
    """At q = 0, where many branches meet, no two solutions are within 1e-3 rad of each other."""
    chain = shipped(name)
    found = solve(chain, forward(chain, np.zeros((1, 6)))).of(0)[0]
    apart = gaps(chain, found[:, None], found[None])
    apart[np.diag_indices(len(found))] = np.inf
    assert len(found) >= 1
    assert apart.min() > 1e-3
