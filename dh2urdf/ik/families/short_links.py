"""The same chain with the joints' origins slid along their axes, so that its links are short."""

import numpy as np

from dh2urdf.ik.arm import IntArray
from dh2urdf.kernels.numbers import sincos
from dh2urdf.transforms import Array, product

GRID = 2.0**-24
"""What shifts of frames are rounded to, in parts of the longest link: no library decides bits."""

ALONG = 1e-3
"""What slid origins must bring, in parts of how far they are slid: the common normal of axes that
are parallel but for rounding is kilometres out, and lengths there have fewer digits."""


def screw(angle: float, offset: float) -> Array:
    """A screw about z: a turn [rad], then a shift [m] along it."""
    s, c = sincos(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, offset], [0, 0, 0, 1.0]])


def short_links(links: Array, slides: Array, turns: Array) -> tuple[Array, Array]:
    """The same chain with each joint's origin slid along its axis, so that the links are short.

    Minimises ``sum |t_i - b_i + R_i a_(i+1)|^2`` over ``a_i = b_i = s_i e3`` of joints that turn;
    a joint that slides may be anywhere: only along its axis do a_i and b_i differ. Joints that
    turn have their zeros at ``turns`` [rad]. Returns the links and the differences, the slides'
    zeros [m].
    """
    # of each joint: which unknowns, along which axes, before it and after it
    places: list[tuple[IntArray, IntArray, Array]] = []
    free, n = 0, len(slides)
    for joint_slides in slides.tolist():
        first, last = ([0, 1, 2], [0, 1, 3]) if joint_slides else ([0], [0])
        axes = np.eye(3) if joint_slides else np.eye(3)[2:]
        places.append((free + np.array(first), free + np.array(last), axes.T))
        free += 4 if joint_slides else 1
    matrix, rhs = np.zeros((3 * n - 3, free)), np.zeros(3 * n - 3)
    for i in range(1, n):
        rows = slice(3 * i - 3, 3 * i)
        matrix[rows, places[i - 1][1]] = -places[i - 1][2]
        matrix[rows, places[i][0]] = product(links[i, :3, :3], places[i][2])
        rhs[rows] = -links[i, :3, 3]
    grid = GRID * (np.abs(links[:, :3, 3]).max() or 1.0)
    ways = np.round(np.linalg.lstsq(matrix, rhs, rcond=ALONG)[0] / grid) * grid
    short, ends = links.copy(), np.zeros((2, n, 3))
    for i, (before, after, axes) in enumerate(places):
        for end, some in zip(ends, (before, after), strict=True):
            end[i] = product(axes, ways[some][:, None])[:, 0]
    turned = np.stack(
        [screw(0.0 if s else turn, 0.0) for s, turn in zip(slides, turns, strict=True)]
    )
    short[1:, :3, 3] -= ends[1]
    short[1:] = product(turned, short[1:])
    short[:-1, :3, 3] = (
        product(short[:-1, :3, :3], ends[0][:, :, None])[:, :, 0] + short[:-1, :3, 3]
    )
    return short, ends[0, :, 2] - ends[1, :, 2]
