"""A redundant joint at many values: solutions of all values of a pose in one list."""

from dh2urdf.kernels.numbers import kernel


@kernel
def spread_samples(Ts, values, first, last, poses, held):
    """Each of the poses ``first`` to ``last - 1`` of Ts once for each of the values (s,).

    Written to poses (at least (last - first) s, 4, 4) and held, as long, one column.
    """
    row = 0
    for i in range(first, last):
        for k in range(values.shape[0]):
            for a in range(4):
                for b in range(4):
                    poses[row, a, b] = Ts[i, a, b]
            held[row, 0] = values[k]
            row += 1


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
                for j in range(q.shape[2]):
                    q[i, total, j] = some_q[row, r, j]
                residual[i, total] = some_residual[row, r]
                branch[i, total] = some_branch[row, r]
                free[i, total] = some_free[row, r]
                total += 1
        count[i] = total
