"""Rigid transforms: a pose in twelve scalars, a joint and a link after it, points, inverses."""

from dh2urdf.kernels.numbers import entry, few_turns, sincos
from dh2urdf.kernels.shapes import Poses


def _slid(a, b, c, d, q):
    """One row of ``R Trans_z(q)``."""
    return a, b, c, d + c * q


def _turned(a, b, c, d, cosine, sine):
    """One row of ``R Rot_z``."""
    return a * cosine + b * sine, b * cosine - a * sine, c, d


def times_joint(r, slides, q):
    """``R Z(q)`` of a pose held in twelve scalars (rows of the 3 x 4 matrix)."""
    a0, b0, c0, d0, a1, b1, c1, d1, a2, b2, c2, d2 = r
    if slides:
        return *_slid(a0, b0, c0, d0, q), *_slid(a1, b1, c1, d1, q), *_slid(a2, b2, c2, d2, q)
    s, c = sincos(few_turns(q))
    first, second = _turned(a0, b0, c0, d0, c, s), _turned(a1, b1, c1, d1, c, s)
    return *first, *second, *_turned(a2, b2, c2, d2, c, s)


def _row_times_link(a, b, c, d, link):
    """One row of ``R link``."""
    return (
        a * link[0, 0] + b * link[1, 0] + c * link[2, 0],
        a * link[0, 1] + b * link[1, 1] + c * link[2, 1],
        a * link[0, 2] + b * link[1, 2] + c * link[2, 2],
        a * link[0, 3] + b * link[1, 3] + c * link[2, 3] + d,
    )


def times_link(r, link):
    """``R link`` of a pose held in twelve scalars."""
    first = _row_times_link(r[0], r[1], r[2], r[3], link)
    second = _row_times_link(r[4], r[5], r[6], r[7], link)
    return *first, *second, *_row_times_link(r[8], r[9], r[10], r[11], link)


def joint_times_link(r, slides, q, link):
    """``R Z(q) link`` of a pose held in twelve scalars."""
    return times_link(times_joint(r, slides, q), link)


def load_pose(link):
    """The twelve scalars of a pose."""
    x, y, z = link[0], link[1], link[2]
    return x[0], x[1], x[2], x[3], y[0], y[1], y[2], y[3], z[0], z[1], z[2], z[3]


def store_pose(r, T):
    """Write twelve scalars as a homogeneous matrix."""
    T[0, 0], T[0, 1], T[0, 2], T[0, 3] = r[0], r[1], r[2], r[3]
    T[1, 0], T[1, 1], T[1, 2], T[1, 3] = r[4], r[5], r[6], r[7]
    T[2, 0], T[2, 1], T[2, 2], T[2, 3] = r[8], r[9], r[10], r[11]
    T[3, 0], T[3, 1], T[3, 2], T[3, 3] = 0.0, 0.0, 0.0, 1.0


def inverse_pose(A):
    """The twelve scalars of ``A^-1`` for a rigid pose (4, 4)."""
    x, y, z = applied_inverse(A, (0.0, 0.0, 0.0))
    a, b, c = A[0], A[1], A[2]
    return a[0], b[0], c[0], x, a[1], b[1], c[1], y, a[2], b[2], c[2], z


def invert_pose(T, out):
    """``out = T^-1`` for a rigid pose (4, 4)."""
    store_pose(inverse_pose(T), out)


@entry()
def invert_poses(Ts: Poses, out: Poses):
    """``out[i] = Ts[i]^-1`` for rigid poses (m, 4, 4)."""
    for i in range(Ts.shape[0]):
        invert_pose(Ts[i], out[i])


def applied(A, v):
    """The point ``A v``."""
    x, y, z = turned(A, v)
    return x + A[0, 3], y + A[1, 3], z + A[2, 3]


def applied_inverse(A, v):
    """The point ``A^-1 v``."""
    return turned_back(A, minus(v, (A[0, 3], A[1, 3], A[2, 3])))


def dot(v, w):
    """Scalar product."""
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2]


def cross(v, w):
    """Vector product."""
    return v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]


def minus(v, w):
    """Difference."""
    return v[0] - w[0], v[1] - w[1], v[2] - w[2]


def turned(A, v):
    """The direction ``A v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[0, 1] * y + A[0, 2] * z,
        A[1, 0] * x + A[1, 1] * y + A[1, 2] * z,
        A[2, 0] * x + A[2, 1] * y + A[2, 2] * z,
    )


def turned_back(A, v):
    """The direction ``A^-1 v``."""
    x, y, z = v
    return (
        A[0, 0] * x + A[1, 0] * y + A[2, 0] * z,
        A[0, 1] * x + A[1, 1] * y + A[2, 1] * z,
        A[0, 2] * x + A[1, 2] * y + A[2, 2] * z,
    )
