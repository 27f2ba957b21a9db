"""What an arm's Python file says around its kernels, with gaps for what is the arm's."""

ABOUT = """\
The kinematics of one arm, with all of its inverse kinematics, in Python that needs math alone.

{provenance}

Lengths are metres, angles radians. A pose is T_{base}_{tip}, four rows of four numbers. A
configuration q is {n} numbers:

{joints}

    fk(q)
        the pose of a configuration
    jacobian(q)
        six rows: velocity of the tip, then angular velocity, in the axes of the base
    ik(T, {held}within_limits=True)
        all configurations that reach a pose, as Solutions; ValueError if T is none{held_refused}
    ik_near(T, {held}seed, within_limits=True)
        the same, in the full turns nearest to a seed, nearest first
{held_line}
Solutions are lists of the same length: q, residual (the larger of the errors of position [m] and
rotation [rad] on the exact chain), branch{branch_line}
and free_joints, whose bit i says that joint i can move while the tip stays, because the solution is
singular: it stands for a family, along which ik_near does not move it. {complete}

    found = ik(T{held_given}, within_limits=False)
    for q, residual in zip(found.q, found.residual):
        print(q, residual)

Results are those of dh2urdf to the last bit."""

HELD_REFUSED = """, or if
        held is outside its limits within_limits"""

HELD = """\
    lower, upper = (LOWER[{joint}], UPPER[{joint}]) if within_limits else (-{angle}, {angle})
    if not max(lower, -{angle}) <= held <= min(upper, {angle}):
        raise ValueError(f"held: {{held}} is outside the limits {{lower}} to {{upper}}")
"""

FUNCTIONS = '''\
JOINTS, LOWER, UPPER = {n}, {lower}, {upper}


class Solutions(NamedTuple):
    """Configurations that reach a pose, as the head of the file says."""

    q: list
    residual: list
    branch: list
    free_joints: list
    complete: bool


def fk(q):
    """The pose of a configuration, four rows."""
    q, T = _floats(q, ({n},)), empty((4, 4))
    {fk}
    return T.rows()


def jacobian(q):
    """The geometric Jacobian, six rows of {n}."""
    q, J = _floats(q, ({n},)), empty((6, {n}))
    {jacobian}
    return J.rows()


def ik({given}within_limits=True):
    """All configurations that reach a pose."""
    return _solved(T, {handed}within_limits, None)


def ik_near({given}seed, within_limits=True):
    """The same, turned towards a seed and sorted by distance from it."""
    return _solved(T, {handed}within_limits, _floats(seed, ({n},)))


def _solved({given}within_limits, seed):
    pose = _floats(T, (1, 4, 4))
    if not {is_pose}:
        raise ValueError("no pose: not finite, or no rotation within 1e-6")
    if seed is not None and not all(abs(x) <= {angle} for x in seed.rows()):
        raise ValueError("seed: expected numbers up to {angle}")
{held_check}    q, residual, count = empty((1, {k}, {n})), empty((1, {k})), zeros(1, int64)
    branch, free_joints, complete = zeros((1, {k}), int64), zeros((1, {k}), int64), True
{scratch}
{steps}
    if count[0] < 0:
        count[0], complete = (-1 - count[0]) % {deep}, False
    if within_limits:
        {inside}
    if seed is not None and count[0] > 0:
        distance = empty({k})
        {arrange}
    found = (array[0].rows()[: count[0]] for array in (q, residual, branch, free_joints))
    return Solutions(*found, complete)
'''
