"""Arms whose last or first three axes meet: complete, certified, exact at the edges."""

import math

import ik_checks as checks
import ik_referee as ref
import numpy as np
import pinocchio as pin
import pytest
from ik_referee import HALF, RESIDUAL
from margins import assert_margin

import dh2urdf
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.spherical_wrist import SphericalWrist

NAMES = """
abb_irb120 abb_irb140 abb_irb140_modified cylindrical_wrist denso_vs060 denso_vs6556 doosan_m1013
fanuc_lrmate200id gantry_wrist kinova_jaco2_spherical kuka_kr16_2 kuka_kr5_arc kuka_kr6_r700 lite6
mecademic_meca500 puma560 puma560_modified stanford stanford_modified staubli_tx2_60 uf850
yaskawa_gp7
"""
SHIPPED = NAMES.split()

WRIST = ((0.4, 0.0, HALF), (0.0, 0.0, -HALF), (0.0, 0.0, 0.0))
SKEW = ((0.4, 0.0, 1.0), (0.0, 0.0, -0.6), (0.0, 0.0, 0.0))
ELBOWS = {
    "nothing special": ((0.3, 0.2, 1.0), (0.1, 0.4, 0.7), (0.1, 0.3, -1.2)),
    "1 meets 2": ((0.3, 0.0, 1.0), (0.1, 0.4, 0.7), (0.1, 0.3, -1.2)),
    "1 parallel to 2": ((0.3, 0.3, 0.0), (0.1, 0.4, 0.7), (0.1, 0.3, -1.2)),
    "2 meets 3": ((0.3, 0.3, 1.0), (0.1, 0.0, 0.7), (0.1, 0.3, -1.2)),
    "2 parallel to 3": ((0.3, 0.1, 1.0), (0.1, 0.5, 0.0), (0.1, 0.3, -1.2)),
    "2 antiparallel to 3": ((0.3, 0.1, 1.0), (0.1, 0.5, math.pi), (0.1, 0.3, -1.2)),
    "1 meets 2 parallel to 3": ((0.3, 0.0, HALF), (0.1, 0.5, 0.0), (0.0, 0.1, HALF)),
    "1 meets 2 meets 3": ((0.3, 0.0, 1.0), (0.4, 0.0, 0.7), (0.1, 0.3, -1.2)),
}
SLIDES = {
    "oblique": ((0.3, 0.2, 1.0), (0.1, 0.25, 0.7), (0.1, 0.3, -1.2)),
    "square": ((0.3, 0.2, HALF), (0.1, 0.25, -HALF), (0.1, 0.3, HALF)),
    "first square": ((0.4, 0.1, -HALF), (0.15, 0.2, 0.8), (0.1, 0.0, 0.3)),
    "second square": ((0.4, 0.1, -0.8), (0.15, 0.2, HALF), (0.1, 0.0, 0.3)),
}
KINDS = ["RRP", "RPR", "PRR", "RPP", "PRP", "PPR", "PPP"]


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_arms_are_complete_and_certified(name):
    """Every shipped arm with a spherical wrist gets this solver and finds what made the pose."""
    chain = ref.shipped(name)
    assert str(select_solver(chain)) == "spherical wrist"
    checks.check_random_poses(chain, 2000)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_arms_on_a_hundred_thousand_poses(name):
    """The same on 100,000 poses, ten seeds."""
    for seed in range(10):
        checks.check_random_poses(ref.shipped(name), 10_000, seed)


@pytest.mark.parametrize("wrist", [WRIST, SKEW], ids=["orthogonal", "skew"])
@pytest.mark.parametrize("elbow", ELBOWS)
def test_turning_position_arms(elbow, wrist):
    """Each special geometry of the first three axes, and none, is complete with either wrist."""
    chain = ref.arm(ELBOWS[elbow] + wrist, seed=3)
    assert str(select_solver(chain)) == "spherical wrist"
    checks.check_random_poses(chain, 400)


