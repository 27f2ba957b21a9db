"""What the general solver knows of an arm, and the arrays that it works in: one record."""

import numpy as np

from dh2urdf.kernels.general_6r.arc_roots import FACTS, FOUND, SPANS, WAITING
from dh2urdf.kernels.general_6r.arc_samples import DEGREE, lanes_of, table_shapes
from dh2urdf.kernels.general_6r.arc_shapes import ROWS, SHAPES
from dh2urdf.kernels.general_6r.brackets import BRACKETS
from dh2urdf.kernels.general_6r.two_slides import PAIRS
from dh2urdf.kernels.numbers import COLUMN, LANES

MOST = 3
"""Eliminations kept."""

OWN = MOST
"""Left side that depends on the pose."""

_INTEGERS = {
    "trials": (),  # number of eliminations
    "choices": (MOST, 2),  # where each cuts the loop, and in which direction
    "ready": (),  # whether their left sides are known
    "slides": 6,  # whether each joint slides
    "loop_slides": 6,  # the same of the closed loop
    "two_slides": (),  # whether two do: then the four turns come first
    "turning": 4,  # of these the labels in the loop, from the hidden one on
    "sliding": 2,  # and of the slides
    "where": 2,  # after which turn each slide is
    "normal": (),  # the turn that is at right angles to both of them, or -1
}

_ARM = {
    "size": (),  # longest of the short links [m]
    "links": (7, 3, 4),  # T_base_tool = links[0] Rz(q1) links[1] ... Rz(q6) links[6]
    "ends": (2, 4, 4),  # inverses of the first and the last of the short links
    "turns": (3, 6),  # cosines and sines of the joints' zeros inside the solver, and the zeros
    "reach": (),  # the length x = 1 of a slide, in parts of the size
    "middles": 6,  # zeros of slides but for what the pose adds to those next to base or tool [m]
    "outer": (6, 2, 3),  # of these the direction, and that of its share of a vector
    "chain": (6, 3, 4),  # short links in between, in parts of the size; then the target
    "lefts": (MOST + 1, 14, 27),  # left sides
}

_WORK = {
    "target": (3, 4),
    "loop": (6, 3, 4),  # closed loop
    "samples": (14, 9),  # of the right side's fourteen functions
    "right": (9, 14),  # right side and its reflectors
    "basis": (14, 14),  # its orthogonal basis
    "factors": 16,  # its reflectors' factors
    "equations": (6, 27),
    "segments": (4, 3, 4),  # what lies between the four turns
    "ways": (2, 3),  # directions of the slides
    "scratch": (3, 4),
    "pairs_of_slides": (PAIRS, LANES),
    "A": 9 * COLUMN,  # lanes of 6 x 9 matrices
    "W": 9 * COLUMN,  # lanes of 6 x 6 matrices
    "V": COLUMN,  # reflector
    "beta": LANES,  # its factor
    "doubles": LANES,  # roots to be tried again as double ones
    "null": COLUMN,  # null vectors
    "second": COLUMN,  # second null vectors
    "loop_cosines": COLUMN,  # of all six
    "loop_sines": COLUMN,
    "cosines": COLUMN,  # of the arm's joints
    "sines": COLUMN,
    "frames": 7 * 12 * LANES,
    "functions": (14, LANES),  # the fourteen functions
    "pairs": 4 * LANES,  # joints 1 and 2 of the loop
    "error": COLUMN,  # of the pose
    "position": LANES,  # its length
    "angle": LANES,
    "before": LANES,  # the error before
    "seeded": LANES,  # the error of the seeds
    "seen": LANES,  # solutions that a root led to
    "q": 6,
    "kept": LANES,  # determinants of the solutions' Jacobians
    "first": 2,  # error of the seeds, spans of doubt in the first trial
}


def root_work(degree):
    """What the roots of a polynomial of a degree are found in, by names."""
    lanes, terms = lanes_of(degree), 2 * degree + 1
    tables = {} if degree == DEGREE else table_shapes(degree)
    return {
        **tables,
        "hidden": (2, lanes),  # cosine and sine of the hidden joint where it is sampled
        "determinant": lanes,
        "series": lanes,
        "turned": (terms, lanes),  # series turned to each arc
        "arcs": (terms + ROWS, lanes),  # Bernstein coefficients of the arcs, and where they are
        "parts": (terms + ROWS, lanes),  # arcs to be cut
        "waiting": (WAITING, terms + ROWS),  # and more of them
        "shapes": (SHAPES, lanes),  # what arcs say
        "facts": (FOUND * degree // 8, FACTS),  # what is found of them
        "row": terms,  # coefficients of one
        "casteljau": lanes,
        "brackets": (BRACKETS, lanes),  # roots that are enclosed
        "scaled": (terms, lanes),  # coefficients of their arcs times binomials
        "roots": lanes,
        "slopes": lanes,  # at the roots
        "hidden_values": lanes,  # of the hidden joint at the solutions
        "spans": (2, SPANS + 1),  # spans of doubt, their number first
        "fresh": (2, SPANS + 1),  # those in a window
    }


def root_order(degree):
    """The same of whole numbers: the order of facts by place, their number last."""
    return {"order": FOUND * degree // 8 + 1}


def record(integers, floats):
    """One record of some fields, by names and shapes."""
    return np.dtype(
        [(name, np.int64, shape) for name, shape in integers.items()]
        + [(name, np.float64, shape) for name, shape in floats.items()],
        align=True,
    )


WORK = _WORK | root_work(DEGREE)
"""Fields that hold nothing from one pose to the next."""

ARM_6R = record({**_INTEGERS, **root_order(DEGREE)}, {**_ARM, **WORK})
"""The record; while one is in use, another thread needs a copy."""
