"""Chains of one to five joints, any kinds and geometry, for the full pose."""

import itertools
import math

import ik_checks as checks
import ik_referee as referee
import numpy as np
import pytest
from dh_product import rows
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st
from ik_referee import GAP, RESIDUAL
from margins import assert_margin

from dh2urdf.chain import SerialChain
from dh2urdf.dh import JointType
from dh2urdf.ik.arm import Task, spare_joints
from dh2urdf.ik.arm.solver_order import select_solver
from dh2urdf.ik.families.short import ShortChain

HALF = math.pi / 2

ARMS = {
    "planar RRR": ("RRR", "0 1 0; 0 .7 0; 0 .3 0", 2),
    "spherical RRR": ("RRR", "0 0 h; 0 0 -h; .1 0 0", 2),
    "gantry": ("PPP", "0 0 h; 0 0 h; 0 0 .3", 1),
    "cylinder": ("RPP", ".4 0 0; 0 .1 h; .2 0 0", 1),
    "polar RRP": ("RRP", ".5 0 h; 0 0 h; .3 0 0", 2),
    "notes RPR": ("RPR", "0 3 -h; 2 0 h; 0 1.5 0", 1),
    "SCARA RRPR": ("RRPR", ".4 .4 0; 0 .3 pi; 0 0 0; .1 0 0", 2),
    "SCARA RRRP": ("RRRP", ".4 .4 0; 0 .3 0; .1 0 pi; 0 0 0", 2),
    "SCARA PRRR": ("PRRR", "0 0 0; .2 .4 0; 0 .3 0; 0 .1 0", 2),
    "SCARA RPRR": ("RPRR", ".3 .4 0; 0 0 0; .1 .3 0; 0 .1 0", 2),
    "SCARA RRP": ("RRP", ".4 .4 0; 0 .3 0; 0 .2 pi", 1),
    "palletizer RRRR": ("RRRR", ".3 0 h; 0 .4 0; 0 .3 0; 0 .1 h", 4),
    "gantry with a turn": ("PPPR", "0 0 h; 0 0 h; 0 0 0; .1 .2 0", 1),
    "gantry with a head": ("PPPRR", "0 0 h; 0 0 h; 0 0 0; .1 0 h; .2 0 0", 1),
    "five axes, elbow": ("RRRRR", ".3 .05 h; 0 .4 0; 0 .3 0; 0 0 h; .2 0 0", 4),
    "SCARA with a tilt": ("RRPRR", ".4 .4 0; 0 .3 pi; 0 0 0; .1 0 h; .2 0 0", 4),
    "welder PRRRR": ("PRRRR", "0 0 h; .3 .1 h; 0 .5 0; 0 .1 h; .2 0 0", 2),
    "gantry with an offset wrist": ("PPPRRR", "0 0 h; 0 0 h; 0 0 0; .1 .1 h; .2 .05 .9; .1 0 0", 2),
    "slides between turns": ("RPRPRP", ".1 0 h; 0 .1 .8; 0 .2 h; 0 .1 h; 0 .3 1; 0 0 0", 2),
}
"""Kinds, Denavit-Hartenberg steps (d, a, alpha), most solutions."""

SCARA = [name for name in ARMS if name.startswith("SCARA") and "tilt" not in name]


def named(name):
    kinds, steps, _ = ARMS[name]
    return referee.arm(rows(steps), kinds)


def chain_of(kinds, steps, lower=-math.inf, upper=math.inf):
    """A chain of steps (d, a, alpha) after a tool-like first and last link."""
    links = [np.eye(4)]
    for d, a, alpha in steps:
        c, s = math.cos(alpha), math.sin(alpha)
        links.append(np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1.0]]))
    links[0] = referee.random_pose(np.random.default_rng(1), 0.3)
    links[-1] = links[-1] @ referee.random_pose(np.random.default_rng(2), 0.3)
    n = len(kinds)
    types = tuple(JointType.PRISMATIC if k == "P" else JointType.REVOLUTE for k in kinds)
    bounds = np.full(n, lower), np.full(n, upper)
    return SerialChain(np.stack(links), types, tuple(f"j{i}" for i in range(n)), *bounds)


def holds(chain, T, found, q):
    """Whether q is among the solutions of pose 0, or so near that the pose cannot tell.

    At a multiple root a residual of 1e-9 leaves the joints open by a root of it; there the way
    from the solution to q must be flat.
    """
    solutions = found.of(0)[0]
    apart = referee.gaps(chain, solutions, q)
    for solution, gap in zip(solutions, apart, strict=True):
        if gap <= 1e-6:
            return True
        if gap < 0.05:
            step = q - solution
            turning = ~chain.prismatic
            step[turning] = (step[turning] + math.pi) % (2 * math.pi) - math.pi
            middle = solution + 0.5 * step
            if referee.residuals(chain, middle, T) <= 0.2 * gap**2:
                return True
    return False


