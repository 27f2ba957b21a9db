"""What arms without a closed form have in common: a polynomial's root, and the way back from it."""

import math

from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.equation import Equation
from dh2urdf.lessons.notation import measured
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked, Way

BLUNT = 1e-7
"""Distance [rad] of a root from the joint's own value at which roots have met."""


def led_by(asked: Asked, way: Way, joint: int, words: str, curve: Curve) -> Way:
    """The step that finds a joint as a root of a polynomial, the one of the solution explained."""
    count, name = len(curve.roots), f"q_{joint + 1}"
    said = f"{words}It has {count or 'no'} real root{'' if count == 1 else 's'}"
    if asked.guide is None:
        end = ", but none of them leads to a solution" if count else ": here the solution ends"
        return way.stop(Step(name, f"{said}{end}.", curve=curve))
    goal = float(asked.guide[joint])
    near = sorted(curve.roots, key=lambda x: abs(math.remainder(x - goal, math.tau)))
    root = near[0] if count else goal
    equation = Equation(name, name, {}, root, "rad", tuple(near[1:]))
    itself = f": the joint itself is at {measured(goal, 'rad')}."
    if not count:
        said = (
            f"{words}Its real roots meet in pairs here, and rounding takes all of them off the "
            f"real line{itself}"
        )
    else:
        said += (
            "; several solutions may share one, and one that solves only the product leads to "
            "none. Here take the one of the solution that is explained."
        )
    if count and abs(math.remainder(root - goal, math.tau)) > BLUNT:
        said += f" Roots meet here, of which rounding leaves fewer digits or none{itself}"
    step = Step(f"{name}: a root of the polynomial", said, (equation,), joint, curve=curve)
    return way.then(step).put(joint, asked.arm.variable(joint, goal))


def back(asked: Asked, way: Way, words: str) -> Way:
    """The other joints, which follow by going back through what was eliminated."""
    assert asked.guide is not None
    rest = [i for i in range(asked.arm.n) if i not in way.variables]
    equations = [
        Equation(f"q_{i + 1}", f"q_{i + 1}", {}, float(asked.guide[i]), "rad") for i in rest
    ]
    for i in rest:
        way = way.put(i, asked.arm.variable(i, float(asked.guide[i])))
    words += " A step or two of Newton's method on the whole arm make the digits sharp."
    return way.then(Step("The other joints", words, tuple(equations)))
