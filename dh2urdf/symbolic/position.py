"""Three joints that turn or slide put a point at a place: the first half of decoupling.

With ``u`` the point as joint 2 carries it and ``w = Rz(-theta_1) o_c - d_1 e_3``::

    w_x = a_1 + (c_2 u_x - s_2 u_y)
    w_y = cos(alpha_1) (s_2 u_x + c_2 u_y) - sin(alpha_1) u_z
    w_z = sin(alpha_1) (s_2 u_x + c_2 u_y) + cos(alpha_1) u_z

Pieper 1968; Craig, section 4.6: what is said here of one joint is free of the other two.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from dh2urdf.symbolic.formulas import Formulas, Vector, tidy
from dh2urdf.symbolic.letters import Link

QUARTIC = "its position arm needs the roots of a quartic"


def place(F: Formulas, links: Sequence[Link], centre: Vector, tail: Vector) -> str | None:
    """Add the steps that find joints 1 to 3; or say what keeps formulas from it.

    ``tail`` is the point in the last link's frame, ``centre`` where it shall be.
    """
    kinds = "".join("P" if link.slides else "R" for link in links)
    if kinds.count("P") > 1:
        return _slides(F, links, centre, tail)
    ways: dict[str, Callable[..., bool]] = {"PRR": _first_slides, "RPR": _second_slides}
    solved = ways.get(kinds, _two_turn)(F, *links, centre, tail)
    return None if solved else QUARTIC


def _square(*parts: Any) -> Any:
    return sum(part**2 for part in parts)


def first_of_parallel(
    F: Formulas, one: Link, centre: Vector, height: Any, beside: tuple[Any, Any] | None = None
) -> tuple[Any, Any]:
    """Joint 1 where axis 2 and those after it are parallel; the point in their plane.

    ``sin(alpha_1) (s_1 x_c - c_1 y_c) = u_z - cos(alpha_1) z``, u_z the height of the point
    along axis 2. ``beside`` is a direction in that plane, for a point on axis 1.
    """
    x, y, z = centre[0], centre[1], centre[2] - one.d
    off = height - one.ca * z
    seen = (x, y) if beside is None or tidy(off) != 0 else F.unless_none(one, (x, y), beside)
    F.turn(one, -one.sa * seen[1], one.sa * seen[0], off)
    w = one.back((x, y, z))
    X = F.let("X", w[0] - one.a)
    return X, F.let("Y", one.ca * w[1] + one.sa * z)


def _two_turn(F: Formulas, one: Link, two: Link, three: Link, centre: Vector, tail: Vector) -> bool:
    """Joints 1 and 2 turn, 3 turns or slides."""
    u = tuple(map(tidy, two.offset(three.turned(three.offset(tail)))))
    x, y, z = centre[0], centre[1], centre[2] - one.d
    if two.sa == 0 and one.sa != 0 and not three.slides:
        X, Y = first_of_parallel(F, one, centre, u[2])
        if not F.meet(three, _square(u[0], u[1]) - X**2 - Y**2):
            return False
        F.point(two, u[0], u[1], X, Y)
        return True
    if one.sa == 0:
        if not F.meet(three, one.ca * u[2] - z):
            return False
        u = _named(F, u)
        A, B = 2 * one.a * u[0], -2 * one.a * u[1]
        F.turn(two, A, B, _square(x, y) - _square(one.a, u[0], u[1]))
    elif one.a == 0:
        if not F.meet(three, _square(*u) - _square(x, y, z)):
            return False
        u = _named(F, u)
        F.turn(two, one.sa * u[1], one.sa * u[0], z - one.ca * u[2])
    else:
        return False
    v = two.turned(u)
    F.point(one, one.a + v[0], one.ca * v[1] - one.sa * u[2], x, y)
    return True


def _named(F: Formulas, u: Vector) -> Vector:
    """The point as joint 2 carries it, once joint 3 is known."""
    x, y, z = (F.let(f"u_{axis}", part) for axis, part in zip("xyz", u, strict=True))
    return x, y, z


def _second_slides(
    F: Formulas, one: Link, two: Link, three: Link, centre: Vector, tail: Vector
) -> bool:
    """Joint 2 slides: it is eliminated along axis 2."""
    x, y, z = centre[0], centre[1], centre[2] - one.d
    whole = two.turned(two.offset(three.turned(three.offset(tail))))
    v = (whole[0], whole[1], whole[2] - two.d)
    if one.ca == 0:
        if not F.meet(three, one.sa * v[1] - z):
            return False
        E = F.root(f"E_{two.label}", _square(x, y) - _square(one.a + v[0]))
        E *= F.choice(f"sigma_{two.label}")
        F.length(two, tidy(-E / one.sa - v[2]))
        F.point(one, one.a + v[0], E, x, y)
        return True
    if one.sa == 0:
        if not _circle(F, three, one.a + v[0], v[1], _square(x, y)):
            return False
        F.length(two, tidy(one.ca * z - v[2]))
        F.point(one, one.a + v[0], one.ca * v[1], x, y)
        return True
    return False


def _first_slides(
    F: Formulas, one: Link, two: Link, three: Link, centre: Vector, tail: Vector
) -> bool:
    """Joint 1 slides: what is normal to it is known."""
    u = two.offset(three.turned(three.offset(tail)))
    x, y, _ = one.back(centre)
    if one.ca == 0:
        if not F.meet(three, one.sa * u[2] + y):
            return False
        F.turn(two, u[0], -u[1], x - one.a)
        v = two.turned(u)
        F.length(one, tidy(centre[2] - one.sa * v[1]))
        return True
    if one.sa == 0:
        X, Y = F.let("X", x - one.a), F.let("Y", one.ca * y)
        if not _circle(F, three, u[0], u[1], X**2 + Y**2):
            return False
        F.point(two, u[0], u[1], X, Y)
        F.length(one, tidy(centre[2] - one.ca * u[2]))
        return True
    return False


def _circle(F: Formulas, link: Link, P: Any, Q: Any, C: Any) -> bool:
    """Solve ``P^2 + Q^2 = C``, P and Q linear in the functions of an angle, or one constant."""
    P, Q = tidy(P), tidy(Q)
    if F.meet(link, P**2 + Q**2 - C):
        return True
    unknown = link.c.free_symbols | link.s.free_symbols
    P, Q = (P, Q) if P.free_symbols & unknown else (Q, P)
    if Q.free_symbols & unknown:
        return False
    tau = F.choice(f"tau_{link.label}")
    return F.meet(link, P - tau * F.root(f"F_{link.label}", C - Q**2))


def _slides(F: Formulas, links: Sequence[Link], centre: Vector, tail: Vector) -> str | None:
    """Two or three joints slide: along the normal of two slides nothing but the turn counts."""
    whole = sp.Matrix(tail)
    for link in reversed(links):
        whole = sp.Matrix(link.turned(link.offset(tuple(whole))))
    lengths = [sp.Symbol(f"d_{link.label}") for link in links if link.slides]
    slides = [replace(link, way=1) for link in links if link.slides]
    along = [whole.diff(d) for d in lengths]
    gap = sp.Matrix(centre) - whole.subs(dict.fromkeys(lengths, 0))
    turning = next((link for link in links if not link.slides), None)
    if turning is not None:
        along.append(along[0].cross(along[1]))
        if not F.meet(turning, along[2].dot(gap)):
            return QUARTIC
    volume = _unit(along[0].dot(along[1].cross(along[2])), turning)
    for k, slide in enumerate(slides):
        normal = along[(k + 1) % 3].cross(along[(k + 2) % 3])
        F.length(slide, _unit(gap.dot(normal), turning) / volume)
    return None


def _unit(value: Any, link: Link | None) -> Any:
    """An expression with ``s^2 = 1 - c^2`` put in."""
    if link is None:
        return tidy(value)
    c, s = sp.Symbol(f"c_{link.label}"), sp.Symbol(f"s_{link.label}")
    return tidy(sp.expand(value).subs(s**2, 1 - c**2))
