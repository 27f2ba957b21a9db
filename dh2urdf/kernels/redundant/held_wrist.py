"""Seven joints, one of them held: arms whose other axes end or begin in a spherical triple.

The chain is seen from the base or from the tool, so that the triple comes last ("oriented"), and
written as ``T = base Z1 S0 Z2 S1 Z3 S2 wrist tool`` with constant links S. A joint held between
the first and the wrist makes one of them ``S(v) = X Z(v) Y``; one held at an end moves the pose.

Constants of an arm, packed for a cheap call:

``frames`` (30, 4, 4)
    0 to 7 links of the exact chain; 8 to 15 those of the oriented chain; 16, 17, 18 S0, S1, S2;
    19, 20 X and Y; 21 to 23 inverse of the base, inverse of the tool, tool; 24, 25 what a target
    stands between, and 26 to 29 factors, see :mod:`dh2urdf.kernels.redundant.held_wrist_load`.
``which`` (5,)
    Held joint; whether it slides; whether the oriented chain is the reversed one; held joint of
    the oriented chain; which S depends on it, -1: none.
``form`` (6, 7)
    Denavit-Hartenberg rows of the oriented arm, of which the wrist's are used, and the signs.
``joints`` (6, 3)
    Sliding, lower, upper of the moving joints.
"""

from typing import Annotated, NamedTuple

import numpy as np

from dh2urdf.kernels.certificate import (
    ACCEPT,
    certify_pose,
    merge_solutions,
    name_families,
    null_direction,
    reverse_joints,
    turn_inside,
)
from dh2urdf.kernels.chain import held_links, held_pose, insert_held
from dh2urdf.kernels.newton import POLISH, POSE, normal_equations, pose_residual, restore
from dh2urdf.kernels.numbers import entry, sincos
from dh2urdf.kernels.redundant.held_wrist_place import place_held, put_in_line
from dh2urdf.kernels.redundant.one_family import keep_one_of_each, take_in_isolated
from dh2urdf.kernels.rigid import invert_pose, turned_back
from dh2urdf.kernels.shapes import Floats, Held, Integers, Outputs, Poses
from dh2urdf.kernels.spherical_wrist import append_wrist, tool_to_wrist

VAGUE = 1e-10
"""Volume that the motions of joints 1, 2, 3 span, in sizes of the arm, times the sine of joint 5,
below which a pose may be in doubt."""

FLAT = 1e-13
"""Smallest eigenvalue of J^T J, relative to the trace, of a solution by which it is: along its way
of a twentieth the tool stays."""

NOTHING, SOME, ALL, EVERYTHING = range(4)
"""What of a pose is vague: some of its candidates or all; equations are void."""

MOST = 8
"""Solutions that such an arm has at most: if all are there, a search would find no other."""

HELD, SLIDES, REVERSED, ORIENTED, VARIES = range(5)
ORIENTED_LINKS, LINK, AROUND, ENDS, SIDES, FACTORS = 8, 16, 19, 21, 24, 26


def make_scratch():
    """Arrays that one pose is worked out in.

    Two poses; frame 6 in frame 0; S0, S1, S2; orientation left to the wrist; position solutions;
    certification; links of the moving joints; candidates; two equations, a quartic, its pairs.
    """
    return (
        *(np.empty((2, 4, 4)), np.empty((4, 4)), np.empty((3, 4, 4)), np.empty((3, 3))),
        *(np.empty((8, 6)), np.empty((6, 14)), np.empty((7, 4, 4)), np.empty((8, 6))),
        (np.empty((3, 2, 2)), np.empty((3, 5)), np.empty((4, 4))),
    )


