"""Arms with three neighbouring parallel axes: complete, certified, exact at the edges."""

import math

import ik_checks as checks
import ik_referee as ref
import numpy as np
import pytest
from dh_product import rows
from ik_referee import GAP, HALF, RESIDUAL
from margins import assert_margin

from dh2urdf.ik.arm import Task
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.closed_form import ThreeParallel

DEG = math.pi / 180
SHIPPED = ["techman_tm5_700", "unitree_z1", "ur10", "ur10e", "ur16e", "ur20", "ur3", "ur30"]
SHIPPED += ["ur3e", "ur5", "ur5e"]
BEHIND_1 = ((0.3, 0.1, 1.0), (0.1, 0.5, 0.0), (0.1, 0.3, 0.0))
PLANE = ((0.1, 0.5, 0.0), (0.1, 0.3, 0.0))
LAST = (0.0, 0.0, 0.0)
SYNTHETIC = {
    "2, 3, 4": (*BEHIND_1, (0.1, 0.1, HALF), (0.2, 0.15, -1.0), LAST),
    "2, 3, 4; 5 parallel to 6": (*BEHIND_1, (0.1, 0.1, 1.2), (0.2, 0.15, 0.0), LAST),
    "2, 3, 4; 5 meets 6": (*BEHIND_1, (0.1, 0.1, 1.2), (0.2, 0.0, 1.1), LAST),
    "2, 3, 4 one against the others": rows(
        ".3 .1 1; .1 .5 pi; .1 .3 pi; .1 .1 1.2; .2 0 1.1; 0 0 0"
    ),
    "1, 2, 3": (*PLANE, (0.1, 0.1, HALF), (0.2, 0.15, -1.0), (0.1, 0.2, 0.8), LAST),
    "1, 2, 3; 5 meets 6": (*PLANE, (0.1, 0.1, HALF), (0.2, 0.15, -1.0), (0.1, 0.0, 0.8), LAST),
    "1, 2, 3; 4 meets 5": (*PLANE, (0.1, 0.1, HALF), (0.2, 0.0, -1.0), (0.1, 0.2, 0.8), LAST),
    "1, 2, 3; 5 parallel to 6": (*PLANE, (0.1, 0.1, HALF), (0.2, 0.1, -1.0), (0.1, 0.2, 0), LAST),
    "3, 4, 5": ((0.1, 0.2, 1.0), (0.3, 0.1, 1.0), *PLANE, (0.1, 0.1, HALF), LAST),
    "4, 5, 6": ((0.1, 0.2, 1.0), (0.3, 0.1, 1.0), (0.1, 0.1, 0.5), *PLANE, LAST),
}


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_arms_are_complete_and_certified(name):
    """Every shipped arm with axes 2, 3, 4 parallel finds what made the pose."""
    chain = ref.shipped(name)
    assert str(select_solver(chain)) == "three parallel axes"
    checks.check_random_poses(chain, 2000)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_arms_on_a_hundred_thousand_poses(name):
    """The same on 100,000 poses, ten seeds."""
    for seed in range(10):
        checks.check_random_poses(ref.shipped(name), 10_000, seed)


@pytest.mark.parametrize("name", SYNTHETIC)
def test_three_parallel_axes_anywhere(name):
    """The three may be anywhere in the chain, with and without neighbours that meet."""
    chain = ref.arm(SYNTHETIC[name], seed=2)
    assert "three parallel axes" in str(select_solver(chain))
    checks.check_random_poses(chain, 400)


def test_no_solution_that_a_search_finds_is_missing():
    """A search from 400 starts finds nothing that the closed form does not."""
    checks.check_against_search(ref.shipped("ur5"), 4)
    checks.check_against_search(ref.arm(SYNTHETIC["1, 2, 3"], seed=2), 3)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_count_equals_that_of_a_search(name):
    """The same over 200 poses of every shipped arm."""
    checks.check_against_search(ref.shipped(name), 200)


def test_block_and_scalar_kernels_agree():
    """The vectorised kernel returns the same solutions and branches as the scalar one."""
    from dh2urdf.kernels.parallel_axes.blocks import solve_common_parallel
    from dh2urdf.kernels.parallel_axes.poses import solve_three_parallel

    chain = ref.with_limits(ref.shipped("ur5"), -2.5, 3.0)
    solver = ThreeParallel(chain)
    assert solver.kernel is solve_common_parallel
    checks.check_kernels_agree(chain, solver, solve_three_parallel, 1e-8)


def test_ur5_home_has_its_solution():
    """Stretched up with the wrist in line, the UR5 is found at its home to rounding, and alone."""
    chain = ref.shipped("ur5")
    home = np.array([0, -90, 0, -90, 0, 0]) * DEG
    T = ref.forward(chain, home)
    q, free = checks.solved(chain, T)
    assert_margin(ref.gaps(chain, q, home).min(), GAP)
    assert free[ref.gaps(chain, q, home).argmin()] == 0