@pytest.mark.parametrize("geometry", SLIDES)
@pytest.mark.parametrize("kinds", KINDS)
def test_sliding_position_arms(kinds, geometry):
    """Each mix of turning and sliding joints before a wrist is complete."""
    chain = ref.arm(SLIDES[geometry] + WRIST, kinds + "RRR", seed=4)
    if (kinds, geometry) == ("PRP", "square"):
        assert "cannot move the wrist centre" in SphericalWrist.obstacle(chain)
        return
    assert str(select_solver(chain)) == "spherical wrist"
    checks.check_random_poses(chain, 200)


def test_spherical_shoulder():
    """The mirrored arms are complete, with the residual measured at the tool."""
    for rows in (
        ((0, 0, 1.0), (0, 0, -1.2), (0.4, 0.1, 0.5), (0.1, 0.5, 0.7), (0.1, 0.3, -0.8), (0, 0, 0)),
        ((0, 0, HALF), (0, 0, -HALF), (0.4, 0.1, 0.5), (0.1, 0.5, 0), (0.1, 0.3, -0.8), (0, 0, 0)),
    ):
        chain = ref.arm(rows, seed=5)
        assert str(select_solver(chain)) == "spherical shoulder"
        checks.check_random_poses(chain, 400)


@pytest.mark.parametrize("name", ["puma560", "kinova_jaco2_spherical", "stanford"])
def test_no_solution_that_a_search_finds_is_missing(name):
    """A search from 400 starts finds nothing that the closed form does not."""
    checks.check_against_search(ref.shipped(name), 4)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SHIPPED)
def test_count_equals_that_of_a_search(name):
    """The same over 200 poses of every shipped arm."""
    checks.check_against_search(ref.shipped(name), 200)


@pytest.mark.parametrize("geometry", ["denso_vs6556", "stanford", "square", "second square"])
def test_block_and_scalar_kernels_agree(geometry):
    """The vectorised kernel returns the same solutions and branches as the scalar one."""
    from dh2urdf.kernels.spherical_wrist.common import solve_common_wrist
    from dh2urdf.kernels.spherical_wrist.poses import solve_wrist_arm

    slides = SLIDES.get(geometry)
    chain = ref.arm(slides + WRIST, "RRPRRR", seed=4) if slides else ref.shipped(geometry)
    solver = SphericalWrist(chain)
    assert solver.kernel is solve_common_wrist
    checks.check_kernels_agree(chain, solver, solve_wrist_arm, 1e-9)


def test_solutions_reach_the_pose_in_pinocchio():
    """Pinocchio, from the written URDF, puts the tool where it should be, tool included."""
    robot = dh2urdf.Robot.from_dh("fanuc_lrmate200id")
    Ts = robot.fk(np.random.default_rng(9).uniform(-3, 3, (200, 6)))
    solutions, owner = ref.rows_of(robot.ik_batch(Ts, within_limits=False))
    frame, data = robot.model.getFrameId(robot.tip), robot.model.createData()
    placed = np.empty((len(solutions), 4, 4))
    for q, T in zip(solutions, placed, strict=True):
        pin.framesForwardKinematics(robot.model, data, q)
        T[:] = data.oMf[frame].homogeneous
    assert_margin(np.abs(placed - Ts[owner]), 1e-12)


def test_all_solutions_within_limits_are_kept():
    """With limits, exactly those solutions are left that some turn brings inside."""
    chain = ref.shipped("puma560")
    Ts = ref.forward(chain, ref.draw(chain, 300, 10))
    everything, inside = ref.solve(chain, Ts), ref.solve(chain, Ts, True)
    for i in range(len(Ts)):
        turned = [
            q
            for q in everything.of(i)[0]
            if all(
                any(lo <= v + 2 * math.pi * k <= up for k in (-1, 0, 1))
                for v, lo, up in zip(q, chain.lower, chain.upper, strict=True)
            )
        ]
        kept = inside.of(i)[0]
        assert len(kept) == len(turned)
        assert np.all((chain.lower <= kept) & (kept <= chain.upper))


