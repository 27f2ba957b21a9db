"""A redundant joint at many values: solutions of all values of a pose in one list."""

from dh2urdf.kernels.numbers import kernel


@kernel
def gather_samples(found, first, last, samples, q, residual, count, branch, free):
    """Join the solutions of the samples of a pose, rows in the order of the values.

    ``found`` are the five arrays of a solver for (last - first) samples poses; the others are
    the caller's, with room for all, see :class:`dh2urdf.ik.arm.solver.Solver`.
    """
    some_q, some_residual, some_count, some_branch, some_free = found
    for i in range(first, last):
        total = 0
        for k in range(samples):
            row = (i - first) * samples + k
            for r in range(some_count[row]):
                q[i, total], residual[i, total] = some_q[row, r], some_residual[row, r]
                branch[i, total], free[i, total] = some_branch[row, r], some_free[row, r]
                total += 1
        count[i] = total
