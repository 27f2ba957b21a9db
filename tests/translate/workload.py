"""What robots are asked so that every kernel works: the same questions, bit for bit, everywhere.

Configurations are products of whole numbers and powers of two with a quarter turn, poses are what
the kernels' own forward kinematics make of them: no library's sine takes part.
"""

from collections.abc import Iterator
from dataclasses import replace
from random import Random

import numpy as np

import dh2urdf
from dh2urdf.dh import DHRow, DHTable, JointType, Mimic
from dh2urdf.exceptions import ConfigurationError, NoSolverError
from dh2urdf.workspace.reach.measured import measure

QUARTER = 1.5707963267948966

NOISE = {"ur5": 2.0**-30, "puma560": 2.0**-20, "ur10e": 2.0**-14, "abb_irb120": 2.0**-12}
"""Arms that are calibrated, and how far they are off their tables [rad or m]."""

OWN = {
    "three parallel": ("RRRRRR", "0 .4 0; 0 .3 0; .1 0 1; .1 .05 1; .1 0 1; .1 0 0"),
    "rounded ur": (
        "RRRRRR",
        ".1625 0 1.000002; 0 -.425 0; 0 -.3922 0; .1333 0 1.000002; .0997 0 -1.000002; .0996 0 0",
    ),
    "rounded wrist": (
        "RRRRRR",
        ".3 .05 -1.000002; 0 .4 0; 0 .03 -1.000002; .4 0 1.000002; 0 0 -1.000002; .1 0 0",
    ),
    "square of five": ("RRRRR", "0 .1 2; 0 .5 0; 0 .1 1; 0 .2 1; .2 0 0"),
    "four in a plane": ("RRRR", "0 .3 0; 0 .2 0; 0 .25 0; 0 .1 0"),
    "geared": ("RRRRRRR", ".3 .3 1; .1 .2 1; 0 .2 1; .2 0 1; .2 .1 1; .1 .2 1; .1 0 0", 3, 4, 2.0),
    "three slides": ("RPRPRP", ".1 0 1; 0 .1 .5; 0 .2 1; 0 .1 1; 0 .3 .75; 0 0 0"),
}
"""Arms for kernels that no table needs: kinds of joints; rows of d, a [m], alpha [quarters]; which
joint leads, which follows, and by how much."""

NUMBERS = "numbers"
"""In place of an arm: entries that no robot needs."""

Answer = list[np.ndarray]


def arms() -> list[str]:
    """Tables that ship, calibrated ones (``name~``), arms of our own, and numbers."""
    return [*dh2urdf.list_tables(), *(f"{name}~" for name in NOISE), *OWN, NUMBERS]


def robot_of(arm: str) -> dh2urdf.Robot:
    """The arm's robot."""
    if arm in OWN:
        return dh2urdf.Robot.from_dh(own_table(*OWN[arm]))
    table, name = dh2urdf.load_table(arm.rstrip("~")), arm.rstrip("~")
    if name != arm:
        rng = Random(arm)
        keys, size = ("theta", "d", "a", "alpha"), NOISE[name]
        rows = [
            replace(row, **{k: getattr(row, k) + size * (rng.random() - 0.5) for k in keys})
            for row in table.rows
        ]
        table = replace(table, rows=tuple(rows))
    return dh2urdf.Robot.from_dh(table)


def own_table(
    kinds: str, text: str, leader: int = 0, follower: int = 0, by: float = 1.0
) -> DHTable:
    """A table of rows d, a, alpha."""
    rows = []
    for kind, line in zip(kinds, text.split(";"), strict=True):
        d, a, quarters = map(float, line.split())
        joint = JointType.PRISMATIC if kind == "P" else JointType.REVOLUTE
        follows = Mimic(f"joint_{leader}", by) if len(rows) + 1 == follower else None
        theta = 0.5 if kind == "P" else 0.0
        rows.append(DHRow(theta, d, a, quarters * QUARTER, joint, mimic=follows))
    return DHTable(tuple(rows), "standard")


