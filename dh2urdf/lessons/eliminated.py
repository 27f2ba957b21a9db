"""What arms without a closed form have in common: a polynomial's root, and the way back from it."""

import math

import numpy as np

from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.equation import Equation
from dh2urdf.lessons.steps import Step
from dh2urdf.lessons.way import Asked, Way


def led_by(asked: Asked, way: Way, joint: int, words: str, curve: Curve) -> Way:
    """The step that finds a joint as a root of a polynomial, the one of the solution explained."""
    count, name = len(curve.roots), f"q_{joint + 1}"
    said = f"{words}It has {count or 'no'} real root{'' if count == 1 else 's'}"
    if not count:
        return way.stop(Step(name, f"{said}: here the solution ends.", curve=curve))
    if asked.guide is None:
        words = f"{said}, but none of them leads to a solution."
        return way.stop(Step(name, words, curve=curve))
    goal = float(asked.guide[joint])
    apart = [abs(math.remainder(x - goal, math.tau)) for x in curve.roots]
    best = int(np.argmin(apart))
    root = curve.roots[best]
    others = tuple(x for k, x in enumerate(curve.roots) if k != best)
    equation = Equation(name, name, {}, root, "rad", others)
    said += (
        "; several solutions may share one, and one that solves only the product leads to none. "
        "Here take the one of the solution that is explained."
    )
    step = Step(f"{name}: a root of the polynomial", said, (equation,), joint, curve=curve)
    return way.then(step).put(joint, asked.arm.variable(joint, root))


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
