"""Thresholds that solvers share, with unit and reason; others stand at the top of their file."""

ACCEPT = 1e-9
"""Residual [m and rad] of a solution; the same number as in ``kernels/certificate/certify.py``."""

INTERVAL_END = 1e-11
"""Distance [rad or m] to which the end of an interval of reach is halved; 1e-9 is promised."""

SHARP = 1e-12
"""Residual [m and rad], relative to the size of an arm of over a metre, up to which a pose counts
as reached when the end of an interval is sought. With ``ACCEPT`` the end would be off by as much
divided by the lever arm."""

LIMIT_SLACK = 1e-12
"""Excess over a joint limit [rad or m] that is rounding of a full turn, clipped away."""

FAMILY_RANK = 1e-6
"""Singular value of the Jacobian of the free joints, relative to the largest, that counts as
zero. A family's representative satisfies the equations to 1e-9, its tangent to the root."""

SPARE_RANK = 3e-10
"""The same of a joint that is to spare everywhere: through half a turn the tool stays within
``ACCEPT``. Where a twist moves it by more, a solver for the joint finds what it does."""

WEAK_RANK = 1e-4
"""The same below which closed forms may lose to rounding what a pose says of the joints."""

NO_RANK = 1e-13
"""The same that is rounding."""

FAMILY_STEP = 0.1
"""Joint motion [rad or m] between samples along a singular family: a circle in 63 steps."""

PATH_JUMP = 0.5
"""Motion of a joint [rad or m] between neighbouring poses of a path that counts as a break,
when the caller gives no other: some 30 degrees."""

REGULAR = 1e-6
"""Smallest singular value of a Jacobian, lengths relative to ``chain.size``, of an arm that can
move in every direction; one that cannot has rounding there at every configuration."""

SNAP = 1e-9
"""Angle [rad], or length relative to ``chain.size``, below which two axes count as parallel,
perpendicular or intersecting. A table's own rounding is 1e-16; 1e-9 is what a residual may be."""

NOMINAL = 2e-11
"""What `SNAP` is for six joints, which have a solver for nearly nominal arms: four times what
1.57079632679 lacks of a right angle. Snapping may lose two branches that are less than its root,
5e-6, apart."""

FORM_ERROR = 1e-13
"""Largest difference [m and rad], relative to ``chain.size`` where that is over 1 m, of the snapped
chain and the exact one at which a residual measured on the snapped chain is one of the exact
chain."""

EXACT = 1e-12
"""Cosine below which an angle between axes is a right angle up to rounding."""

SLACK = 1e-6
"""Relative amount by which an equation may miss its rim before the branch is given up. The residual
decides at 1e-9; this only has to be larger."""

SLACK_OF_NOISE = 30.0
"""Slack of an arm that is nearly of a family, per unit of its distance from it: a branch of the
exact arm that the nominal one just misses still gets a seed."""

NEAR = (3e-10, 3e-9, 1e-7, 3e-6, 1e-4, 1e-3, 5e-3)
"""Angles [rad], or lengths relative to ``chain.size``, within which axes are snapped when the
nominal arm of a rounded or calibrated one is sought, the smallest that will do. Factory
calibration changes parameters by up to 1e-3, and four of them are between two axes."""

ALMOST = 2e-2
"""Angle [rad] between neighbouring axes, of an arm with three that are parallel, by whose sine its
equations divide in vain: regular poses are lost up to 5e-3, below 1e-6 all of them."""

SLACK_OF_NEAR = 100.0
"""Slack of the nominal arm's equations per unit of its distance [m, rad] from the exact arm: lever
arms are seldom a hundred times shorter than the arm. What it lets in by mistake is in doubt."""

NOISE_MOTION = 0.3
"""Motion of a joint [rad] from the nominal arm's solution to the exact one's, per root of the
distance from the nominal arm, above which a pose is in doubt: a regular solution moves by much
less, one whose twin is near by about this."""

NEARLY_SINGULAR = 3.0
"""Singular value of the Jacobian, lengths relative to ``chain.size``, per root of the distance from
the nominal arm, below which a pose is in doubt: noise of eps merges branches that are the root of
eps apart."""
