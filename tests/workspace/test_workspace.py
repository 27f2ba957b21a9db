"""What an arm reaches, against the notes' annulus and against random forward kinematics."""

import math

import numpy as np
import pytest
from strategies import FACTORY

from dh2urdf import DHRow, DHTable, Robot
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.figures import workspace_figure
from dh2urdf.figures.workspaces import workspace
from dh2urdf.figures.workspaces.edges import regions
from dh2urdf.transforms import pose
from dh2urdf.workspace import (
    branch_counts,
    counts_at,
    dexterity,
    held_values,
    mapped_robot,
    orientations,
    planar_arm,
    reach_ball,
    section,
    shares_at,
    task_of,
    uniform_rotations,
)
from dh2urdf.workspace.refine import refined


def planar(*lengths, **limits):
    """A planar arm of so many links."""
    rows = tuple(DHRow(a=length, **limits) for length in lengths)
    return Robot.from_dh(DHTable(rows, "standard", "planar"))


def test_elbow_and_shoulder_invert_the_notes_equations():
    """Both elbow angles at a place lead back to it; out of the annulus there is none."""
    arm = planar_arm(planar(1.0, 0.7))
    rng = np.random.default_rng(0)
    r, t = rng.uniform(0.301, 1.699, 200), rng.uniform(-np.pi, np.pi, 200)
    x, y = r * np.cos(t), r * np.sin(t)
    for sign in (1.0, -1.0):
        bend = sign * arm.elbow(x, y)
        t1 = arm.shoulder(x, y, bend)
        np.testing.assert_allclose(np.cos(t1) + 0.7 * np.cos(t1 + bend), x, atol=1e-12)
        np.testing.assert_allclose(np.sin(t1) + 0.7 * np.sin(t1 + bend), y, atol=1e-12)
    assert np.isnan(arm.elbow(np.array([1.71, 0.29]), np.zeros(2))).all()


def test_planar_arm_agrees_with_the_robot():
    """A turned base, offsets and a turned tool are in the planar arm's angles."""
    rows = (DHRow(a=0.8, theta=0.4), DHRow(a=0.5, theta=-0.9))
    robot = Robot.from_dh(DHTable(rows, "standard", "turned"))
    arm = planar_arm(robot)
    q = np.array([0.3, -1.1])
    first, between, turn = arm.offset
    x, y = arm.forward(q[0] + first, q[1] + between)
    T = np.linalg.inv(arm.T_base_plane) @ robot.fk(q)
    np.testing.assert_allclose(T[:2, 3], [x, y], atol=1e-12)
    assert math.atan2(T[1, 0], T[0, 0]) == pytest.approx(q.sum() + turn)


@pytest.mark.parametrize("name", ["ur5e", "stanford", "omron_cobra600", "planar_rrr", "puma560"])
def test_reach_ball_holds_every_place(name):
    """No random configuration takes the tip out of the ball."""
    robot = Robot.from_dh(name)
    centre, radius = reach_ball(robot)
    rng = np.random.default_rng(1)
    places = robot.fk(np.stack([robot.random_configuration(rng) for _ in range(2000)]))[:, :3, 3]
    assert np.linalg.norm(places - centre, axis=1).max() <= radius + 1e-12


def test_rotations_are_spread_evenly():
    """Mean and second moments of the rotations are those of the uniform distribution."""
    R = uniform_rotations(2000)
    np.testing.assert_allclose(
        R @ R.transpose(0, 2, 1), np.tile(np.eye(3), (2000, 1, 1)), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(R), 1.0)
    assert np.abs(R.mean(axis=0)).max() < 0.01
    second = np.einsum("kij,klm->ijlm", R, R) / len(R)
    uniform = np.einsum("il,jm->ijlm", np.eye(3), np.eye(3)) / 3
    assert np.abs(second - uniform).max() < 0.01


def test_branches_of_a_planar_arm_fill_the_shifted_annulus():
    """With phi held, three links reach where two of them reach the wrist; two branches inside."""
    robot = planar(1.0, 0.7, 0.4, lower=-math.pi, upper=math.pi)
    grid = section(robot, count=41)
    counts = branch_counts(robot, grid, np.eye(3), within_limits=False)
    wrist = np.hypot(grid.points[..., 0] - 0.4, grid.points[..., 1])
    expected = 2 * ((wrist < 1.7) & (wrist > 0.3))
    clear = (np.abs(wrist - 1.7) > 1e-3) & (np.abs(wrist - 0.3) > 1e-3)
    assert grid.plane.name == "xy"
    np.testing.assert_array_equal(counts[clear], expected[clear])