LENGTHS = st.sampled_from([0.0, 0.0, 0.3, 0.7, -0.4, 1.0])
TWISTS = st.sampled_from([0.0, 0.0, HALF, -HALF, math.pi, 0.6, -1.1])
QUARTERS = st.sampled_from([0.0, HALF, -HALF])


@st.composite
def chains(draw, most=5):
    """Any kinds of joints on any axes; half of them with the axes of real arms."""
    n = draw(st.integers(1, most))
    kinds = "".join(draw(st.sampled_from("RRP")) for _ in range(n))
    if draw(st.booleans()):
        steps = [(draw(LENGTHS), draw(LENGTHS), draw(TWISTS)) for _ in range(n)]
    else:
        numbers = st.floats(-1.0, 1.0).map(lambda v: round(v, 3))
        steps = [(draw(numbers), draw(numbers), draw(numbers) * math.pi) for _ in range(n)]
    return chain_of(kinds, steps)


@given(chain=chains(), data=st.data())
@hypothesis_settings(max_examples=400)
def test_generating_configuration_is_found_for_any_chain(chain, data):
    """Of any chain of one to five joints, every configuration is found again, or its family."""
    values = st.one_of(QUARTERS, st.floats(-2.0, 2.0).map(lambda v: round(v, 3)))
    q = np.array([data.draw(values) for _ in range(chain.n)])
    T = referee.forward(chain, q)
    spare = spare_joints(chain, Task.POSE)
    if spare > 2:
        return
    found = referee.solve(chain, T[None])
    solutions, residual, _, free = found.of(0)
    assert len(solutions) > 0
    assert_margin(residual, RESIDUAL)
    assert_margin(referee.residuals(chain, solutions, T), RESIDUAL)
    if spare:
        assert (free != 0).all()
    elif not free.any():
        assert holds(chain, T, found, q)


@pytest.mark.parametrize("name", ARMS)
def test_named_arms_are_complete_and_certified(name):
    """200 poses an arm: all solutions at 1e-12, none twice, the generating one among them."""
    chain = named(name)
    q = referee.draw(chain, 200, 5)
    Ts = referee.forward(chain, q)
    found = referee.solve(chain, Ts)
    checks.check_all(chain, q, found, Ts)
    assert found.count.max() <= ARMS[name][2]


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ARMS)
def test_named_arms_on_many_poses(name):
    """The same on 100,000 poses an arm."""
    chain = named(name)
    q = referee.draw(chain, 100_000, 6)
    Ts = referee.forward(chain, q)
    checks.check_all(chain, q, referee.solve(chain, Ts), Ts)


@pytest.mark.parametrize("name", ARMS)
def test_count_equals_that_of_a_search(name):
    """Newton from 400 random starts finds no solution that is missing, on 3 poses an arm."""
    chain = named(name)
    for seed, q in enumerate(referee.draw(chain, 3, 7)):
        T = referee.forward(chain, q)
        solutions = referee.solve(chain, T[None]).of(0)[0]
        for other in referee.search(chain, T, seed, starts=200):
            assert_margin(referee.gaps(chain, solutions, other).min(), GAP)


@pytest.mark.parametrize("name", ARMS)
def test_infeasible_poses_give_nothing(name):
    """A pose that fewer than six joints cannot take, by 1e-6, has no solution."""
    chain = named(name)
    if chain.n == 6:
        pytest.skip("six joints take every pose near a regular one")
    rng = np.random.default_rng(8)
    for q in referee.draw(chain, 50, 8):
        T = referee.forward(chain, q)
        U = np.linalg.svd(referee.jacobians(chain, q))[0]
        twist = U[:, -1] * 1e-6 * rng.choice([-1, 1])
        x, y, z = twist[3:]
        T[:3, :3] = (np.eye(3) + np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])) @ T[:3, :3]
        T[:3, 3] += twist[:3]
        assert referee.solve(chain, T[None]).count[0] == 0


