"""Points and directions carried by poses."""

from dh2urdf.kernels.numbers import helper_kernel


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
