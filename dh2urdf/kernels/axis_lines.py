"""Joint axes as lines, snapped to what they nearly are: parallel, meeting, through one point."""

import math
from typing import Annotated, TypeAlias

from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.rigid import cross, dot, minus
from dh2urdf.kernels.shapes import Configuration, Floats, Integers, Slides

Vectors: TypeAlias = Annotated[Floats, "n", 3]

PARALLEL, MEETING, CENTRAL = 1, 2, 4
"""Bits of what a line does with the next: parallel; one common point; so with the next two."""

SQUARE = 1e-12
"""Cosine or sine [1] up to which an angle is a right one."""


def length(v):
    """Length of a vector."""
    return math.sqrt(dot(v, v))


def _put(rows, i, v):
    """Write a vector into a row."""
    rows[i, 0], rows[i, 1], rows[i, 2] = v[0], v[1], v[2]


def _snap_directions(axes, signs, tolerance):
    """Directions of neighbours that are nearly parallel or square to one another."""
    signs[0] = 1.0
    for i in range(1, len(signs)):
        before, axis = axes[i - 1], axes[i]
        along = dot(axis, before)
        signs[i] = 1.0
        if length(cross(axis, before)) <= tolerance:
            signs[i] = math.copysign(1.0, along)
            _put(axes, i, before)
        elif abs(along) <= SQUARE:
            for k in range(3):
                axis[k] -= along * before[k]
            long = length(axis)
            for k in range(3):
                axis[k] /= long


def _meeting(axes, points, i, tolerance, near):
    """Whether lines i and i + 1 meet; the point of i + 1 nearest to i."""
    u, v, p = axes[i], axes[i + 1], points[i + 1]
    normal = cross(u, v)
    square = dot(normal, normal)
    gap = minus(points[i], p)
    if square <= tolerance * tolerance:
        along = dot(v, gap)
        rest = gap[0] - v[0] * along, gap[1] - v[1] * along, gap[2] - v[2] * along
        return length(rest) <= near, points[i, 0], points[i, 1], points[i, 2]
    across = dot(gap, normal)
    along, up = dot(cross(u, gap), normal) / square, across / square
    x = p[0] + v[0] * along + normal[0] * up
    y = p[1] + v[1] * along + normal[1] * up
    z = p[2] + v[2] * along + normal[2] * up
    return abs(across) <= near * math.sqrt(square), x, y, z


def _across(axis, v):
    """``(1 - axis axis^T) v``: the part of a vector that is square to a line."""
    x, y, z = axis[0], axis[1], axis[2]
    return (
        (1.0 - x * x) * v[0] + (0.0 - x * y) * v[1] + (0.0 - x * z) * v[2],
        (0.0 - y * x) * v[0] + (1.0 - y * y) * v[1] + (0.0 - y * z) * v[2],
        (0.0 - z * x) * v[0] + (0.0 - z * y) * v[1] + (1.0 - z * z) * v[2],
    )


def _plus(u, v, w):
    """Sum of three vectors."""
    return u[0] + v[0] + w[0], u[1] + v[1] + w[1], u[2] + v[2] + w[2]


def _centre(axes, points, i, near):
    """Whether lines i, i + 1, i + 2 pass one point, no neighbours parallel; that point."""
    a, b, c, p = axes[i], axes[i + 1], axes[i + 2], points[i + 1]
    # normal equations (sum P) x = sum P (p - near), by Cramer's rule
    columns = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    x = _plus(_across(a, columns[0]), _across(b, columns[0]), _across(c, columns[0]))
    y = _plus(_across(a, columns[1]), _across(b, columns[1]), _across(c, columns[1]))
    z = _plus(_across(a, columns[2]), _across(b, columns[2]), _across(c, columns[2]))
    first, last = _across(a, minus(points[i], p)), _across(c, minus(points[i + 2], p))
    right = first[0] + 0.0 + last[0], first[1] + 0.0 + last[1], first[2] + 0.0 + last[2]
    det = dot(x, cross(y, z))
    centre = (
        p[0] + dot(cross(y, z), right) / det,
        p[1] + dot(cross(z, x), right) / det,
        p[2] + dot(cross(x, y), right) / det,
    )
    gap = max(
        length(_across(a, minus(centre, points[i]))),
        length(_across(b, minus(centre, p))),
        length(_across(c, minus(centre, points[i + 2]))),
    )
    return gap <= near, centre[0], centre[1], centre[2]


def _turning(slides, i, count):
    """Whether none of some neighbouring joints slides."""
    for j in range(i, i + count):
        if slides[j]:
            return False
    return True


def _snap_points(axes, slides, points, ties, tolerance, near):
    """A point on each line: the foot of the normal from the line before, or where they meet."""
    n = len(slides)
    for i in range(n - 2, -1, -1):
        if slides[i]:
            _put(points, i, points[i + 1])
    for i in range(1, n):
        if slides[i]:
            _put(points, i, points[i - 1])
            continue
        meets, x, y, z = _meeting(axes, points, i - 1, tolerance, near)
        if meets and not slides[i - 1]:
            _put(points, i, (x, y, z))
        else:
            along = dot(axes[i], minus(points[i - 1], points[i]))
            for k in range(3):
                points[i, k] += axes[i, k] * along
    for i in range(n - 2):
        if _turning(slides, i, 3) and not (ties[i] & PARALLEL or ties[i + 1] & PARALLEL):
            central, x, y, z = _centre(axes, points, i, near)
            if central:
                for j in range(i, i + 3):
                    _put(points, j, (x, y, z))