def test_dexterity_of_a_planar_arm_is_the_share_of_wrists_in_reach():
    """The share of turns at a point is the share of the wrist's circle inside the annulus."""
    robot = planar(1.0, 0.7, 0.4, lower=-math.pi, upper=math.pi)
    grid = section(robot, count=9)
    share = dexterity(robot, grid, 60, within_limits=False)
    phi = np.linspace(-np.pi, np.pi, 60, endpoint=False)
    x, y = grid.points[..., 0, None], grid.points[..., 1, None]
    wrist = np.hypot(x - 0.4 * np.cos(phi), y - 0.4 * np.sin(phi))
    clear = (np.abs(wrist - 1.7) > 1e-6) & (np.abs(wrist - 0.3) > 1e-6)
    inside = (wrist < 1.7) & (wrist > 0.3)
    assert (np.abs(share - inside.mean(axis=-1)) <= (~clear).mean(axis=-1) + 1e-12).all()
    assert 0.0 < share.mean() < 1.0


def test_limits_shrink_the_section():
    """With limits kept, nothing is reached that was not reached without, and less of it."""
    robot = Robot.from_dh("puma560")
    grid = section(robot, count=31)
    down = np.diag([1.0, -1.0, -1.0])
    free = branch_counts(robot, grid, down, within_limits=False)
    kept = branch_counts(robot, grid, down)
    assert (kept <= free).all()
    assert kept.sum() < free.sum()


@pytest.mark.parametrize(
    ("name", "task"),
    [
        ("ur5e", ("pose", "rotations")),
        ("omron_cobra600", ("pose", "turns")),
        ("planar_rrr", ("pose", "turns")),
        ("xarm5", ("pose", "none")),
        ("cylindrical", ("position", "none")),
    ],
)
def test_task_fits_the_arm(name, task):
    """Each kind of arm is asked what its joints can do."""
    assert task_of(Robot.from_dh(name))[:2] == task


def test_pictures_are_drawn_with_their_sentence():
    """The sentence under each picture names slice, frames, limits and collisions."""
    for robot, options, start in (
        (planar(1.0, 0.7), {}, "Plane of motion of planar"),
        (Robot.from_dh("puma560"), {"points": 15, "orientations": 3}, "Slice y = 0 of puma560"),
        (Robot.from_dh("cylindrical"), {"points": 11, "at": 0.2}, "Slice y = 0.2 m of cylindrical"),
    ):
        picture = workspace_figure(robot, **options)
        (sentence,) = (t.get_text().replace("\n", " ") for t in picture.texts)
        assert sentence.startswith(start)
        assert sentence.endswith(
            "tool0 in base_link; joint limits kept; self-collision not checked."
        )


def test_limits_of_the_planar_arm_are_kept_on_every_turn():
    """Inside means: some whole number of turns brings the joint between its limits."""
    arm = planar_arm(planar(1.0, 0.7, lower=-2.0, upper=1.5))
    t = np.linspace(-7.0, 7.0, 1001)
    expected = np.zeros(t.shape, bool)
    for turns in range(-3, 4):
        q = t + 2 * math.pi * turns
        expected |= (q >= -2.0) & (q <= 1.5)
    np.testing.assert_array_equal(arm.inside(t, np.zeros_like(t)), expected)


def test_bad_plane_is_named():
    """A plane that is none raises with those there are."""
    with pytest.raises(ConfigurationError, match="'xz' or 'yz' or 'xy'"):
        workspace_figure(Robot.from_dh("ur5e"), plane="zz")


def test_seven_joints_are_mapped_with_the_spare_one_held():
    """A place counts from a side only where some held value has a solution, and most have one."""
    robot = Robot.from_dh("franka_fr3")
    held = held_values(robot)
    ((joint, values),) = held.items()
    assert np.all((robot.lower[joint] < values) & (values < robot.upper[joint]))
    grid = section(robot, count=9)
    share = dexterity(robot, grid, 12, held=held)
    turns = uniform_rotations(12)
    for v, u in ((4, 6), (6, 6), (0, 0)):
        hits = 0
        for R in turns:
            T = pose(R, grid.points[v, u])
            hits += any(len(robot.ik(T, locked={joint: float(x)})) > 0 for x in values)
        assert share[v, u] == pytest.approx(hits / 12)
    assert share.max() > 0.5
    assert held_values(Robot.from_dh("ur5e")) is None


