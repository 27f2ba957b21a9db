"""Three joints slide: the others follow from the orientation alone, then slides are linear."""

import math
from collections.abc import Iterator

import numpy as np

from dh2urdf.lessons.arm import Row
from dh2urdf.lessons.circle import Linear
from dh2urdf.lessons.equation import Equation
from dh2urdf.lessons.notation import Given, shown, vector_shown
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked, Way, joint_step
from dh2urdf.transforms import Array

OFF = 2e-9
"""What an orientation may miss [rad]: twice what a residual may be."""

FREE = 5e-10
"""Sine up to which the outer turning axes are in line."""


def three_slides(asked: Asked) -> Iterator[Way]:
    """All ways: the turning joints, then the slides."""
    rows = asked.arm.rows
    turning = [i for i, row in enumerate(rows) if not row.slides]
    names = " and ".join(f"theta_{i + 1}" for i in turning)
    words = (
        f"Slides do not turn anything: the orientation depends on {names} alone, and they follow "
        "from it. Then the place is three linear equations for the three slides."
    )
    way = Way().then(Step("What decouples", words))
    between = _between(rows, turning)
    B = between[0].T @ asked.H[:3, :3] @ between[-1].T
    if len(turning) == 2:
        turned = [_outer(asked, way, turning, (between[1], B))]
    else:
        turned = list(_three_turns(asked, way, turning, (between[1], between[2], B)))
    for found in turned:
        yield found if found.stopped else _slides(asked, found, turning)


def _between(rows: tuple[Row, ...], turning: list[int]) -> list[Array]:
    """The constant rotations before, between and after the turning joints."""
    out = [np.eye(3)]
    for i, row in enumerate(rows):
        rest = row.motion(0.0)[:3, :3]
        if i in turning:
            out.append(rest)
        else:
            out[-1] = out[-1] @ rest
    return out


def _three_turns(
    asked: Asked, way: Way, turning: list[int], parts: tuple[Array, Array, Array]
) -> Iterator[Way]:
    """The middle joint from one entry of the rotation, then the outer ones."""
    C1, C2, B = parts
    i, j, k = turning
    p, x = C1[2], C2[:, 2]
    name = f"theta_{j + 1}"
    linear = Linear(
        name,
        *(float(p[0] * x[0] + p[1] * x[1]), float(p[1] * x[0] - p[0] * x[1])),
        float(B[2, 2] - p[2] * x[2]),
    )
    words = (
        f"With constant rotations C_1 and C_2 of the table between the turning axes, and those at "
        f"both ends taken off R, what is left is B = Rz(theta_{i + 1}) C_1 Rz({name}) C_2 "
        f"Rz(theta_{k + 1}). Its entry in the third row and column knows {name} alone: "
        f"A cos {name} + B sin {name} = C."
    )
    if not linear.solvable:
        yield way.stop(Step(name, f"{words} {linear.test} Here the solution ends."))
        return
    for root in linear.roots():
        given = [Equation(letter, letter, {}, getattr(linear, letter)) for letter in "ABC"]
        equations = [*given, linear.equation(root)]
        step = joint_step(asked.arm, j, name, f"{words} {linear.test}", equations, root)
        c, s = math.cos(root), math.sin(root)
        M = C1 @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ C2
        yield _outer(asked, way.then(step).put(j, root), [i, k], (M, B))


def _outer(asked: Asked, way: Way, outer: list[int], parts: tuple[Array, Array]) -> Way:
    """Both outer turns of ``B = Rz(first) M Rz(last)``."""
    M, B = parts
    first, last = (f"theta_{i + 1}" for i in outer)
    lean = [math.atan2(math.hypot(A[0, 2], A[1, 2]), A[2, 2]) for A in (B, M)]
    off = abs(lean[0] - lean[1])
    words = f"B = Rz({first}) M Rz({last}), M known: {first} turns the third column of M onto B's."
    if off > OFF:
        end = (
            f" But the angle between both axes is {shown(math.degrees(off))} deg from the one that "
            "the pose needs: here the solution ends."
        )
        return way.stop(Step(first, words + end))
    given: Given = {
        f"{letter}_{r}{c}": float(matrix[r - 1, c - 1])
        for letter, matrix in (("b", B), ("m", M))
        for r, c in ((1, 3), (2, 3), (3, 1), (3, 2))
    }
    one = math.atan2(B[1, 2], B[0, 2]) - math.atan2(M[1, 2], M[0, 2])
    two = math.atan2(M[2, 1], M[2, 0]) - math.atan2(B[2, 1], B[2, 0])
    formulas = ["atan2(b_23, b_13) - atan2(m_23, m_13)", "atan2(m_32, m_31) - atan2(b_32, b_31)"]
    if math.hypot(M[0, 2], M[1, 2]) <= FREE:
        one = asked.free_value(outer[0])
        c, s = math.cos(one), math.sin(one)
        left = M.T @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ B
        two = math.atan2(left[1, 0], left[0, 0])
        words += " Both axes are in line here: one of the two turns is free."
        formulas = [first, last]
    one, two = (math.remainder(v, math.tau) for v in (one, two))
    steps = [
        joint_step(
            asked.arm,
            outer[0],
            first,
            words,
            [Equation(first, formulas[0], given, one, "rad")],
            one,
        ),
        joint_step(
            asked.arm,
            outer[1],
            last,
            f"The third row gives {last}.",
            [Equation(last, formulas[1], given, two, "rad")],
            two,
        ),
    ]
    return way.then(*steps).put(outer[0], one).put(outer[1], two)


def _slides(asked: Asked, way: Way, turning: list[int]) -> Way:
    """The three slides from three linear equations."""
    arm = asked.arm
    sliding = [i for i in range(arm.n) if i not in turning]
    frames = arm.frames([way.variables.get(i, 0.0) for i in range(arm.n)])
    axes = np.column_stack([frames[i][:3, 2] for i in sliding])
    left = asked.H[:3, 3] - frames[-1][:3, 3]
    values = np.linalg.solve(axes, left)
    sums = " + ".join(
        f"d_{i + 1} {vector_shown(axis)}" for i, axis in zip(sliding, axes.T, strict=True)
    )
    words = (
        "Each slide moves the tool along its axis, all others as they are. What the tool lacks "
        f"when all slides are at d = 0 is the sum: {sums} = {vector_shown(left)}."
    )
    for i, value in zip(sliding, values.tolist(), strict=True):
        name = f"d_{i + 1}"
        equation = Equation(name, name, {}, value, "m")
        way = way.then(joint_step(arm, i, name, words, [equation], value)).put(i, value)
        words = "From the same three equations."
    return way
