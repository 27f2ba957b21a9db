"""Ways through a worked solution: at each choice (shoulder, elbow, wrist) they part."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from dh2urdf.lessons.arm import Arm, wrapped
from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.steps import Equation, Mark, Step
from dh2urdf.transforms import Array

RIM = 1e-9
"""Relative amount by which an equation may miss its rim before it has no solution: rounding of the
pose, which may also be one of the arm's own on the rim."""


MERGED = 1e-14
"""Relative distance from its rim at which an equation has one root instead of two: rounding would
part them by 1e-7."""


@dataclass(frozen=True)
class Way:
    """The steps so far, the DH variables found, by joint from 0; whether a step has no solution."""

    steps: tuple[Step, ...] = ()
    variables: Mapping[int, float] = field(default_factory=dict)
    stopped: bool = False

    def then(self, *steps: Step) -> "Way":
        """The way with more steps."""
        return replace(self, steps=(*self.steps, *steps))

    def put(self, joint: int, variable: float) -> "Way":
        """The way with one more joint found."""
        return replace(self, variables={**self.variables, joint: variable})

    def stop(self, step: Step) -> "Way":
        """The way that ends in a step without a solution."""
        return replace(self, steps=(*self.steps, step), stopped=True)

    def saying(self, words: str) -> "Way":
        """The way with more words in its last step."""
        last = self.steps[-1]
        return replace(self, steps=(*self.steps[:-1], replace(last, words=last.words + words)))

    def first(self, count: int) -> list[float]:
        """The first so many DH variables."""
        return [self.variables[i] for i in range(count)]


@dataclass(frozen=True)
class Asked:
    """What is to be explained: an arm, the pose of its last frame, and where free joints are put.

    ``H`` is ``H_n^0``; ``guide`` the solution (n,) whose values free joints take, None: zeros.
    """

    arm: Arm
    H: Array
    guide: Array | None = None

    def free_value(self, joint: int) -> float:
        """The DH variable that a free joint is put to."""
        return self.arm.variable(joint, 0.0 if self.guide is None else float(self.guide[joint]))


def joint_step(
    arm: Arm,
    joint: int,
    title: str,
    words: str,
    equations: list[Equation],
    variable: float,
    marks: tuple[Mark, ...] = (),
    choice: str = "",
    curve: Curve | None = None,
) -> Step:
    """A step that finds a DH variable, whose last equation is the joint's value q."""
    row, i = arm.rows[joint], joint + 1
    q = arm.joint_value(joint, variable)
    name, unit = (f"d_{i}", "m") if row.slides else (f"theta_{i}", "rad")
    constant = row.d if row.slides else row.theta
    own = [*equations]
    if row.sign < 0 or constant:
        zero = f"{name[: -len(str(i))]}0{i}"
        formula = f"{name} - {zero}" if row.sign > 0 else f"{zero} - {name}"
        formula = formula if constant else f"-{name}"
        own.append(Equation(f"q_{i}", formula, {name: variable, zero: constant}, q, unit))
        if constant:
            words += f" Row {i} of the table says {name} = {'-' * (row.sign < 0)}q_{i} + {zero}."
    return Step(title, words, tuple(own), joint, marks, choice, curve)


def opposite(angle: float) -> float:
    """The angle half a turn on, in (-pi, pi]."""
    return wrapped(angle + np.pi)
