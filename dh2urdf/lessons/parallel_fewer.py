"""An axis, three parallel ones, and one more or none: arms of four and five joints.

They lack joints for a full pose: what it has across the arm's plane is right or not.
"""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.circle import Linear
from dh2urdf.lessons.notation import Given, shown
from dh2urdf.lessons.parallel_plane import PLANE, before_last, bend_in_plane, beside, common_axis
from dh2urdf.lessons.position_arm import shoulders
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array

FREE = 5e-10
"""Sine up to which an axis is in line with another."""

OFF = 2e-9
"""What a pose may miss [m or rad]: twice what a residual may be."""

NEAR = 1e-3
"""Distance [m] of a point from axis 1 within which it says little of joint 1."""


def fewer_joints(asked: Asked, way: Way) -> Iterator[Way]:
    """Arms of four or five joints: joint 1 and, of five, joint 5; most poses have no solution."""
    rows, z = asked.arm.rows, asked.H[:3, 2]
    if len(rows) == 4:
        point, lean, by_place = asked.H[:3, 3], 1.0, False
    else:
        point, step = before_last(asked)
        way, lean = way.then(step), rows[3].ca
        by_place = math.hypot(point[0], point[1]) > NEAR
    if by_place:
        turned = [found for found, _ in shoulders(asked, way, point, beside(asked), PLANE)]
    else:
        turned = _by_direction(asked, way, z, lean)
    for found in turned:
        if found.stopped:
            yield found
            continue
        k = common_axis(asked, found.variables[0])
        checked = _across(asked, found, k, point, lean)
        if checked.stopped:
            yield checked
        else:
            yield from bend_in_plane(asked, checked if len(rows) == 4 else _last(asked, checked, k))


def _by_direction(asked: Asked, way: Way, z: Array, lean: float) -> list[Way]:
    """theta_1 from the direction of the last axis, ``k^T z = lean``."""
    row = asked.arm.rows[0]
    linear = Linear(
        "theta_1", -row.sa * float(z[1]), row.sa * float(z[0]), lean - row.ca * float(z[2])
    )
    what = "is parallel to" if lean == 1.0 else "makes the constant angle alpha_4 with"
    words = (
        f"{PLANE}The last axis, z = R e_3, {what} axes 2, 3, 4, whose direction k depends on "
        "theta_1 alone: A cos theta_1 + B sin theta_1 = C."
    )
    if linear.amplitude <= FREE:
        theta = asked.free_value(0)
        words += " Here z is along axis 1 and says nothing: theta_1 is free."
        equation = Equation("theta_1", "theta_1", {}, theta, "rad")
        step = joint_step(asked.arm, 0, "theta_1: free", words, [equation], theta)
        return [way.then(step).put(0, theta)]
    if not linear.solvable:
        return [way.stop(Step("theta_1", f"{words} {linear.test} Here the solution ends."))]
    found = []
    for root in linear.roots():
        given = [Equation(name, name, {}, getattr(linear, name)) for name in "ABC"]
        equations = [*given, linear.equation(root)]
        title = "theta_1: which way the arm faces"
        step = joint_step(asked.arm, 0, title, words, equations, root, (), "shoulder")
        found.append(way.then(step).put(0, root))
    return found


def _across(asked: Asked, way: Way, k: Array, point: Array, lean: float) -> Way:
    """Whether the pose is one of an arm that lacks a joint: what it has across the plane."""
    n, rows, z = asked.arm.n, asked.arm.rows, asked.H[:3, 2]
    level = np.array([0.0, 0.0, rows[0].d])
    aside, place = beside(asked), float(k @ (point - level))
    slope = float(k @ z)
    equations = (
        Equation("k", "z_1", {}, k),
        aside,
        Equation("b_c", "k^T (o_c - d_1 e_3)", {}, place, "m"),
        Equation("w", "k^T z", {}, slope),
    )
    off = abs(place - float(aside.value))
    leaning = abs(slope - lean) if abs(lean) < 0.5 else float(np.linalg.norm(np.cross(k, z)))
    if abs(lean) >= 0.5 and lean != 1.0:
        leaning = abs(slope - lean)
    words = (
        f"An arm of {n} joints has no say in what the pose has across the plane, once theta_1 is "
        f"known: the place has to be b from frame 0 along k, and k^T z has to be {shown(lean)}."
    )
    title = "Is the pose one of this arm?"
    if off <= OFF and leaning <= OFF:
        return way.then(Step(title, f"{words} Both are so.", equations))
    words += (
        f" The place is {shown(off)} m off the plane and the axis leans by "
        f"{shown(math.degrees(leaning))} deg too much: with this theta_1 there is no solution."
    )
    return way.stop(Step(title, words, equations))


def _last(asked: Asked, way: Way, k: Array) -> Way:
    """theta_5 of an arm of five joints turns the common direction to where the pose has it."""
    n = asked.H[:3, :3].T @ k
    sign = "" if asked.arm.rows[3].sa > 0.0 else "-"
    side = math.copysign(1.0, asked.arm.rows[3].sa)
    value = math.atan2(side * n[0], side * n[1])
    given: Given = {"n_x": float(n[0]), "n_y": float(n[1])}
    equations = [
        Equation("n", "R^T k", {}, n),
        Equation("theta_5", f"atan2({sign}n_x, {sign}n_y)", given, value, "rad"),
    ]
    words = (
        "Before joint 5 turns, the common direction is (0, sin(alpha_4), cos(alpha_4)) in frame 4; "
        "from frame 5 it is n = R^T k."
    )
    return way.then(joint_step(asked.arm, 4, "theta_5", words, equations, value)).put(4, value)