def straight(chain):
    """Value of joint 3 at which the arm is stretched."""
    rows = SphericalWrist(chain).form.rows
    lean = math.atan2(-rows[2, 2] * rows[3, 3], rows[2, 0])
    return rows[2, 6] * (-lean - rows[2, 4])


def test_puma_stretched_has_the_merged_elbow_once():
    """A stretched Puma has four solutions, the two elbows being one, to rounding."""
    chain = ref.shipped("puma560")
    T = ref.forward(chain, np.array([0.3, -1.0, straight(chain), 0.4, 0.5, 0.6]))
    q, free = checks.solved(chain, T)
    assert len(q) == 4
    assert not free.any()


@pytest.mark.parametrize("beyond", [1e-12, 1e-10, 5e-10])
def test_on_the_rim_the_merged_branch_is_returned_once(beyond):
    """A wrist centre up to 1e-9 beyond the rim has the merged elbow once for each wrist."""
    chain = ref.arm(ELBOWS["1 meets 2 parallel to 3"] + WRIST)
    T = stretched_poses(chain, 200)
    T[:, :3, 3] += beyond * outward(chain, T)
    inner = ref.solve(chain, T)
    assert (inner.count == 4).all()
    # The tool stays outside by what it was put there: the residual is ``beyond`` and rounding.
    assert_margin(inner.residual[ref.exists(inner)] - beyond, 1e-14, 1)


def stretched_poses(chain, m):
    """Poses (m, 4, 4) of a stretched arm, wrist and shoulder away from their singularities."""
    q = np.random.default_rng(15).uniform(0.3, 1.3, (m, 6)) * [1, -1, 0, 1, 1, 1]
    q[:, 2] = straight(chain)
    return ref.forward(chain, q)


def outward(chain, T):
    """Directions (m, 3) from the shoulder to the wrist centre of poses, in base."""
    form = SphericalWrist(chain).form
    centre = (T @ np.linalg.inv(form.tool))[:, :3, 3]
    away = centre - form.frames[1][:3, 3]
    return away / np.linalg.norm(away, axis=1, keepdims=True)


def test_beyond_the_rim_there_is_nothing():
    """1e-8 beyond the rim no solution is returned, 1e-8 inside eight are."""
    chain = ref.arm(((0.3, 0.0, HALF), (0.0, 0.5, 0.0), (0.0, 0.1, HALF), *WRIST))
    T = stretched_poses(chain, 200)
    away = outward(chain, T)
    for step, expected in ((1e-8, 0), (-1e-8, 8), (1e-3, 0), (-1e-3, 8)):
        moved = T.copy()
        moved[:, :3, 3] += step * away
        assert (ref.solve(chain, moved).count == expected).all()


@pytest.mark.parametrize(
    ("name", "joint"),
    [
        ("puma560", 3),
        ("kinova_jaco2_spherical", 3),
        ("denso_vs6556", 3),
        ("puma560", 5),
        ("kinova_jaco2_spherical", 5),
        ("stanford", 5),
    ],
)
def test_every_distance_from_a_singularity(name, joint):
    """Poses 1e-1 to 1e-12 from a straight elbow or wrist keep the generating configuration."""
    chain = ref.shipped(name)
    edge = straight(chain) if joint == 3 else special_wrist(chain)
    rng = np.random.default_rng(11)
    checks.check_distances_from_a_singularity(chain, joint - 1, edge, rng)


def special_wrist(chain):
    """Value of joint 5 at which axes 4 and 6 are in line, or the wrist is stretched."""
    rows = SphericalWrist(chain).form.rows
    return -rows[4, 6] * rows[4, 4]