@entry()
def snap_lines(
    frames: Annotated[Floats, "n", 4, 4],
    slides: Slides,
    tolerance: float,
    near: float,
    axes: Vectors,
    points: Vectors,
    signs: Configuration,
    ties: Annotated[Integers, "n"],
):
    """Lines along z of frames (n, 4, 4), a sliding joint's through the point before it.

    ``tolerance``: angle [rad] that is snapped; ``near``: length [m]. ``signs``: -1 where a line
    points against its joint; ``ties``: what it does with those that follow.
    """
    n = len(slides)
    for i in range(n):
        for k in range(3):
            axes[i, k], points[i, k] = frames[i, k, 2], frames[i, k, 3]
    _snap_directions(axes, signs, tolerance)
    for i in range(n):
        same = i < n - 1 and axes[i, 0] == axes[i + 1, 0]
        same = same and axes[i, 1] == axes[i + 1, 1] and axes[i, 2] == axes[i + 1, 2]
        ties[i] = PARALLEL if same else 0
    _snap_points(axes, slides, points, ties, tolerance, near)
    for i in range(n - 1):
        if not ties[i] & PARALLEL and _meeting(axes, points, i, tolerance, near)[0]:
            ties[i] |= MEETING
    for i in range(n - 2):
        apart = ties[i] & PARALLEL == 0 and ties[i + 1] & PARALLEL == 0
        if apart and _turning(slides, i, 3) and _centre(axes, points, i, near)[0]:
            ties[i] |= CENTRAL


def _scaled(v, factor):
    """A vector times a number."""
    return v[0] * factor, v[1] * factor, v[2] * factor


def _foot(z, p, along):
    """The point of a line that is so far along it."""
    return p[0] + z[0] * along, p[1] + z[1] * along, p[2] + z[2] * along


def _any_normal(z):
    """A unit vector square to another."""
    x, y, w = abs(z[0]), abs(z[1]), abs(z[2])
    e = (0.0, 0.0, 1.0)
    if x <= y and x <= w:
        e = (1.0, 0.0, 0.0)
    elif y <= w:
        e = (0.0, 1.0, 0.0)
    normal = cross(z, e)
    long = length(normal)
    return normal[0] / long, normal[1] / long, normal[2] / long


def _common_normal(axes, points, i, parallel, near, x, origin):
    """Direction of the common normal from line i to line i + 1, and its foot on line i + 1.

    Where there are many it starts at the foot of the last one; x is kept where it has no length.
    """
    z, onward, p = axes[i], axes[i + 1], points[i + 1]
    if parallel:
        foot = _foot(onward, p, dot(onward, minus(origin, p)))
        gap = minus(foot, origin)
        distance = length(gap)
        if distance > near:
            return gap[0] / distance, gap[1] / distance, gap[2] / distance, *foot
        return *x, *origin
    normal = cross(z, onward)
    square = dot(normal, normal)
    gap = minus(points[i], p)
    foot = _foot(onward, p, dot(cross(z, gap), normal) / square)
    root = math.sqrt(square)
    way = normal[0] / root, normal[1] / root, normal[2] / root
    if dot(gap, way) > near:
        way = -way[0], -way[1], -way[2]
    return *way, *foot


def _write_frame(x, z, T):
    """Directions of a frame with the given z and the direction of x."""
    long = length(x)
    a = x[0] / long, x[1] / long, x[2] / long
    b = cross(z, a)
    for k in range(4):
        T[3, k] = 1.0 if k == 3 else 0.0
    T[0, 0], T[1, 0], T[2, 0] = a[0], a[1], a[2]
    T[0, 1], T[1, 1], T[2, 1] = b[0], b[1], b[2]
    T[0, 2], T[1, 2], T[2, 2] = z[0], z[1], z[2]


@entry()
def dh_frames(
    axes: Vectors,
    points: Vectors,
    ties: Annotated[Integers, "n"],
    near: float,
    frames: Annotated[Floats, "n", 4, 4],
):
    """Frames (n, 4, 4) of lines by Denavit and Hartenberg, z_i along line i, arguments as above."""
    n = axes.shape[0]
    x = _any_normal(axes[0])
    origin = points[0, 0], points[0, 1], points[0, 2]
    for i in range(n):
        if i > 0:
            parallel = ties[i - 1] & PARALLEL != 0
            a, b, c, u, v, w = _common_normal(axes, points, i - 1, parallel, near, x, origin)
            x, origin = (a, b, c), (u, v, w)
        if i == 1:
            _write_frame(x, axes[0], frames[0])
        along = dot(axes[i], x)
        _write_frame(minus(x, _scaled(axes[i], along)), axes[i], frames[i])
        frames[i, 0, 3], frames[i, 1, 3], frames[i, 2, 3] = origin[0], origin[1], origin[2]
    if n > 1:
        z, o, p = axes[0], frames[0], frames[1]
        gap = p[0, 3] - o[0, 3], p[1, 3] - o[1, 3], p[2, 3] - o[2, 3]
        along = dot(z, gap)
        for k in range(3):
            frames[0, k, 3] += z[k] * along
