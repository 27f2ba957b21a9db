"""One to five joints without a structure that helps: a null vector of the closed loop."""

import math
from collections.abc import Iterator, Sequence
from functools import reduce

import numpy as np

from dh2urdf.lessons.arm import Arm, Row
from dh2urdf.lessons.circle import curve_of, real_roots, series_of
from dh2urdf.lessons.eliminated import back
from dh2urdf.lessons.elimination import links_of
from dh2urdf.lessons.notation import Given, shown
from dh2urdf.lessons.short_loop import Loop
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way
from dh2urdf.transforms import Array, inverse

MOST = 5

OFF = 2e-9
"""What a pose may miss [m and rad]: twice what a residual may be."""

FULL = 1e-7
"""Singular value of M, of one of size 1, that does not vanish."""

NEWTON = 6
"""Steps that make a root sharp."""

BLUNT = 1e-4
"""What they may move it by [rad]; farther off is another root's solution."""


def fits(rows: tuple[Row, ...]) -> bool:
    """Whether the loop of up to five joints has one null vector, at a random configuration."""
    if len(rows) > MOST:
        return False
    q = np.random.default_rng(2).uniform(-1.0, 1.0, len(rows))
    moved = (
        row.motion((row.d if row.slides else row.theta) + row.sign * float(v))
        for row, v in zip(rows, q, strict=True)
    )
    loop = _best(rows, reduce(np.matmul, moved))
    if loop.x is None:
        sigma, _ = loop.null()
        return len(rows) < MOST and bool(sigma[-2] > FULL * sigma[0])
    x = float(q[loop.x])
    (*_, last, _), (*_, elsewhere) = (loop.null(angle)[0] / 2.0 for angle in (x, x + 1.0))
    return bool(min(last, elsewhere) > FULL)


def closed_loop(asked: Asked) -> Iterator[Way]:
    """All ways: of five joints one for each root of the polynomial, else one."""
    loop = _best(asked.arm.rows, asked.H)
    way = Way().then(Step("What is eliminated", _words(loop)))
    if loop.x is None:
        ways = [_from_null(asked, way, loop, {})]
    else:
        roots = real_roots(loop, 2)
        ways = [_from_root(asked, way, loop, roots, root) for root in roots]
        if not roots:
            words = f"The determinant has no real root in q_{loop.x + 1}: here the solution ends."
            ways = [way.stop(Step(f"q_{loop.x + 1}", words))]
    if asked.guide is not None and not any(_leads(asked, found) for found in ways):
        words = (
            "M says too little of this solution: it has more than one null vector here, or its "
            "determinant vanishes for all values. These are the values that `ik` found."
        )
        ways.append(back(asked, way, words))
    yield from ways


def _leads(asked: Asked, way: Way) -> bool:
    """Whether a way leads to the solution that is explained."""
    if way.stopped or asked.guide is None:
        return False
    arm = asked.arm
    gaps = [arm.joint_value(i, way.variables[i]) - asked.guide[i] for i in range(arm.n)]
    pairs = zip(gaps, arm.rows, strict=True)
    return all(abs(v if row.slides else math.remainder(v, math.tau)) <= BLUNT for v, row in pairs)


def _best(rows: Sequence[Row], H: Array) -> Loop:
    """The cut of the loop whose determinant says most: of five joints; of fewer the first."""
    links, slides = links_of(rows, H), [row.slides for row in rows]
    cuts = [Loop(links, slides, start) for start in range(len(rows))]
    fit = [cut for cut in cuts if cut.square and cut.x is not None and not slides[cut.x]]
    return max(fit, key=lambda cut: float(np.abs(series_of(cut, 2)).max())) if fit else cuts[0]


def _words(loop: Loop) -> str:
    """How the loop is cut."""
    pairs = [
        f"joint{'s' * (len(pair) > 1)} {' and '.join(str(i + 1) for i in pair)}"
        for pair in loop.pairs
        if pair
    ]
    size = len(loop.left[0]) + len(loop.right)
    words = (
        "A pose has six numbers, the arm fewer joints: most poses have no solution. Nothing "
        "decouples, so take the loop that the arm and the pose close, in dual quaternions. There "
        "a turn about z is u + v k, with u : v = cos(q/2) : sin(q/2), and a slide along z is u + "
        "v eps k, with v / u = q/2, lengths in a unit of "
        f"{shown(loop.unit)} m: both are linear in u and v. "
    )
    if len(pairs) == 2:
        words += f"Cut the loop: {pairs[0]} on one side, {pairs[1]} on the other"
        words += f", and joint {loop.x + 1} between. " if loop.x is not None else ". "
    words += (
        f"Eight equations are linear in the {size} products of the u and v of each side: M w = 0, "
        f"with an 8 x {size} matrix M of the links and the pose"
    )
    return words + (
        f", and of joint {loop.x + 1}. There is a solution only where det M vanishes."
        if loop.x is not None
        else "."
    )


