"""Arms in a plane: lecture notes 8.2, with any links and a slide along the axes or across them.

With ``P`` the end of the second link in the plane, ``P = Rz(theta_1) (L_1 + Rz(theta_2) L_2)``; the
square of the distance is free of theta_1.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from dh2urdf.symbolic.formulas import Formulas
from dh2urdf.symbolic.letters import Letters, Link

Plane = tuple[Any, Any]


@dataclass
class _Part:
    """What stands between one turning joint and the next, seen after the first has turned.

    ``x``, ``y`` is the vector, ``c``, ``s`` the constant turn at its end.
    """

    joint: Link | None
    x: Any = sp.S.Zero
    y: Any = sp.S.Zero
    c: Any = sp.S.One
    s: Any = sp.S.Zero

    def end(self, v: Plane) -> Plane:
        """``L + Rz(constant) v``."""
        return self.x + self.c * v[0] - self.s * v[1], self.y + self.s * v[0] + self.c * v[1]

    def unturned(self, v: Plane) -> Plane:
        """``Rz(-constant) v``."""
        return self.c * v[0] + self.s * v[1], self.c * v[1] - self.s * v[0]


def _parts(links: Sequence[Link]) -> tuple[list[_Part], Any, Link | None, Any]:
    """The plane's parts, the height of the end, the slide and its direction along the axes."""
    parts, height, up, slide, way = [_Part(None)], sp.S.Zero, sp.S.One, None, sp.S.One
    for link in links:
        s = up * link.s
        if link.slides:
            slide, way = link, up
            part = parts[-1]
            part.c, part.s = part.c * link.c - part.s * s, part.s * link.c + part.c * s
        else:
            parts.append(_Part(replace(link, s=s, way=int(up))))
        part = parts[-1]
        part.x, part.y = part.end((link.a, sp.S.Zero))
        if not link.slides:
            height += up * link.d
        up *= link.ca
    return parts, height, slide, way


def planar(F: Formulas, arm: Letters) -> str | None:
    """Two or three turning joints with parallel axes, and a slide along them or none."""
    turning = [link for link in arm.links if not link.slides]
    if len(turning) not in (2, 3) or len(arm.links) > len(turning) + 1:
        return "it has not two or three joints that turn, and a slide at most"
    if any(link.sa != 0 for link in arm.links[:-1]):
        return "its axes are not parallel"
    base, *parts = (found := _parts(arm.links))[0]
    if any((part.x, part.y) == (0, 0) for part in parts[:2]):
        return "one of its first two links has no length"
    _, height, slide, way = found
    x, y, z = arm.p
    cosine, sine = arm.R[0, 0], arm.R[1, 0]
    if slide is not None:
        F.heading("The slide is the height that the offsets leave")
        F.length(slide, way * (z - height))
    if len(parts) == 3:
        F.heading("The last link taken off")
        back = parts[2].unturned((parts[2].x, parts[2].y))
        x = F.let("x_3", x - cosine * back[0] + sine * back[1])
        y = F.let("y_3", y - sine * back[0] - cosine * back[1])
    F.heading("The elbow from the distance, then the shoulder")
    X, Y = map(sp.expand, base.unturned((x - base.x, y - base.y)))
    X, Y = F.let("X", X), F.let("Y", Y)
    one, two = parts[0].joint, parts[1].joint
    assert one is not None
    assert two is not None
    bent = two.turned((parts[1].x, parts[1].y, sp.S.Zero))[:2]
    first = parts[0].unturned((parts[0].x, parts[0].y))
    product = first[0] * bent[0] + first[1] * bent[1]
    squares = sum(part.x**2 + part.y**2 for part in parts[:2])
    F.meet(two, 2 * product + squares - X**2 - Y**2)
    F.point(one, *parts[0].end(bent), X, Y)
    if len(parts) == 3:
        F.heading("The last joint is what is left of the angle")
        last = parts[2].joint
        assert last is not None
        joints = [part.joint for part in parts[:2] if part.joint]
        angles = sum(joint.way * sp.Symbol(f"theta_{joint.label}") for joint in joints)
        constant = sum(sp.atan2(part.s, part.c) for part in (base, *parts))
        F.angle(last, sp.atan2(sine, cosine) - angles - constant)
    return None


def sliding_planar(F: Formulas, arm: Letters) -> str | None:
    """RPR: two turning joints with parallel axes, a slide across them (lecture notes 7.1)."""
    if arm.kinds != "RPR":
        return "it is not RPR"
    one, two, three = arm.links
    M = one.twist * two.rotation
    if one.ca != 0 or M[2, 2] ** 2 != 1:
        return "its slide is not across two parallel axes"
    F.heading("The last link taken off")
    x = F.let("x_3", arm.p[0] - three.a * arm.R[0, 0])
    y = F.let("y_3", arm.p[1] - three.a * arm.R[1, 0])
    F.heading("The slide from the distance, then the joints before and after")
    along = sp.Matrix([one.a, 0, 0]) + one.twist * sp.Matrix([two.a * two.c, two.a * two.s, two.d])
    along += M * sp.Matrix([0, 0, three.d])
    if not F.meet(two, along[0] ** 2 + along[1] ** 2 - x**2 - y**2):
        return "its slide moves nothing in the plane"
    F.point(one, along[0], along[1], x, y)
    c, s, _ = M.T * sp.Matrix(one.back(tuple(arm.R[:, 0])))
    F.angle(three, sp.atan2(sp.expand(s), sp.expand(c)))
    return None
