"""Three neighbouring parallel axes: the other joints first, then a planar arm.

Along the parallel axes a point's height is free of the joints about them. Hawkins 2013 for the UR;
Elias and Wen 2024 in general. Where 5 meets 6 each step is one equation in one joint.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from dh2urdf.symbolic.formulas import Formulas, Vector
from dh2urdf.symbolic.letters import Letters, Link
from dh2urdf.symbolic.position import first_of_parallel
from dh2urdf.symbolic.wrist import orient


def before_last(F: Formulas, arm: Letters) -> Vector:
    """Origin of the last frame but one, ``o_c = p - R (a_n, 0, d_n)`` for alpha_n = 0."""
    last = arm.links[-1]
    centre = arm.p - arm.R * last.twist.T * sp.Matrix([last.a, 0, last.d])
    x, y, z = (F.let(f"{axis}_c", value) for axis, value in zip("xyz", centre, strict=True))
    return x, y, z


def second_parallel(F: Formulas, arm: Letters) -> str | None:
    """Axes 2, 3, 4 are parallel; of six joints 5 meets 6."""
    n = len(arm.links)
    if "P" in arm.kinds or n not in (4, 5, 6):
        return "it has not four to six joints that turn"
    one, two, three, four, *rest = arm.links
    if two.sa != 0 or three.sa != 0:
        return "its axes 2, 3 and 4 are not parallel"
    if n == 6 and rest[0].a != 0:
        return "its axes 5 and 6 do not meet"
    if 0 in (one.sa, two.a, three.a, *(link.sa for link in (four, *rest)[: n - 4])):
        return "some of its joints do the same"
    together = _together((two, three, four))
    ways = two.ca, two.ca * three.ca
    height = two.d + ways[0] * three.d + ways[1] * four.d
    F.heading(_POINTS[n])
    centre = before_last(F, arm)
    after = arm.R * arm.links[-1].twist.T
    if n == 6:
        height += together.ca * rest[0].d
    F.heading("Joint 1 puts it as far along axis 2 as the offsets say")
    height -= ways[1] * four.d if n == 4 else 0
    X, Y = first_of_parallel(F, one, centre, height, _beside(n, together, after))
    F.heading("The orientation gives the sum of joints 2, 3, 4 and those after them")
    if n == 6:
        orient(F, (together, *rest), one.rotation, after)
    else:
        _turn_of_few(F, together, rest, one.rotation.T * after)
    tail = (four.a, -together.sa * (rest[0].d if n == 6 else 0), sp.S.Zero)
    x, y, _ = together.turned(tail) if n > 4 else (0, 0, 0)
    _elbow(F, (two, three, four), together, X - x, Y - y)
    return None


def _beside(n: int, together: Link, after: Any) -> tuple[Any, Any] | None:
    """What the orientation of an arm of few joints says of the plane of axis 1 that it moves in."""
    if n == 4:
        return after[1, 2], -after[0, 2]
    return (after[0, 2], after[1, 2]) if n == 5 and together.ca == 0 else None


_POINTS = {
    4: "The last link taken off",
    5: "The point on axis 5 that the offsets say",
    6: "The point where axes 5 and 6 meet",
}


def _turn_of_few(F: Formulas, together: Link, rest: Sequence[Link], N: Any) -> None:
    """The sum of joints 2, 3, 4, and joint 5 of an arm that has one."""
    if not rest:
        F.point(together, sp.S.One, sp.S.Zero, N[0, 0], N[1, 0])
        return
    F.point(together, sp.S.Zero, -together.sa, N[0, 2], N[1, 2])
    sine, cosine = (N[:, i].dot(together.rotation[:, 1]) for i in range(2))
    F.angle(rest[0], sp.atan2(sine, cosine))


def first_parallel(F: Formulas, arm: Letters) -> str | None:
    """Axes 1, 2, 3 are parallel and 5 meets 6."""
    if arm.kinds != "RRRRRR":
        return "it has not six joints that turn"
    one, two, three, four, five, six = arm.links
    if one.sa != 0 or two.sa != 0:
        return "its axes 1, 2 and 3 are not parallel"
    if five.a != 0:
        return "its axes 5 and 6 do not meet"
    if 0 in (three.sa, five.sa, one.a, two.a):
        return "some of its joints do the same"
    F.heading("The point where axes 5 and 6 meet")
    x, y, z = before_last(F, arm)
    after = arm.R * six.twist.T
    together = _together((one, two, three))
    ways = one.ca, one.ca * two.ca
    F.heading("Its height gives joint 4")
    point = sp.Matrix(four.offset((sp.S.Zero, sp.S.Zero, five.d)))
    reach = together.twist * sp.Matrix(four.turned(tuple(point)))
    height = one.d + ways[0] * two.d + ways[1] * three.d
    if not F.meet(four, reach[2] + height - z):
        return "joint 4 does not lift the point where axes 5 and 6 meet"
    F.heading("The direction of axis 1, as the tool has it, gives joints 5 and 6")
    seen = (together.twist * four.rotation)[2, :]
    g = [F.let(f"g_{axis}", value) for axis, value in zip("xyz", seen, strict=True)]
    F.turn(five, -g[1] * five.sa, g[0] * five.sa, after[2, 2] - g[2] * five.ca)
    k = sp.Matrix([g]) * five.rotation
    F.point(six, after[2, 0], after[2, 1], k[0], k[1])
    F.heading("The direction of axis 6 gives the sum of joints 1, 2, 3")
    towards = together.twist * four.rotation * five.rotation[:, 2]
    F.point(together, towards[0], towards[1], after[0, 2], after[1, 2])
    tail = together.turned((three.a + reach[0], reach[1], sp.S.Zero))
    _elbow(F, (one, two, three), together, x - tail[0], y - tail[1])
    return None


def _together(links: Sequence[Link]) -> Link:
    """Three joints with parallel axes as one that turns about the first of them."""
    first, second, third = links
    way, label = first.ca * second.ca, "".join(sorted(link.label for link in links))
    c, s = sp.symbols(f"c_{label} s_{label}")
    return replace(third, label=label, c=c, s=first.way * s, ca=way * third.ca, sa=way * third.sa)


def _elbow(F: Formulas, links: Sequence[Link], together: Link, X: Any, Y: Any) -> None:
    """Three parallel joints whose sum is known, the third of which stands at a point."""
    one, two, three = links
    ways = one.ca, one.ca * two.ca
    F.heading(f"Joints {', '.join(sorted(link.label for link in links))} are a planar arm")
    k = three.label
    X, Y = F.let(f"X_{k}", X), F.let(f"Y_{k}", Y)
    F.meet(two, 2 * one.a * two.a * two.c + one.a**2 + two.a**2 - X**2 - Y**2)
    F.point(one, one.a + two.a * two.c, ways[0] * two.a * two.s, X, Y)
    total, first, second = (
        link.way * sp.Symbol(f"theta_{link.label}") for link in (together, one, two)
    )
    F.angle(three, ways[1] * (total - first - ways[0] * second))
