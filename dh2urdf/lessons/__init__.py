"""Inverse kinematics as a worked solution: each step with its formula, numbers, value and reason.

A derivation of its own, in plain Python on the table's letters, that shares nothing with the
kernels: `notation` writes formulas, `steps` holds what is said, `arm` the rows, `way` the choices
on the way; then a module a family, and `worked` the entry.
"""

from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.steps import Equation, IKExplanation, Mark, Step
from dh2urdf.lessons.worked import Question, explain_pose

__all__ = ["Curve", "Equation", "IKExplanation", "Mark", "Question", "Step", "explain_pose"]
