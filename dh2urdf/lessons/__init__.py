"""Inverse kinematics as a worked solution: each step with its formula, numbers, value and reason.

A derivation of its own, in plain Python on the table's letters, that shares nothing with the
kernels. `notation` writes formulas, `equation`, `steps`, `wording` what is said, `curve` and
`marks` what is drawn; `arm` has the rows, `way` the choices on the way. Then the families:
`planar` with `planar_elbows`; `spherical_wrist` with `position*`, `seen` and `wrist`;
`three_parallel` with `parallel_*`; `few_joints`, `one_joint`, `three_slides`; for any one
to five joints `closed_loop` with `short_loop`; without a closed form `two_parallel` and
`elimination`. `case` picks one, `controller` turns joints into what a controller shows, `worked` is
the entry.
"""

from dh2urdf.lessons.case import Question, Values
from dh2urdf.lessons.curve import Curve
from dh2urdf.lessons.steps import Equation, IKExplanation, Mark, Step
from dh2urdf.lessons.worked import explain_pose

__all__ = [
    "Curve",
    "Equation",
    "IKExplanation",
    "Mark",
    "Question",
    "Step",
    "Values",
    "explain_pose",
]
