"""An arm with three parallel axes, seen from the plane in which they turn."""

from dh2urdf.kernels.chain import turned, turned_back
from dh2urdf.kernels.numbers import hypot, sincos
from dh2urdf.kernels.spherical_wrist import NICE


def seen_from_plane(form, first, c1, s1, x, y, z):
    """A vector of frame 0 in the frame of the parallel axes, which joint 1 turns or not."""
    if first == 0:
        return x, y, z
    x, y = c1 * x + s1 * y, c1 * y - s1 * x
    ca, sa = form[0, 1], form[0, 2]
    return x, ca * y + sa * z, ca * z - sa * y


def _to_frame_six(form, last, cs, x, z, origin):
    """The vector (x, 0, z) of the frame after the last parallel axis, seen in frame 6.

    ``origin`` 1.0: and on to frame 6's origin; 0.0: a direction.
    """
    y = 0.0
    for i in range(last + 1, 6):
        ca, sa = form[i - 1, 1], form[i - 1, 2]
        y, z = ca * y + sa * z, ca * z - sa * y
        c, s = cs[i, 0], cs[i, 1]
        x, y = c * x + s * y, c * y - s * x
        x += origin * form[i, 0]
        z += origin * form[i, 3]
    return x, y, z


def seen_arm(form, first, D, cs, origin):
    """The way from the last parallel axis to frame 6 (1.0), or that link's direction (0.0).

    Seen in the plane of the parallel axes.
    """
    x = form[first + 2, 0] if origin != 0.0 else 1.0
    x, y, z = _to_frame_six(form, first + 2, cs, x, 0.0, origin)
    u, v, w = turned(D, (x, y, z))
    return seen_from_plane(form, first, cs[0, 0], cs[0, 1], u, v, w)


def common_axis(form, first, D, cs):
    """The direction k of the parallel axes, seen in frame 6: ``k^T R``."""
    kx, ky, kz = 0.0, 0.0, 1.0
    if first == 1:
        kx, ky, kz = form[0, 2] * cs[0, 1], -form[0, 2] * cs[0, 0], form[0, 1]
    return turned_back(D, (kx, ky, kz))


def last_joint(form, first, D, cs):
    """Cosine and sine of t6 into cs: subproblem 1; the sine of axis 6 to the parallel axes.

    It turns their direction as it is before joint 6 to where the pose has it.
    """
    rx, ry, _ = common_axis(form, first, D, cs)
    cs[5, 0], cs[5, 1] = 1.0, 0.0
    x, y, _ = _to_frame_six(form, first + 2, cs, 0.0, 1.0, 0.0)
    in_line = hypot(rx, ry)
    c6, s6 = x * rx + y * ry, y * rx - x * ry
    r = hypot(c6, s6)
    if in_line <= NICE or r == 0.0:
        cs[5, 0], cs[5, 1] = sincos(form[5, 4])[1], sincos(form[5, 4])[0]
    else:
        cs[5, 0], cs[5, 1] = c6 / r, s6 / r
    return in_line