@pytest.mark.parametrize(
    ("name", "q", "free"),
    [("spherical RRR", (0.3, 0.0, 0.4), (0, 2)), ("five axes, elbow", None, (0, 4))],
)
def test_singular_families_are_named(name, q, free):
    """Where joints are free, one representative is returned and they are named."""
    chain = named(name)
    q = over_axis_1() if q is None else zeroed(name, q)
    T = referee.forward(chain, q)
    found = referee.solve(chain, T[None])
    solutions, residual, _, masks = found.of(0)
    assert_margin(residual, RESIDUAL, 1000)
    assert len(set(masks.tolist())) == 1
    for solution, mask in zip(solutions, masks, strict=True):
        assert tuple(i for i in range(chain.n) if mask >> i & 1) == free
        checks.check_family(chain, solution, T, int(mask))


def zeroed(name, q):
    """Joint values that make the middle joint of a random-zero arm singular."""
    chain = named(name)
    q = np.array(q)
    axes = chain.axes
    best = min(
        np.linspace(-math.pi, math.pi, 7201),
        key=lambda v: np.linalg.svd(
            referee.jacobians(chain, np.array([q[0], v, q[2]])), compute_uv=False
        )[-1],
    )
    assert axes.shape == (3, 3)
    step = 1e-3
    for _ in range(60):
        trial = best + np.array([-step, 0.0, step])
        sizes = [
            np.linalg.svd(referee.jacobians(chain, np.array([q[0], v, q[2]])), compute_uv=False)[-1]
            for v in trial
        ]
        best = trial[int(np.argmin(sizes))]
        step *= 0.7
    return np.array([q[0], best, q[2]])


def over_axis_1():
    """A configuration of the five-axis arm with its last axis on the first."""
    chain = named("five axes, elbow")
    q = np.array([0.4, 0.5, 0.7, 0.2, -0.3])

    def off(x):
        frames = referee.frames(chain, x)
        first, last = frames[0], frames[4]
        local = np.linalg.inv(first) @ last
        return np.array([local[0, 2], local[1, 2], local[0, 3], local[1, 3]])

    for start in itertools.product((-2.0, 0.0, 2.0), repeat=3):
        x = np.array([q[0], *start, q[4]])
        for _ in range(60):
            J = np.stack([(off(x + h) - off(x - h)) / 2e-6 for h in 1e-6 * np.eye(5)[1:4]], axis=1)
            x[1:4] -= np.clip(np.linalg.pinv(J) @ off(x), -0.3, 0.3)
        if np.abs(off(x)).max() < 1e-14:
            return x
    raise AssertionError("the arm reaches over its first axis")


@pytest.mark.parametrize("name", SCARA)
def test_a_slide_along_parallel_axes_leaves_a_planar_arm(name):
    """SCARA arms are planar arms with a slide: both elbows are found, and named."""
    chain = named(name)
    solver = select_solver(chain)
    assert solver.name == "planar arm"
    assert "a slide along them" in solver.explain()
    T = referee.forward(chain, referee.draw(chain, 1, 4)[0])
    _, _, elbows, _ = referee.solve(chain, T[None]).of(0)
    assert len(elbows) == ARMS[name][2]
    assert len({*elbows.tolist()} & {0, 2}) == len(elbows)
    assert select_solver(named("SCARA with a tilt")).name == "short chain"


@pytest.mark.parametrize("kinds", ["RRP", "RPR", "PRR"])
def test_two_turns_and_a_slide_reach_points(kinds):
    """Both elbows put the tool's origin at a point, and no search finds a third."""
    chain = chain_of(kinds, ((0.1, 0.4, 0), (0.2, 0.3, math.pi), (0.1, 0.2, 0)))
    solver = select_solver(chain, Task.POSITION)
    assert solver.name == "planar arm"
    for q in referee.draw(chain, 20, 6):
        T = referee.forward(chain, q)
        found = referee.solve(chain, T[None], solver=solver).of(0)[0]
        assert len(found) == 2
        assert_margin(referee.gaps(chain, found, q).min(), GAP)
        assert_margin(np.abs(referee.forward(chain, found)[:, :3, 3] - T[:3, 3]), RESIDUAL)


def test_scara_folded_names_joints_1_and_4():
    """Equal links, folded: the tool is on axis 1, and joints 1 and 4 turn against each other."""
    chain = chain_of("RRPR", ((0.4, 0.4, 0), (0, 0.4, 0), (0, 0, 0), (0.1, 0, 0)))
    T = referee.forward(chain, np.array([0.3, math.pi, 0.1, 0.5]))
    solutions, residual, _, free = referee.solve(chain, T[None]).of(0)
    assert len(solutions) == 1
    assert_margin(residual, RESIDUAL, 1000)
    assert free.tolist() == [0b1001]
    checks.check_family(chain, solutions[0], T, 0b1001)


