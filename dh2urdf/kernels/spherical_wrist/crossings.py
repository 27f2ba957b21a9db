"""Where families cross: joint 1 or 2 is free, and at one of its angles axis 4 lines up with axis 6.

There joints 4 and 6 are free, too: a family of its own, of which the other one has one member.
"""

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, add_step, look_at_some
from dh2urdf.kernels.newton import make_damped, pose_residual
from dh2urdf.kernels.numbers import atan2, sincos

IN_LINE = 1e-6
"""Sine of the angle between axes 4 and 6 from which Newton's method lines them up."""

FIRST_FOUR = 0b001111
"""Joints that do so: with axes 4 and 6 in line, joint 6 turns as joint 4."""

STEPS, FLOOR, MOST = 8, 1e-10, 0.1
"""Its steps, the smallest singular value relative to the largest, and the longest step."""

ALONG = 1e-6
"""Squared sine of the angle between the free axis and axis 4 below which that hardly moves."""


def turn_in_line(form, values, joint, R, side):
    """How far joint 1 or 2 turns until axis 4 is along (``side`` 1) or against (-1) axis 6.

    R (3, 3) is the orientation of frame 6 in frame 3. 0 where axis 4 hardly moves.
    """
    x, y, z = 0.0, form[joint, 2], form[joint, 1]
    for i in range(joint + 1, 3):
        s, c = sincos(form[i, 4] if form[i, 5] != 0.0 else values[i])
        x, y = c * x + s * y, c * y - s * x
        y, z = form[i, 1] * y + form[i, 2] * z, form[i, 1] * z - form[i, 2] * y
    if x * x + y * y < ALONG:
        return 0.0
    wx, wy = R[0, 2], R[1, 2]
    along = x * wx + y * wy + z * R[2, 2]
    sine, cosine = side * (y * wx - x * wy), side * (R[2, 2] - z * along)
    return atan2(sine, cosine)


def line_up(chain, T, q):
    """Bring q (n,) to the pose by joints 1 to 4 alone; the residual left."""
    n = q.shape[0]
    room = make_damped(n), np.empty((n, n)), np.empty(n), np.empty(n)
    for _ in range(STEPS):
        _, largest = look_at_some(chain, T, q, FIRST_FOUR, room)
        add_step(chain, 1.0, q, room, FLOOR * largest, MOST)
    return pose_residual(chain, T, q)


def is_crossing(arm, T, in_line, q):
    """Whether q (6,), whose axes 4 and 6 are about in line, is on a family of joints 4 and 6.

    It is put there.
    """
    chain, form, _, _ = arm
    if in_line > IN_LINE:
        return False
    turned = form[4, 6] * q[4] + form[4, 4]
    s, c = sincos(turned)
    q[4] -= form[4, 6] * atan2(s if c > 0.0 else -s, abs(c))
    return line_up(chain, T, q) <= ACCEPT