@pytest.mark.parametrize("name", ["puma560", "ur5e"])
def test_maps_filled_in_between_are_those_of_every_point(name):
    """Counts differ at almost no point from those worked out there, shares by little."""
    robot = Robot.from_dh(name)
    grid, down = section(robot, count=81), np.diag([1.0, -1.0, -1.0])
    every = counts_at(robot, grid.points.reshape(-1, 3), down).reshape(81, 81)
    counts = branch_counts(robot, grid, down)
    assert (counts != every).mean() < 1e-3
    share = dexterity(robot, grid, 2000)
    spots = np.random.default_rng(0).integers(0, 81, (2, 300))
    turns = orientations(robot, task_of(robot), 2000)
    exact = shares_at(robot, grid.points[tuple(spots)], turns)
    off = np.abs(share[tuple(spots)] - exact)
    assert off.mean() < 0.01
    assert np.quantile(off, 0.99) < 0.04


def test_only_points_where_the_map_changes_are_worked_out():
    """A disc on a fine grid costs a small part of its points, and comes out right at each."""
    asked = []

    def disc(rows, columns, _):
        asked.append(len(rows))
        return 3.0 * (np.hypot(rows - 200.0, columns - 210.0) < 120.0)

    found = refined(disc, (401, 401))
    assert sum(asked) < 0.13 * 401**2
    rows, columns = np.indices((401, 401))
    np.testing.assert_array_equal(found, disc(rows, columns, None))


def test_edges_of_a_planar_arm_are_those_of_the_annulus():
    """Every point of the edge lies on one of the two rims, to a ten-thousandth of the reach."""
    robot = planar(1.0, 0.7, lower=-math.pi, upper=math.pi)
    grid = section(robot, "xy", 0.0, 61)
    counts = branch_counts(robot, grid, np.eye(3), within_limits=False)

    def at(spots):
        return counts_at(robot, grid.at_places(spots), np.eye(3), within_limits=False)

    ((outer, inner),) = regions(grid.u, grid.v, counts, at, 8)[2]
    for ring, radius in ((outer, 1.7), (inner, 0.3)):
        np.testing.assert_allclose(np.hypot(*ring.T), radius, atol=1.7e-4)


def test_one_orientation_a_direction_stands_for_all_its_turns():
    """Where the last joint turns all around, shares are those of uniform rotations."""
    robot = Robot.from_dh("ur5e")
    few = orientations(robot, task_of(robot), 2000)
    assert len(few) < 200
    grid = np.random.default_rng(3).uniform(-0.9, 0.9, (40, 3))
    np.testing.assert_allclose(
        shares_at(robot, grid, few), shares_at(robot, grid, uniform_rotations(2000)), atol=0.03
    )
    assert len(orientations(Robot.from_dh("stanford"), task_of(robot), 2000)) == 2000


def test_both_maps_follow_the_points_asked_for(monkeypatch):
    """Points along a side are those of both maps; without them, 2000 orientations at least."""
    drawn = []
    monkeypatch.setattr(workspace, "section_picture", lambda *args, **_: drawn.append(args))
    robot = Robot.from_dh("ur5e")
    workspace.workspace_figure(robot, points=23, orientations=40)
    workspace.workspace_figure(robot)
    (_, counts, shares, _), (_, fine, full, _) = drawn
    assert len(counts.grid.u) == len(shares.grid.u) == 23
    assert shares.tried >= 40
    assert len(fine.grid.u) == len(full.grid.u) > 150
    assert full.tried >= 2000


def test_a_calibrated_arm_is_mapped_on_its_nominal_one():
    """It has a closed form, is near the arm asked for, and the caption says how near."""
    robot = Robot.from_dh(FACTORY)
    nominal, off = mapped_robot(robot)
    rng = np.random.default_rng(2)
    Q = rng.uniform(-3.0, 3.0, (200, 6))
    gap = np.linalg.norm(nominal.fk(Q)[:, :3, 3] - robot.fk(Q)[:, :3, 3], axis=1).max()
    assert 0.0 < gap < 2.0 * off < 0.004 * robot.chain.size
    assert nominal.solver.kmax == 8
    places = rng.uniform(-0.5, 0.5, (20, 3))
    turns = orientations(robot, task_of(robot), 60)
    near = shares_at(nominal, places, turns) - shares_at(robot, places, turns)
    assert np.abs(near).max() < 0.1
    picture = workspace.workspace_figure(robot, points=15, orientations=10)
    assert f"nominal arm, up to {1000 * off:.2g} mm off" in picture.texts[0].get_text()
    ordinary = Robot.from_dh("ur5e")
    assert mapped_robot(ordinary) == (ordinary, 0.0)