def oriented_pose(frames, which, value, T, scratch):
    """The target of the oriented chain, into ``scratch[1]``; S0, S1, S2 into ``scratch[2]``."""
    poses, D, S = scratch[0], scratch[1], scratch[2]
    slides, k = which[SLIDES] != 0, which[ORIENTED]
    target = T
    if which[REVERSED] != 0:
        invert_pose(T, poses[0])
        target = poses[0]
    if k == 0 or k == 6:
        held_pose(frames[ORIENTED_LINKS : ORIENTED_LINKS + 8], slides, k, value, target, poses[1])
        target = poses[1]
    tool_to_wrist(frames[ENDS:], target, D)
    for i in range(3):
        if i == which[VARIES]:
            held_links(frames[AROUND : AROUND + 2], slides, 0, value, S[i : i + 1])
        else:
            S[i] = frames[LINK + i]


def _orientation_left(D, S, values, R):
    """``R_36 = S2^T Z3^T S1^T Z2^T S0^T Z1^T R_06``, to R (3, 3)."""
    for j in range(3):
        x, y, z = D[0, j], D[1, j], D[2, j]
        for i in range(3):
            s, c = sincos(values[i])
            x, y, z = turned_back(S[i], (c * x + s * y, c * y - s * x, z))
        R[0, j], R[1, j], R[2, j] = x, y, z


def held_candidates(arm, value, T, rows, scratch):
    """Candidates of one pose, in the chain's order without the held joint; how many.

    Then how much of it is vague, that is, singular and of no family that is known.
    """
    (frames, which, form, _, slack), (q, _, _, free) = arm, rows
    oriented_pose(frames, which, value, T, scratch)
    D, S, R, place = scratch[1], scratch[2], scratch[3], scratch[4]
    found, places, seen, vague = 0, place_held(form, D, S, slack, scratch), 0, 0
    for k in range(places):
        _orientation_left(D, S, place[k], R)
        before = found
        found = append_wrist(form, place[k], R, slack, *rows, found)
        if found > before and free[before] == 0:
            bent, _ = sincos(form[4, 6] * q[before, 4] + form[4, 4])
            seen, vague = seen + 1, vague + (1 if place[k, 5] * abs(bent) <= VAGUE else 0)
    if which[REVERSED] != 0:
        for k in range(found):
            free[k] = reverse_joints(q[k], free[k])
    if places < 0:
        return found, EVERYTHING
    return found, NOTHING if vague == 0 else ALL if vague == seen else SOME


def _beside_a_family(chain, T, q, free, found):
    """Whether a candidate of a family that is known misses the pose: it is beside one."""
    for k in range(found):
        if free[k] != 0 and not pose_residual(chain, T, q[k]) <= POLISH:
            return True
    return False


def _is_flat(chain, T, q, free, found, work):
    """Whether a solution of no family that is known hardly moves the tool in some direction."""
    for k in range(found):
        if free[k] == 0:
            normal_equations(chain, T, q[k], work)
            if null_direction(work) <= FLAT:
                return True
    return False


def solve_held_pose(arm, value, T, within_limits, out, scratch):
    """All solutions of one pose at one held value, to the rows ``out``; returns the count.

    It is -1 minus that of a pose in doubt: equations are void, or singularities meet, or nearly.
    """
    (frames, which, form, joints, _), (q, residual, branch, free) = arm, out
    work, links, rest = scratch[5], scratch[6], (scratch[7], residual, branch, free)
    found, vague = held_candidates(arm, value, T, rest, scratch)
    residual[:found] = -1.0
    held_links(frames[:8], which[SLIDES] != 0, which[HELD], value, links)
    chain = links, joints
    doubt = vague == EVERYTHING or _beside_a_family(chain, T, scratch[7], free, found)
    left = certify_pose(chain, T, *rest, found, work)
    doubt = doubt or (vague == ALL and left < found)
    flat = not doubt and vague != NOTHING and _is_flat(chain, T, scratch[7], free, left, work)
    doubt, named = doubt or (flat and left < MOST), flat and left == MOST
    if vague != NOTHING:
        put_in_line(chain, T, form, which[REVERSED] != 0, rest, left)
        left = merge_solutions(chain, T, *rest, left, np.empty((2, 6)), work)
    left = turn_inside(chain, T, within_limits, *rest, left)
    if named:  # no branch is missing; families are not led into the limits, which takes accuracy
        name_families(chain, T, rest, left, True, work)
        left = take_in_isolated(chain, T, 1.0, rest, left)
        left = keep_one_of_each(chain, (POSE, T, 1.0), *rest, left)
    insert_held(which[HELD], value, scratch[7], q, free, left)
    return -1 - left if doubt else left


