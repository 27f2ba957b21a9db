"""Arms that are nearly of a closed-form family: rounded tables, calibrated tables.

The nominal arm gives candidates, Newton's method on the exact chain the solutions. Noise of size
eps moves a regular solution by about eps, but near a singularity by up to its square root, where
branches appear and vanish. So a pose is in doubt, and left to the general solver, where a
candidate moves far, does not converge, falls together with another, is one of an odd number, or
has a nearly singular Jacobian, and where there is none.

Where two singularities nearly meet, several solutions lie close together, and seeds from a nominal
arm, or roots of a polynomial, lead to some of them only. From one of them the others lie along the
direction in which the pose hardly changes.
"""

import numpy as np

from dh2urdf.kernels.certificate import ACCEPT, copy_rows, finish_pose
from dh2urdf.kernels.newton import POSE, error_and_jacobian, make_damped, polish, solve_damped
from dh2urdf.kernels.numbers import entry
from dh2urdf.kernels.parallel_axes import add_pairs, last_joint, outer_pairs, slope_of_last
from dh2urdf.kernels.parallel_axes import make_scratch as parallel_scratch
from dh2urdf.kernels.shapes import ClosedForm, Counts, Outputs, Poses, Solutions, Three
from dh2urdf.kernels.spherical_wrist import add_wrist, place_wrist, tool_to_wrist
from dh2urdf.kernels.spherical_wrist import make_scratch as wrist_scratch


def _settle(chain, T, trust, doubt, rows, found, start, work, damped):
    """Certify the candidates q of one pose; how many are left, or -1 minus that where in doubt.

    ``trust``: size of the arm [m], largest motion of a joint [rad], smallest singular value.
    """
    q, residual, branch, free = rows
    unit, most, regular = trust[0], trust[1], trust[2]
    doubt = doubt or found % 2 == 1 or found == 0
    for k in range(found):
        start[:] = q[k]
        residual[k] = polish(chain, T, q[k], work)
        doubt = doubt or not residual[k] <= ACCEPT or free[k] != 0
        for j in range(6):
            doubt = doubt or abs(q[k, j] - start[j]) > most
        if not doubt:
            error_and_jacobian(chain, (POSE, T, unit), q[k], damped)
            solve_damped(damped, 0.0)
            for a in range(6):
                doubt = doubt or damped[1][a, 8 + a] < regular
    left = finish_pose(chain, T, False, *rows, found, work)
    for k in range(left):
        branch[k], free[k] = -1, 0
    return -1 - left if doubt or left < found else left


@entry(n=6)
def solve_near_wrist(arm: ClosedForm, trust: Three, Ts: Poses, outputs: Outputs):
    """Poses Ts (m, 4, 4) of an arm whose last three axes nearly meet; count < 0: in doubt."""
    chain, form, ends, slack = arm
    q, residual, count, branch, free = outputs
    D, R, places, work, _ = wrist_scratch()
    start, damped = np.empty(6), make_damped(6)
    for i in range(Ts.shape[0]):
        tool_to_wrist(ends, Ts[i], D)
        rows, found = (q[i], residual[i], branch[i], free[i]), 0
        for k in range(place_wrist(form, D[0, 3], D[1, 3], D[2, 3], slack, places)):
            found = add_wrist(form, D, places[k], R, slack, *rows, found)
        count[i] = _settle(chain, Ts[i], trust, False, rows, found, start, work, damped)


def _in_line(form, first, pairs, slack, D, pair, cs, regular):
    """Whether axis 6 is nearly along the common normal for a pair: joint 6 is badly known."""
    outer = 0 if first == 1 else 3
    for k in range(abs(pairs)):
        cs[outer, 0], cs[outer, 1] = pair[k, 0], pair[k, 1]
        cs[4, 0], cs[4, 1] = pair[k, 2], pair[k, 3]
        if first == 1 and form[4, 0] == 0.0:
            slope_of_last(form, D, cs, slack)
        if last_joint(form, first, D, cs) < regular:
            return True
    return False


@entry(n=6)
def solve_near_parallel(arm: ClosedForm, trust: Three, Ts: Poses, outputs: Outputs):
    """Poses Ts (m, 4, 4) of an arm with three nearly parallel axes; count < 0: in doubt."""
    chain, form, ends, slack = arm
    q, residual, count, branch, free = outputs
    scratch = parallel_scratch()
    D, pair, work = scratch[0], scratch[1], scratch[3]
    start, damped = np.empty(6), make_damped(6)
    first = 1 if form[0, 2] != 0.0 else 0
    for i in range(Ts.shape[0]):
        tool_to_wrist(ends, Ts[i], D)
        pairs = outer_pairs(form, first, D, slack, pair)
        doubt = _in_line(form, first, pairs, slack, D, pair, scratch[2], trust[2])
        rows = q[i], residual[i], branch[i], free[i]
        found, _ = add_pairs(form, first, pairs, slack, False, rows, scratch)
        count[i] = _settle(chain, Ts[i], trust, doubt, rows, found, start, work, damped)


def wrist_seeds(arm, Ts, q, count):
    """Candidates of poses Ts (m, 4, 4) as they are before certification, with a wide slack."""
    _, form, ends, slack = arm
    D, R, places, _, rows = wrist_scratch()
    for i in range(Ts.shape[0]):
        tool_to_wrist(ends, Ts[i], D)
        found = 0
        for k in range(place_wrist(form, D[0, 3], D[1, 3], D[2, 3], slack, places)):
            found = add_wrist(form, D, places[k], R, slack, *rows, found)
        count[i] = min(found, q.shape[1])
        for k in range(count[i]):
            q[i, k] = rows[0][k]


def parallel_seeds(arm, Ts, q, count):
    """The same of an arm with three parallel axes."""
    _, form, ends, slack = arm
    scratch = parallel_scratch()
    rows, first = scratch[5], 1 if form[0, 2] != 0.0 else 0
    for i in range(Ts.shape[0]):
        tool_to_wrist(ends, Ts[i], scratch[0])
        pairs = outer_pairs(form, first, scratch[0], slack, scratch[1])
        found, _ = add_pairs(form, first, pairs, slack, True, rows, scratch)
        count[i] = min(found, q.shape[1])
        for k in range(count[i]):
            q[i, k] = rows[0][k]


def settle_counts(count: Counts):
    """Make counts of candidates of those of poses in doubt; whether there is one."""
    doubt = False
    for i in range(count.shape[0]):
        doubt = doubt or count[i] < 0
        count[i] = max(count[i], -1 - count[i])
    return doubt


def skip_sure(count: Counts, others: Counts):
    """Leave no candidates, of which there are ``others`` (m,), to poses that are in no doubt."""
    for i in range(count.shape[0]):
        others[i] = others[i] if count[i] < 0 else 0


def put_doubtful(others: Outputs, outputs: Outputs):
    """Put the solutions of others in the place of those of poses in doubt."""
    more, (q, residual, count, branch, free) = others, outputs
    for i in range(count.shape[0]):
        if count[i] < 0:
            source = more[0][i], more[1][i], more[3][i], more[4][i]
            rows = q[i], residual[i], branch[i], free[i]
            count[i] = copy_rows(source, more[2][i], rows)


def reverse_all(q: Solutions):
    """Reverse the joints of configurations q (m, k, n), in place."""
    n = q.shape[2]
    for i in range(q.shape[0]):
        for k in range(q.shape[1]):
            for j in range(n // 2):
                q[i, k, j], q[i, k, n - 1 - j] = q[i, k, n - 1 - j], q[i, k, j]