def _from_root(asked: Asked, way: Way, loop: Loop, roots: list[float], root: float) -> Way:
    """The way of one root of the determinant."""
    assert loop.x is not None
    name = f"q_{loop.x + 1}"
    sharp = _sharpened(asked, loop, root)
    x = root if sharp is None else float(sharp[loop.x])
    others = tuple(v for v in roots if v != root)
    words = (
        f"det M is a polynomial of degree 2 in cos {name} and sin {name}, of degree 4 in "
        f"tan({name}/2): five of its values give its coefficients. Real roots: {len(roots)}, each "
        "of which is tried."
    )
    if sharp is not None:
        words += " A step or two of Newton's method on the whole arm make it sharp."
    equation = Equation(name, name, {}, x, "rad", others)
    curve = curve_of(name, loop, roots)
    step = Step(f"{name}: a root of the polynomial", words, (equation,), loop.x, curve=curve)
    found = way.then(step).put(loop.x, asked.arm.variable(loop.x, x))
    return _from_null(asked, found, loop, {loop.x: x})


def _from_null(asked: Asked, way: Way, loop: Loop, known: dict[int, float]) -> Way:
    """The joints of both sides from the null vector, if it is one and consists of products."""
    sigma, vector = loop.null(*known.values())
    least = float(sigma[-1])
    if least > FULL * float(sigma[0]):
        words = (
            f"The least singular value of M is {shown(least)}, the largest {shown(float(sigma[0]))}"
            ": no vector w solves M w = 0, the pose is none of this arm's. Here the solution ends."
        )
        return way.stop(Step("The null vector", words))
    parts = loop.joints(vector)
    q = _configuration(asked.arm, loop, known, vector)
    miss = _missed(asked.arm, asked.H, q)
    if not miss <= OFF:
        words = (
            "M has a null vector, but its entries are no products u_a u_b, u_a v_b, v_a u_b, v_a "
            f"v_b: taken apart all the same, they miss the pose by {miss:.1e} (metres and "
            "radians). Here this way ends."
        )
        return way.stop(Step("The null vector", words))
    words = (
        f"The least singular value of M is {least:.1e}: rounding. Its vector w has the products; "
        "the larger row and column of each side's have u : v of each joint."
    )
    way = way.then(Step("The null vector", words))
    for i, (u, v) in sorted(parts.items()):
        way = way.then(_split(loop, i, u, v)).put(i, asked.arm.variable(i, float(q[i])))
    return way


def _split(loop: Loop, i: int, u: float, v: float) -> Step:
    """A joint's value from its u and v."""
    k = i + 1
    given: Given = {f"u_{k}": u, f"v_{k}": v, "L": loop.unit}
    formula, words, unit = f"2 atan2(v_{k}, u_{k})", "A turn: twice the angle of (u, v).", "rad"
    if loop.slides[i]:
        formula, words, unit = f"2 L v_{k} / u_{k}", "A slide, in units of L.", "m"
    value = loop.value(i, u, v)
    value = value if loop.slides[i] else math.remainder(value, math.tau)
    return Step(f"q_{k}", words, (Equation(f"q_{k}", formula, given, value, unit),), i)


def _configuration(arm: Arm, loop: Loop, known: dict[int, float], vector: Array) -> Array:
    """The joint values q (n,) of a null vector."""
    values = {i: loop.value(i, u, v) for i, (u, v) in loop.joints(vector).items()} | known
    return np.array([values[i] for i in range(arm.n)])


def _off(arm: Arm, H: Array, q: Array) -> tuple[Array, Array]:
    """How far a pose (4, 4) is from frame n at q, (6,) in [m] and [rad], and the Jacobian."""
    values = [arm.variable(i, float(v)) for i, v in enumerate(q)]
    frames = arm.frames(values)
    tip, columns = frames[-1], []
    for row, F in zip(arm.rows, frames, strict=False):
        z = row.sign * F[:3, 2]
        turn = np.zeros(3) if row.slides else z
        columns.append(
            np.concatenate([z if row.slides else np.cross(z, tip[:3, 3] - F[:3, 3]), turn])
        )
    rest = 0.5 * np.cross(tip[:3, :3], H[:3, :3], axis=0).sum(axis=1)
    return np.concatenate([H[:3, 3] - tip[:3, 3], rest]), np.array(columns).T


def _missed(arm: Arm, H: Array, q: Array) -> float:
    """By how much q misses a pose [m and rad]."""
    if not np.isfinite(q).all():
        return math.inf
    tip = arm.frames([arm.variable(i, float(v)) for i, v in enumerate(q)])[-1]
    return float(np.abs(inverse(tip) @ H - np.eye(4)).max())


def _sharpened(asked: Asked, loop: Loop, root: float) -> Array | None:
    """The configuration of a root after Newton's method on the whole arm; None: it is none."""
    assert loop.x is not None
    q = _configuration(asked.arm, loop, {loop.x: root}, loop.null(root)[1])
    if not np.isfinite(q).all():
        return None
    for _ in range(NEWTON):
        off, J = _off(asked.arm, asked.H, q)
        q = q + np.linalg.lstsq(J, off, rcond=None)[0]
    stays = abs(math.remainder(float(q[loop.x]) - root, math.tau)) <= BLUNT
    return q if stays and _missed(asked.arm, asked.H, q) <= OFF else None