def configurations(robot: dh2urdf.Robot, count: int, seed: str) -> np.ndarray:
    """Home, eighths and quarters of a turn, beside these, and anywhere: shape (count, n)."""
    rng, n = Random(seed), robot.n
    q = np.zeros((count, n))
    for k in range(1, count):
        eighths = [rng.randrange(-4, 5) for _ in range(n)]
        if k % 5 == 1:  # a multiple of 45 deg, or of 90
            q[k] = [e / 2 if k % 2 else e // 2 for e in eighths]
        elif k % 5 == 2:  # beside a multiple of 90 deg by 2^-8 ... 2^-52
            q[k] = [e // 2 + 0.5 ** rng.randrange(8, 53) for e in eighths]
        else:
            q[k] = [4.0 * rng.random() - 2.0 for _ in range(n)]
    q *= np.where(robot.slides, 0.25, QUARTER)
    return q


def poses_of(robot: dh2urdf.Robot, q: np.ndarray) -> np.ndarray:
    """Poses of configurations; one in nine is moved a little, one in nine out of reach."""
    T = robot.fk(q)
    T[5::9, :3, 3] += 0.0625
    T[7::9, :3, 3] *= 64.0
    return T


def questions(robot: dh2urdf.Robot, count: int, seed: str) -> Iterator[tuple[str, Answer]]:
    """Answers of a robot to all that it may be asked, by the name of the task."""
    q = configurations(robot, count, seed)
    T = poses_of(robot, q)
    measured: Answer = []
    yield "kinematics", [robot.fk(q), robot.frames(q), robot.jacobian(q)]
    yield "kinematics, one by one", [f(row) for row in q[:4] for f in (robot.fk, robot.jacobian)]
    for task in ("pose", "position", "position+axis"):
        few = count if task == "pose" else -(-count // 8)
        for inside in (True, False):
            name, asked = f"{task}{' inside' * inside}", {"task": task, "within_limits": inside}
            try:
                found = robot.ik_batch(T[:few], threads=1, **asked)
            except NoSolverError:
                continue
            yield name, _batch(found)
            if not robot.is_coupled:
                best = np.empty((3, few))
                measure(robot, task, found, best)
                measured.append(best)
            yield f"{name}, one by one", _singles(robot, q, T[: min(few, 4)], asked)
        found = robot.ik_numeric(T[3], task=task, seed=q[4], solutions=2, starts=6)
        yield f"{task}, searched", [found.q, found.residual, np.array(found.tried)]
    if measured:
        yield "measures", measured
    if robot.chain.n == 7 and not robot.is_coupled:
        yield from _redundant(robot, q, T)


def _batch(found) -> Answer:
    return [found.q, found.residual, found.count, found.branch_code, found.free_mask]


def _singles(robot, q, T, asked) -> Answer:
    """Poses one at a time with seeds and turns, and a path."""
    out = []
    for k, pose in enumerate(T):
        found = robot.ik(pose, seed=q[k + 1], turns="all" if k % 2 else "nearest", **asked)
        out += [found.q, found.residual, *found.codes]
    way = np.linspace(0.0, 1.0, len(T))[:, None] * (0.25 * q[3]) + q[-1]
    if robot.is_coupled and asked["task"] != "pose":
        return out  # no path of a joint to spare where values move joints together
    return [*out, robot.ik_path(robot.fk(way), start=way[0], **asked).q]


def _redundant(robot, q, T) -> Iterator[tuple[str, Answer]]:
    """What an arm with a joint to spare may be asked besides."""
    for joint in range(robot.n):
        asked = {"within_limits": False, "threads": 1}
        try:
            found = robot.ik_batch(T[:4], locked={joint: q[:4, joint]}, **asked)
        except (NoSolverError, ConfigurationError):
            continue
        yield f"joint {joint} held", _batch(found)
    yield "samples", _batch(robot.ik_batch(T[:4], samples=5, threads=1))
    yield "intervals", [robot.ik_intervals(T[k]) for k in (1, 3)]


def numbers() -> Iterator[tuple[str, Answer]]:
    """Answers of the entries that no robot needs."""
    from dh2urdf.kernels.numbers import any_family, trig

    rng, angles, roots = Random("numbers"), [], []
    for _ in range(200):
        x, y = (rng.choice((0.0, -0.0, 1.0, rng.random() - 0.5)) for _ in range(2))
        angles.append(trig.arctangent(y, x))
        series = np.array([rng.choice((0.0, rng.random() - 0.5)) for _ in range(5)])
        c, s = np.zeros(4), np.zeros(4)
        roots += [np.array(trig.trig_roots(series, 2, c, s)), c, s]
    yield "arctangents", [np.array(angles)]
    yield "roots", roots
    planar = [dh2urdf.planar_rr_ik(1.0, 0.5, k / 8, 0.625) for k in range(12)]
    yield "planar", planar
    yield "families", [np.array([any_family(np.array([k]), np.array([[0, 8]])) for k in range(3)])]
    yield "coupled", _coupled()
    yield "towards a seed", [x for k in range(4) for x in _towards_seed(robot_of("puma560"), k)]


def _towards_seed(robot: dh2urdf.Robot, k: int) -> Answer:
    """Solutions arranged as in one call with the pose; the last seed is too far away."""
    from dh2urdf.kernels.certificate import arrange_plain

    q = configurations(robot, 8, "seeds")
    T, seed = robot.fk(q[k]), np.where(k == 3, 1e9, q[k + 1])
    found = robot.ik(T)
    out = found.q[None].copy(), found.residual[None].copy(), np.array([len(found)])
    out += tuple(code[None].copy() for code in found.codes)
    largest, distance = np.full(6, 1e5), np.zeros(len(found))
    done = arrange_plain(robot.chain.tables, True, largest, 1e-12, 0, T[None], seed, out, distance)
    return [np.array([done]), *out, distance]


def _coupled() -> Answer:
    """An arm whose third joint adds half of the second: a batch, one pose with and without seed."""
    from dh2urdf.kernels.certificate import arrange_together, turn_together

    table = dh2urdf.load_table("puma560")
    second, third = table.joint_names[1:3]
    robot = dh2urdf.Robot.from_dh(replace(table, couplings={third: {second: 0.5}}))
    q = configurations(robot, 8, "coupled")
    T = robot.fk(q)
    batch = robot.ik_batch(T, threads=1)
    turns, found = robot._ik.problem().turns, robot.ik(T[5])
    joints, inside = robot.chain_configuration(found.q), np.zeros(len(found), np.bool_)
    turn_together(turns.anywhere, 1e-12, q[6:7], joints, inside)
    out = found.q[None].copy(), found.residual[None].copy(), np.array([len(found)])
    out += tuple(code[None].copy() for code in found.codes)
    given = robot.chain.tables, turns.anywhere, np.full(6, 1e5), 1e-12, 0, T[5:6], q[6]
    done = arrange_together(*given, out, np.zeros(len(found)))
    return [batch.q, batch.count, joints, inside, np.array([done]), *out]


def answers(arm: str, count: int) -> Iterator[tuple[str, Answer]]:
    """All of an arm, or of ``numbers``."""
    return numbers() if arm == NUMBERS else questions(robot_of(arm), count, arm)