@pytest.mark.parametrize("name", ["puma560", "abb_irb120", "stanford", "gantry_wrist"])
def test_a_wrist_in_line_names_joints_4_and_6(name):
    """At q5 = 0 one representative with joints 4 and 6 free stands for the family."""
    chain = ref.shipped(name)
    q = np.array([0.3, -0.5, 0.2, 0.4, special_wrist(chain), 0.6])
    T = ref.forward(chain, q)
    solutions, free = checks.solved(chain, T)
    of_family = np.flatnonzero(free == 0b101000)
    near = [k for k in of_family if ref.gaps(chain, np.r_[solutions[k, :3], q[3:]], q) < 1e-6]
    assert len(near) == 1
    checks.check_family(chain, solutions[near[0]], T, 0b101000)


def test_wrist_centre_on_axis_1_names_joint_1():
    """Over the shoulder joint 1 and the wrist are free: two families an elbow, all of them real."""
    chain = ref.shipped("abb_irb120")
    form = SphericalWrist(chain).form
    rng = np.random.default_rng(12)
    for _ in range(5):
        D = ref.random_pose(rng, 0.0)
        D[:3, 3] = 0.0, 0.0, rng.uniform(0.2, 0.4)
        T = form.frames[0] @ D @ form.tool
        solutions, free = checks.solved(chain, T)
        assert len(solutions) == 4
        assert set(free.tolist()) == {0b111001}
        for q in solutions:
            checks.check_family(chain, q, T, 0b111001)


def test_wrist_centre_on_axis_2_names_joint_2():
    """Folded back onto axis 2, joint 2 and the wrist are free; the other shoulder is not."""
    chain = ref.arm(((0.3, 0.1, HALF), (0.0, 0.4, 0.0), (0.0, 0.0, HALF), *WRIST))
    rows = SphericalWrist(chain).form.rows
    q = np.array([-1.7, 1.3, 0.0, -1.0, 1.5, -1.8])
    q[2] = straight(chain) + rows[2, 6] * math.pi
    T = ref.forward(chain, q)
    solutions, free = checks.solved(chain, T)
    assert sorted(free.tolist()) == [0, 0, 0, 0, 0b111010, 0b111010]
    for solution, mask in zip(solutions, free, strict=True):
        if mask:
            checks.check_family(chain, solution, T, mask)


@pytest.mark.parametrize("power", range(2, 10))
def test_near_axis_1_both_shoulders_are_found(power):
    """A wrist centre 1e-2 to 1e-9 off axis 1 still has all eight solutions."""
    chain = ref.shipped("abb_irb120")
    form = SphericalWrist(chain).form
    rng = np.random.default_rng(13)
    D = np.array([ref.random_pose(rng, 0.0) for _ in range(200)])
    D[:, :3, 3] = 0.6 * 10.0**-power, -0.8 * 10.0**-power, 0.3
    found = ref.solve(chain, form.frames[0] @ D @ form.tool)
    assert (found.count == 8).all()
    assert_margin(found.residual[ref.exists(found)], RESIDUAL, 1000)
    assert not found.free[ref.exists(found)].any()


def test_six_digit_poses_are_solved():
    """A rotation typed with six digits is reached up to its own error, on every branch."""
    chain = ref.shipped("puma560")
    q = ref.draw(chain, 400, 14)
    Ts = np.round(ref.forward(chain, q), 6)
    Ts[:, 3] = 0, 0, 0, 1
    found = ref.solve(chain, Ts)
    solutions, owner = ref.rows_of(found)
    assert (found.count == 8).mean() > 0.9
    assert_margin(ref.residuals(chain, solutions, Ts[owner]), RESIDUAL)


def test_obstacles_say_what_is_in_the_way():
    """An arm without a spherical wrist is told so, by joints that can be checked."""
    assert "has 5" in SphericalWrist.obstacle(ref.arm(ELBOWS["2 meets 3"] + WRIST[:2], "RRRRR"))
    assert "do not meet" in SphericalWrist.obstacle(ref.shipped("ur5"))
    planar = ((0.1, 0.4, 0.0), (0.1, 0.4, 0.0), (0.0, 0.3, 0.0), *WRIST)
    assert "cannot move the wrist centre" in SphericalWrist.obstacle(ref.arm(planar))
    assert "2 || 3" in select_solver(ref.shipped("puma560")).explain()
