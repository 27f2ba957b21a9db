"""The arrays that the general 6R solver works in, allocated once for any number of poses."""

from __future__ import annotations

import numpy as np

from dh2urdf.kernels.arc_roots import SPANS, STACK, TERMS
from dh2urdf.kernels.lanes import COLUMN, LANES, vector_kernel

__all__ = ["make_work_6r"]


@vector_kernel
def make_work_6r():
    """Work arrays for `solve_general_6r`; each thread needs its own."""
    return (
        np.zeros(12),  # 0 target seen from inside the arm
        np.zeros(12),  # 1 target
        np.zeros((6, 12)),  # 2 closed loop
        np.zeros((14, 27)),  # 3 samples of the fourteen functions
        np.zeros((14, 27)),  # 4 left side
        np.zeros((9, 14)),  # 5 right side and its reflectors
        np.zeros((14, 14)),  # 6 its orthogonal basis
        np.zeros((6, 27)),  # 7 six equations
        np.zeros(16),  # 8 reflectors' factors
        np.zeros(9 * COLUMN),  # 9 lanes of 6 x 9 matrices
        np.zeros(6 * COLUMN),  # 10 lanes of 6 x 6 matrices
        np.zeros(COLUMN),  # 11 reflector
        np.zeros(LANES),  # 12 its factor
        np.zeros(LANES),  # 13 determinants
        np.zeros(LANES),  # 14 series
        np.zeros((TERMS, LANES)),  # 15 series turned to each arc
        np.zeros((TERMS, LANES)),  # 16 Bernstein coefficients of the arcs
        np.zeros((STACK, TERMS + 2)),  # 17 arcs being halved
        np.zeros(LANES),  # 18 de Casteljau
        np.zeros(LANES),  # 19 roots
        np.zeros((2, SPANS + 1)),  # 20 spans of doubt
        np.zeros(LANES),  # 21 slopes at the roots
        np.zeros(COLUMN),  # 22 null vectors
        np.zeros(COLUMN),  # 23 second null vectors
        np.zeros(COLUMN),  # 24 cosines, loop order
        np.zeros(COLUMN),  # 25 sines, loop order
        np.zeros(COLUMN),  # 26 cosines of the joints
        np.zeros(COLUMN),  # 27 sines of the joints
        np.zeros(7 * 12 * LANES),  # 28 frames
        np.zeros(14 * LANES),  # 29 the fourteen functions
        np.zeros(4 * LANES),  # 30 joints 1 and 2 of the loop
        np.zeros(LANES),  # 31 hidden joint
        np.zeros(LANES),  # 32
        np.zeros(LANES),  # 33 joint 4 of the loop
        np.zeros(LANES),  # 34
        np.zeros(LANES),  # 35 joint 5 of the loop
        np.zeros(LANES),  # 36
        np.zeros(COLUMN),  # 37 pose error
        np.zeros(LANES),  # 38 its position
        np.zeros(LANES),  # 39 its angle
        np.zeros(LANES),  # 40 the error before
        np.zeros((2, SPANS + 1)),  # 41 spans of doubt in a window
        np.zeros(LANES),  # 42 determinants of the solutions' Jacobians
    )