def solve_rough(arm, values, Ts, within_limits, first, last, outputs):
    """Solve those of the poses ``first`` to ``last - 1`` whose count is negative.

    How many of them are in doubt.
    """
    q, residual, count, branch, free = outputs
    scratch, doubts = make_scratch(), 0
    for i in range(first, last):
        if count[i] < 0:
            out = q[i], residual[i], branch[i], free[i]
            count[i] = solve_held_pose(arm, values[i], Ts[i], within_limits, out, scratch)
            doubts += 1 if count[i] < 0 else 0
    return doubts


class HeldForm(NamedTuple):
    """Seven joints of which one is held: frames, what is where in them, rows of the six others."""

    frames: Annotated[Floats, 30, 4, 4]
    which: Annotated[Integers, 5]
    form: Annotated[Floats, 6, 7]
    joints: Annotated[Floats, 6, 3]
    slack: float


@entry(n=7, solutions=8)
def solve_held_wrist(arm: HeldForm, values: Held, Ts: Poses, within_limits: bool, outputs: Outputs):
    """All solutions of poses Ts (m, 4, 4), each at its held value (m,); q (m, 8, 7).

    The count of a pose in doubt is -1 minus that of its solutions; returned is how many are.
    """
    count = outputs[2]
    count[:] = -1
    return solve_rough(arm, values, Ts, within_limits, 0, Ts.shape[0], outputs)


def points_at(arm, chain, goal, value, out, scratch, damped, dq):
    """Solutions of a pose on its curves near one held value, to rows of q (8, 7); how many.

    With a large slack also a value that just misses a curve gives a candidate. All seven joints of
    the chain take part in putting it on the curve, so that a loop between two values is found.
    """
    q, residual, branch, free = out
    rows = scratch[7], residual, branch, free
    found, _ = held_candidates(arm, value, goal[1], rows, scratch)
    insert_held(arm[1][HELD], value, scratch[7], q, free, found)
    kept = 0
    for k in range(found):
        q[kept] = q[k]
        if restore(chain, goal, q[kept], dq, damped) <= ACCEPT:
            kept += 1
    return kept


class Samples(NamedTuple):
    """Outputs of a solver for every sample of some poses."""

    q: Annotated[Floats, "samples_in", "some", "n"]
    residual: Annotated[Floats, "samples_in", "some"]
    counts: Annotated[Integers, "samples_in"]
    branch: Annotated[Integers, "samples_in", "some"]
    free: Annotated[Integers, "samples_in", "some"]


@entry()
def gather_samples(found: Samples, first: int, last: int, samples: int, outputs: Outputs):
    """Join the solutions of the samples of a pose, rows in the order of the values.

    ``found`` are the five arrays of a solver for (last - first) samples poses; the others are
    the caller's, with room for all, see :class:`dh2urdf.ik.arm.solver.Solver`. Returns whether
    every pose has one.
    """
    q, residual, count, branch, free = outputs
    some_q, some_residual, some_count, some_branch, some_free = found
    every = True
    for i in range(first, last):
        total = 0
        for k in range(samples):
            row = (i - first) * samples + k
            for r in range(some_count[row]):
                q[i, total] = some_q[row, r]
                residual[i, total] = some_residual[row, r]
                branch[i, total], free[i, total] = some_branch[row, r], some_free[row, r]
                total += 1
        count[i] = total
        every = every and total > 0
    return every


@entry()
def repeat_pose(T: Annotated[Floats, 1, 4, 4], Ts: Poses):
    """Copy one pose to all the others, Ts (m, 4, 4)."""
    for i in range(Ts.shape[0]):
        Ts[i] = T[0]