def test_ur5_with_a_straight_elbow_has_it_once():
    """At q3 = 0 the two elbows are one solution, and the other branches are all there."""
    chain = ref.shipped("ur5")
    q = np.array([0.3, -1.0, 0.0, 0.4, 0.5, 0.6])
    T = ref.forward(chain, q)
    solutions, _ = checks.solved(chain, T)
    assert (ref.gaps(chain, solutions, q) < 0.1 * GAP).sum() == 1
    for other in ref.search(chain, T, 3, starts=1500):
        assert_margin(ref.gaps(chain, solutions, other).min(), 1e-4)


def test_ur5_wrist_in_line_names_the_free_joints():
    """At q5 = 0 joints 2, 3, 4 and 6 move along a family, and the other branches are isolated."""
    chain = ref.shipped("ur5")
    rng = np.random.default_rng(4)
    for _ in range(10):
        q = rng.uniform(-2, 2, 6)
        q[4] = 0.0
        T = ref.forward(chain, q)
        solutions, free = checks.solved(chain, T)
        here = np.abs(np.sin((solutions[:, [0, 4]] - q[[0, 4]]) / 2)).max(axis=1) < 1e-7
        assert here.any()
        for k in range(len(solutions)):
            assert free[k] == (0b101110 if here[k] else 0)
            if here[k] and abs(math.sin(solutions[k, 2])) > 1e-3:
                checks.check_family(chain, solutions[k], T, 0b101110)


def test_over_axis_1_every_joint_is_free():
    """Without a lateral offset, a pose whose wrist is over axis 1 has families of all joints."""
    rows = ((0.3, 0, HALF), (0, 0.5, 0), (0, 0.4, 0), (0, 0, HALF), (0.1, 0, -HALF), LAST)
    chain = ref.arm(rows)
    form = ThreeParallel(chain).form
    rng = np.random.default_rng(0)
    for height in (0.3, 0.5, 0.7):
        D = ref.random_pose(rng, 0.0)
        D[:3, 3] = 0.0, 0.0, height
        T = form.frames[0] @ D @ form.tool
        solutions, free = checks.solved(chain, T)
        assert len(solutions) == 4
        for q, mask in zip(solutions, free, strict=True):
            assert mask == 0b111111
            checks.check_family(chain, q, T, mask)


@pytest.mark.parametrize("joint", [3, 5])
@pytest.mark.parametrize("name", ["ur5", "unitree_z1"])
def test_every_distance_from_a_singularity(name, joint):
    """Poses 1e-1 to 1e-12 from a straight elbow or wrist keep the generating configuration."""
    chain = ref.shipped(name)
    rows = ThreeParallel(chain).form.rows
    edge = -rows[joint - 1, 6] * rows[joint - 1, 4]
    rng = np.random.default_rng(11)
    checks.check_distances_from_a_singularity(chain, joint - 1, edge, rng)


def test_beyond_the_rims_there_is_nothing():
    """1e-6 beyond the outer rim of the planar arm no solution is left; 1e-10 beyond, one."""
    chain = ref.shipped("ur5")
    form = ThreeParallel(chain).form
    q = np.array([0.3, -1.0, 0.0, 0.4, 0.5, 0.6])
    T = ref.forward(chain, q)
    frames = ref.frames(chain, q)
    shoulder, wrist = frames[1][:3, 3], frames[4][:3, 3]
    axis = frames[1][:3, 2]
    away = wrist - shoulder
    away -= axis * (axis @ away)
    away /= np.linalg.norm(away)
    assert form.exact
    for step, expected in ((1e-10, 1), (1e-6, 0), (-1e-6, 2)):
        moved = T.copy()
        moved[:3, 3] += step * away
        found, residual, _, _ = ref.solve(chain, moved[None]).of(0)
        near = np.abs(np.sin((found[:, [0, 4, 5]] - q[[0, 4, 5]]) / 2)).max(axis=1) < 1e-3
        assert near.sum() == expected
        assert_margin(residual, RESIDUAL, 5)  # what is 1e-10 beyond stays off by that


def test_obstacles_say_what_is_in_the_way():
    """What is not of this family is told so, and the explanation names the axes."""
    assert "no three" in ThreeParallel.obstacle(ref.shipped("puma560"))
    assert "6 revolute" in ThreeParallel.obstacle(ref.shipped("stanford"))
    assert "position" in ThreeParallel.obstacle(ref.shipped("ur5"), Task.POSITION)
    assert "axes 2, 3, 4 are parallel" in select_solver(ref.shipped("ur5")).explain()