@pytest.mark.parametrize("power", range(1, 13))
def test_a_straight_elbow_is_found_at_every_distance(power):
    """10^-1 ... 10^-12 rad from a straight elbow the configuration is found, and no third one."""
    chain, q, found = elbows(power)
    assert ((found.count == 1) | (found.count == 2)).all()
    assert_margin(found.residual[referee.exists(found)], RESIDUAL, 1000)
    # Of elbows nearer than GAP one stays, off by their distance and the root of its residual.
    assert_margin(referee.misses(chain, found, q), GAP, 10 if power <= 6 else 1)


@pytest.mark.parametrize("power", [4, 5, 5.5, 6, 6.5, 7, 9])
def test_elbows_are_told_apart_down_to_the_distance_at_which_two_are_one(power):
    """Elbows 1e-6 rad from straight and more are two; nearer ones are one by contract."""
    chain, q, found = elbows(power)
    assert_margin(referee.misses(chain, found, q), GAP, 10 if power <= 6 else 1)
    assert (found.count == (2 if power <= 6 else 1)).all()


def elbows(power):
    """A SCARA arm, 200 configurations 10^-power rad from a straight elbow, and their solutions."""
    chain, rng = named("SCARA RRPR"), np.random.default_rng(5)
    q = np.zeros((200, 4))
    q[:, [0, 2, 3]] = rng.uniform((-3, 0, -3), (3, 0.3, 3), (200, 3))
    q[:, 1] = straight(chain) + 10.0**-power * rng.uniform(0.95, 1.05, 200)
    return chain, q, referee.solve(chain, referee.forward(chain, q))


def straight(chain):
    """The elbow angle at which axes 1, 2 and 4 lie in one plane, whatever joint 1 is."""
    elbow = chain.links[0] @ chain.links[1]
    z, hand = elbow[:3, 2], elbow @ chain.links[2]
    out, arm = hand[:3, 3] - elbow[:3, 3], elbow[:3, 3] - chain.points[0]
    out, arm = out - z * (z @ out), arm - z * (z @ arm)
    return math.atan2(z @ np.cross(out, arm), out @ arm)


def test_coaxial_joints_are_held_and_named():
    """Two joints on one axis: one is held at rest, both are named as free."""
    chain = chain_of("RRR", ((0.2, 0, 0), (0, 0.5, HALF), (0, 0.3, 0)))
    q = np.array([0.3, 0.4, 0.5])
    T = referee.forward(chain, q)
    solver = select_solver(chain)
    assert solver.name == "joints to spare"
    solutions, residual, _, free = referee.solve(chain, T[None], solver=solver).of(0)
    assert_margin(residual, RESIDUAL, 1000)
    assert set(free.tolist()) == {0b011}
    assert (np.abs(solutions[:, 1]) < 1e-15).all()


def test_obstacles_say_what_is_in_the_way():
    """Each reason not to take a chain names what is wrong with it."""
    six = referee.shipped("ur5")
    assert "at most 5 joints" in ShortChain.obstacle(six)
    assert "position" in ShortChain.obstacle(named("gantry"), Task.POSITION)
    coaxial = chain_of("RR", ((0.2, 0, 0), (0.1, 0.3, 0)))
    assert "can move while the tool stays" in ShortChain.obstacle(coaxial)
    assert ShortChain.obstacle(named("gantry")) is None
    text = select_solver(named("five axes, elbow")).explain()
    assert "quartic" in text
    assert "not spherical wrist: it needs 6 joints" in text


def test_limits_drop_solutions_but_keep_families():
    """Outside the limits: dropped. A family is kept for whoever can slide it."""
    chain = named("SCARA RRPR")
    q = np.array([0.3, 0.8, 0.1, 0.5])
    T = referee.forward(chain, q)
    both = referee.solve(chain, T[None]).of(0)[0]
    assert len(both) == 2
    narrow = referee.with_limits(chain, q - 0.1, q + 0.1)
    kept = referee.solve(narrow, T[None], within_limits=True).of(0)[0]
    assert len(kept) == 1
    assert_margin(referee.gaps(chain, kept[0], q), 1e-9)


@pytest.mark.parametrize("name", ARMS)
def test_a_configuration_on_its_bounds_is_kept(name):
    """Rounding takes a joint over its bound by 1e-16; it is put on the bound, not dropped."""
    chain, away = named(name), []
    for q in referee.draw(chain, 20, 9):
        tight = referee.with_limits(chain, q, q + 0.5)
        T = referee.forward(chain, q)
        kept = referee.solve(tight, T[None], within_limits=True).of(0)[0]
        assert len(kept) >= 1
        assert (kept >= tight.lower).all()
        away.append(np.abs(kept - q).max(axis=1).min())
    assert_margin(away, GAP)
