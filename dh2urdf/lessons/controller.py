"""From the joints that a derivation finds to the values that a controller shows."""

import numpy as np

from dh2urdf.lessons.case import Question
from dh2urdf.lessons.steps import Equation, Step
from dh2urdf.transforms import Array


def controllers_values(question: Question, joints: Array) -> tuple[Array, Step]:
    """The values v of joints (n,), and the step that finds them.

    Joint i is at ``q_i = v_i + k_ij v_j + ...``, and so ``v_i = q_i - k_ij v_j - ...``.
    """
    assert question.values is not None
    coupling, slides = question.values.coupling, question.chain.prismatic
    values = coupling.values(joints)
    equations = []
    for i, ratios in enumerate(coupling.matrix):
        others = [j for j in np.flatnonzero(ratios).tolist() if j != i]
        if not others:
            continue
        formula, given = f"q_{i + 1}", {f"q_{i + 1}": float(joints[i])}
        for j in others:
            ratio, name = float(ratios[j]), f"v_{j + 1}"
            given[name] = float(values[j])
            letter = "" if abs(ratio) == 1 else f"k_{i + 1}{j + 1} "
            if letter:
                given[letter.strip()] = abs(ratio)
            formula += f" {'-' if ratio > 0 else '+'} {letter}{name}"
        unit = "m" if slides[i] else "rad"
        equations.append(Equation(f"v_{i + 1}", formula, given, float(values[i]), unit))
    names = " and ".join(coupling.names[int(e.name[2:]) - 1] for e in equations)
    words = (
        f"So far q_i is the angle or length of joint i itself. The controller counts {names} "
        "otherwise: what it shows is called v_i here; of the other joints the two are the same."
    )
    return values, Step("The values of the controller", words, tuple(equations))
