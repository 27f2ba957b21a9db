"""Three angles of an orientation: the second half of decoupling, ZYZ angles where axes are square.

``N = Rz(theta_4) Rx(alpha_4) Rz(theta_5) Rx(alpha_5) Rz(theta_6)`` with m its third column. Lecture
notes 8.3; Spong, Hutchinson and Vidyasagar, section 2.5.1.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from dh2urdf.symbolic.formulas import Formulas, gathered
from dh2urdf.symbolic.letters import Link

LONG = 50
"""Operations in a matrix from which on its entries get names of their own."""


def rotation(F: Formulas, links: Sequence[Link]) -> Any:
    """``R_k^0`` of links whose joints are known; angles about parallel axes are added."""
    R, k = sp.eye(3), 0
    while k < len(links):
        together = [links[k]]
        while together[-1].ca == 1 and not together[-1].slides and k + 1 < len(links):
            if links[k + 1].slides:
                break
            k += 1
            together.append(links[k])
        R *= added(F, together).rotation
        k += 1
    return R


def added(F: Formulas, links: Sequence[Link]) -> Link:
    """Links with parallel axes as one, turned by the sum of their angles."""
    if len(links) == 1:
        return links[0]
    label = "".join(link.label for link in links)
    total = sum(sp.Symbol(f"theta_{link.label}") for link in links)
    for letter, function in (("c", sp.cos), ("s", sp.sin)):
        F.let(f"{letter}_{label}", function(total, evaluate=False))
    c, s = sp.Symbol(f"c_{label}"), links[-1].way * sp.Symbol(f"s_{label}")
    return replace(links[-1], label=label, c=c, s=s)


def orient(F: Formulas, links: Sequence[Link], before: Any, after: Any) -> None:
    """Add the steps that find three angles whose axes are not parallel.

    ``before`` is the orientation of the links before them, ``after`` that of the third without
    its twist: ``N = before^T after``.
    """
    first, second, third = links
    before = _named(F, "b", before)
    N = before.T * after
    m = [F.let(f"m_{axis}", gathered(N[i, 2])) for i, axis in enumerate("xyz")]
    if first.ca == second.ca == 0:
        sigma = F.choice(f"sigma_{second.label}")
        sine = sigma * sp.sqrt(m[0] ** 2 + m[1] ** 2)
        F.angle(second, sp.atan2(sine, -first.sa * second.sa * m[2]))
        F.angle(first, sp.atan2(second.sa * sigma * m[1], second.sa * sigma * m[0]))
    else:
        F.turn(second, -first.sa * second.sa, sp.S.Zero, m[2] - first.ca * second.ca)
        x, y, _ = (first.twist * second.rotation)[:, 2]
        F.point(first, x, y, m[0], m[1])
    across = before * _named(F, "h", (first.rotation * second.rotation)[:, 1])
    v = [F.let(f"v_{axis}", gathered(across[i])) for i, axis in enumerate("xyz")]
    sine, cosine = (sp.Matrix(v).dot(after[:, i]) for i in range(2))
    F.angle(third, sp.atan2(sine, cosine))


def _named(F: Formulas, letter: str, matrix: Any) -> Any:
    """A matrix whose entries have names ``b_ij`` where they are long."""
    if sp.count_ops(matrix) <= LONG:
        return matrix
    return sp.Matrix(
        *matrix.shape, lambda i, j: F.let(f"{letter}_{i + 1}{j + 1}", gathered(matrix[i, j]))
    )
