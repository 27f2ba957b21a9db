"""Points and directions carried by poses, and along the first three joints of an arm."""

from __future__ import annotations

import math

from dh2urdf.kernels.numbers import helper_kernel, inner_kernel

__all__ = ["after_joint", "after_link", "applied", "applied_inverse", "turned_back"]
__all__ += ["wrist_circle", "wrist_in_three"]


@helper_kernel
def applied(A, v):
    """The point ``A v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[0, 1] * y + A[0, 2] * z + A[0, 3],
        A[1, 0] * x + A[1, 1] * y + A[1, 2] * z + A[1, 3],
        A[2, 0] * x + A[2, 1] * y + A[2, 2] * z + A[2, 3],
    )


@helper_kernel
def applied_inverse(A, v):
    """The point ``A^-1 v``."""
    return turned_back(A, (v[0] - A[0, 3], v[1] - A[1, 3], v[2] - A[2, 3]))


@helper_kernel
def turned_back(A, v):
    """The direction ``A^-1 v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[1, 0] * y + A[2, 0] * z,
        A[0, 1] * x + A[1, 1] * y + A[2, 1] * z,
        A[0, 2] * x + A[1, 2] * y + A[2, 2] * z,
    )


@inner_kernel
def after_link(form, i, x, y, z, point):
    """``Trans_x(a_i) Rot_x(alpha_i)`` of a point (1.0) or a direction (0.0)."""
    ca, sa = form[i, 1], form[i, 2]
    return x + point * form[i, 0], ca * y - sa * z, sa * y + ca * z


@inner_kernel
def after_joint(form, i, x, y, z, point):
    """A fixed angle theta_i and, for a point of a turning joint, its offset d_i."""
    c, s = math.cos(form[i, 4]), math.sin(form[i, 4])
    lift = 0.0 if form[i, 5] != 0.0 else point * form[i, 3]
    return c * x - s * y, s * x + c * y, z + lift


@inner_kernel
def wrist_in_three(form):
    """The wrist centre before joint 3 turns or slides; turned by theta_3 if it slides."""
    x, y, z = after_link(form, 2, 0.0, 0.0, form[3, 3], 1.0)
    if form[2, 5] != 0.0:
        x, y, z = after_joint(form, 2, x, y, z, 1.0)
    else:
        z += form[2, 3]
    return x, y, z


@inner_kernel
def wrist_circle(form, steps):
    """The circle of the wrist centre about axis 3: its centre, and what cos q3 and sin q3 carry.

    Seen after ``steps`` of: link 2, joint 2 (as far as it does not move), link 1.
    """
    x, y, z = wrist_in_three(form)
    centre, cosine, sine = (0.0, 0.0, z), (x, y, 0.0), (-y, x, 0.0)
    centre = after_link(form, 1, *centre, 1.0)
    cosine, sine = after_link(form, 1, *cosine, 0.0), after_link(form, 1, *sine, 0.0)
    if steps > 1:
        centre = after_joint(form, 1, *centre, 1.0)
        cosine, sine = after_joint(form, 1, *cosine, 0.0), after_joint(form, 1, *sine, 0.0)
    if steps > 2:
        centre = after_link(form, 0, *centre, 1.0)
        cosine, sine = after_link(form, 0, *cosine, 0.0), after_link(form, 0, *sine, 0.0)
    return centre, cosine, sine
