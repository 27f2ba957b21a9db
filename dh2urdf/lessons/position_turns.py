"""Joints 1 and 3 turn: two equations in two angles, one by one or by a quartic (Pieper 1968)."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.circle import VOID, Linear, curve_of, real_roots
from dh2urdf.lessons.seen import ON_AXIS, Seen, freely, linear_step
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array


def two_turns(asked: Asked, way: Way, y: Seen, v: Seen) -> Iterator[Way]:
    """Joints 1 and 3 turn: one after the other, or a quartic equation."""
    first, second = _rows(asked, y, v)
    if math.hypot(*y.C[:2]) <= ON_AXIS and math.hypot(*y.S[:2]) <= ON_AXIS:
        yield from _one_by_one(asked, way, (v, y), _only(first, second, 2), (first, second), True)
        return
    for seen, other, at in ((v, y, 0), (y, v, 2)):
        lone = _combined(first, second, at)
        if lone is not None:
            yield from _one_by_one(asked, way, (seen, other), lone, (first, second), False)
            return
    yield from _quartic(asked, way, (y, v), (first, second))


def _rows(asked: Asked, y: Seen, v: Seen) -> list[tuple[float, ...]]:
    """The equations ``a c1 + b s1 + e c3 + f s3 = d`` of two turning joints."""
    if asked.arm.rows[1].slides:
        return [(y.C[i], y.S[i], -v.C[i], -v.S[i], v.k[i] - y.k[i]) for i in (0, 1)]
    height = (y.C[2], y.S[2], -v.C[2], -v.S[2], v.k[2] - y.k[2])
    # k.C of what joint 1 turns is that of its part across axis 1
    length = (
        *(2.0 * float(y.k @ y.C), 2.0 * float(y.k @ y.S)),
        *(-2.0 * float(v.k @ v.C), -2.0 * float(v.k @ v.S)),
        float(v.k @ v.k + v.C @ v.C - y.k @ y.k - y.C @ y.C),
    )
    size = float(np.abs(y.k) @ np.abs(y.C) + np.abs(v.k) @ np.abs(v.C)) + abs(length[4])
    clean = tuple(0.0 if abs(t) <= VOID * size else t for t in length)
    return [height, clean]


def _combined(
    first: tuple[float, ...], second: tuple[float, ...], at: int
) -> tuple[float, ...] | None:
    """A combination of two equations without the pair of terms at ``at``; None: there is none."""
    a, b, c, d = *first[at : at + 2], *second[at : at + 2]
    size = max(map(abs, (a, b, c, d)))
    if abs(a * d - b * c) > 1e-12 * size * size:
        return None
    one, two = math.hypot(a, b), math.hypot(c, d)
    big, small = (first, second) if one >= two else (second, first)
    factor = 0.0
    if max(one, two):
        pair = big[at : at + 2]
        factor = (pair[0] * small[at] + pair[1] * small[at + 1]) / (pair[0] ** 2 + pair[1] ** 2)
    return tuple(s - factor * g for s, g in zip(small, big, strict=True))


def _only(first: tuple[float, ...], second: tuple[float, ...], at: int) -> tuple[float, ...]:
    """Of two equations the one that says more of the pair of terms at ``at``."""
    return max((first, second), key=lambda row: math.hypot(row[at], row[at + 1]))


def _one_by_one(
    asked: Asked,
    way: Way,
    pair: tuple[Seen, Seen],
    lone: tuple[float, ...],
    both: tuple[tuple[float, ...], tuple[float, ...]],
    free: bool,
) -> Iterator[Way]:
    """One equation has the first joint of a pair alone; then the other joint from what is left."""
    seen, other = pair
    at, rest = (2, 0) if seen.joint == 2 else (0, 2)
    linear = Linear(seen.name, lone[at], lone[at + 1], lone[4])
    words = (
        f"One equation, or a sum of both, has {seen.name} alone: A cos {seen.name} + "
        f"B sin {seen.name} = C."
    )
    if not linear.solvable:
        end = Step(seen.name, f"{words} {linear.test} Here the solution ends.")
        yield way.stop(end)
        return
    row = _only(*both, rest)
    for root in linear.roots():
        step = linear_step(asked, seen, linear, root, words)
        turned = way.then(step).put(seen.joint, root)
        if free:
            yield freely(asked, turned, other)
            continue
        known = row[4] - row[at] * math.cos(root) - row[at + 1] * math.sin(root)
        then = Linear(other.name, row[rest], row[rest + 1], known)
        words_then = (
            f"With it the other equation is A cos {other.name} + B sin {other.name} = C, too."
        )
        if not then.solvable:
            yield turned.stop(Step(other.name, f"{words_then} {then.test} Here the solution ends."))
            continue
        for value in then.roots():
            step = linear_step(asked, other, then, value, words_then)
            yield turned.then(step).put(other.joint, value)


def _quartic(
    asked: Asked,
    way: Way,
    pair: tuple[Seen, Seen],
    both: tuple[tuple[float, ...], tuple[float, ...]],
) -> Iterator[Way]:
    """Both equations have both angles: cos and sin of theta_1 eliminated, theta_3 by a quartic."""
    y, v = pair
    rows = np.array(both)
    M, N, d = rows[:, :2], rows[:, 2:4], rows[:, 4]

    def outer(x: float) -> Array:
        found: Array = np.linalg.solve(M, d - N @ [math.cos(x), math.sin(x)])
        return found

    def f(x: float) -> float:
        c, s = outer(x)
        return float(c * c + s * s - 1.0)

    roots = real_roots(f, 2)
    words = (
        f"Both equations have both angles. They are linear in cos and sin of {y.name}: solve for "
        f"these and put them into cos^2 + sin^2 = 1. What is left, f({v.name}) = 0, has degree two "
        f"in cos and sin of {v.name}: a quartic equation in tan({v.name}/2), four roots at most. "
        f"{len(roots) or 'None'} of them {'is' if len(roots) == 1 else 'are'} real"
    )
    curve = curve_of(v.name, f, roots)
    if not roots:
        yield way.stop(Step(v.name, f"{words}: here the solution ends.", curve=curve))
        return
    for root in roots:
        equation = Equation(v.name, v.name, {}, root, "rad", tuple(x for x in roots if x != root))
        title = f"{v.name}: a quartic"
        third = joint_step(asked.arm, v.joint, title, f"{words}.", [equation], root, curve=curve)
        c, s = (float(t) for t in outer(root))
        value = math.atan2(s, c)
        then = [Equation(y.name, "atan2(s_1, c_1)", {"s_1": s, "c_1": c}, value, "rad")]
        first = joint_step(
            asked.arm, y.joint, y.name, "Its cosine and sine follow by going back.", then, value
        )
        yield way.then(third, first).put(v.joint, root).put(y.joint, value)
