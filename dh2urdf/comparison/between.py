"""Two arms compared: the entry."""

import math
from typing import Any

import numpy as np

from dh2urdf.comparison.arms import Arm, arm_of
from dh2urdf.comparison.coupled import coupled_otherwise, uncoupled
from dh2urdf.comparison.diagnose import diagnose
from dh2urdf.comparison.relate import Related, allowed, relate
from dh2urdf.comparison.relation import CONFIGURATIONS, Relation
from dh2urdf.comparison.result import Comparison, in_words
from dh2urdf.conversions.chains import configurations
from dh2urdf.dh import Origin
from dh2urdf.doors import number

TOLERANCE = 1e-6
"""Difference [m and rad] up to which arms are the same: 1.5708 for pi/2 is more, the roundings of
files with seven digits are less."""

TOLERANCES = (1e-12, 0.1)


def compare(
    a: Any, b: Any, *, base: str | None = None, tip: str | None = None, tolerance: float = TOLERANCE
) -> Comparison:
    """Whether two arms are the same, up to what, and where they differ.

    Arms are the same if base, tool, zeros and directions of the joints of B can be chosen so that
    both tools stand at the same pose for every q, which moves joints that follow or are coupled
    along. Limits and masses are not looked at.

    Parameters
    ----------
    a, b : DHTable, path, str, Robot or SerialChain
        A table, its file or the name of one that ships; a URDF, xacro or MJCF file. A is the one
        that is taken for right: what is told of rows is told of its rows.
    base, tip : str, optional
        Links between which the arms of robot descriptions lie; where A and B have other names for
        them, `Robot.from_urdf` takes each.
    tolerance : float
        Largest difference [m and rad] of arms that are the same.

    Returns
    -------
    Comparison

    Raises
    ------
    ArgumentError, TableError, UrdfError, NameNotFoundError

    Examples
    --------
    >>> from dh2urdf import compare, load_table, to_convention
    >>> compare("puma560", to_convention(load_table("puma560"), "modified")).same
    True
    >>> compare("ur5", "ur5e").same
    False
    """
    tolerance = number(tolerance, "tolerance", *TOLERANCES)
    return compared(arm_of(a, base, tip), arm_of(b, base, tip), tolerance)


def compared(a: Arm, b: Arm, tolerance: float) -> Comparison:
    """:func:`compare` of arms."""
    related = _related(a, b, tolerance)
    relation, error = related
    agree = error <= allowed(a.chain, b.chain, tolerance)
    coupled = coupled_otherwise(a.table, b.table, relation, tolerance)
    same = agree and not coupled
    told: dict[str, Any] = dict.fromkeys(("base", "tool", "offsets", "directions"))
    if coupled:
        relation, error = None, math.inf
    if relation is not None:
        told = {
            "base": Origin.from_matrix(relation.base),
            "tool": Origin.from_matrix(relation.tool),
            "offsets": tuple(relation.offsets.tolist()),
            "directions": tuple(int(s) for s in relation.directions),
        }
    up_to = in_words(a.chain.prismatic, tolerance, **told) if relation else ()
    bare_a, bare_b = (arm._replace(table=uncoupled(arm.table)) for arm in (a, b))
    found = () if agree and not up_to else diagnose(bare_a, bare_b, tolerance, same=agree)
    mistakes, differences = found or ((), ())
    return Comparison(
        a.name,
        b.name,
        same,
        up_to,
        **told,
        max_error=error,
        mistakes=mistakes,
        differences=(*coupled, *differences),
        configurations=CONFIGURATIONS,
        tolerance=tolerance,
        warnings=(*a.warnings, *b.warnings),
    )


def _related(a: Arm, b: Arm, tolerance: float) -> Related:
    """The relation of least words; a base or tool that tables say is other weighs little."""
    if not np.array_equal(a.chain.prismatic, b.chain.prismatic):
        return Related(None, math.inf)
    written = a.written and b.written
    weights = [
        0.5 if written and one != other else 2.0
        for one, other in ((a.table.base, b.table.base), (a.table.tool, b.table.tool))
    ]

    def cost(relation: Relation) -> float:
        return relation.cost(tolerance, *weights)

    qs = configurations(a.chain, CONFIGURATIONS, max(a.chain.size, b.chain.size))
    return relate(a.chain, b.chain, qs, tolerance, cost)
