"""What an arm's C file says around its kernels, with gaps for what is the arm's."""

ABOUT = """\
The kinematics of one arm, with all of its inverse kinematics, in C99 that C++ takes, too.
{provenance}

Numbers are doubles, lengths metres, angles radians. A pose is T_{base}_{tip}, 16 numbers row by
row, the last 0 0 0 1. A configuration q is {n} numbers:

{joints}

    {p}_fk(q, T)
        the pose of a configuration
    {p}_jacobian(q, J)
        6 x {n} row by row: velocity of the tip, then angular velocity, in the axes of the base
    {p}_ik(T, {held}within_limits, {work}&found)
        all configurations that reach a pose; their number, or -1 if T is no pose (not finite, no
        rotation within 1e-6){held_refused}
    {p}_ik_near(T, {held}seed, within_limits, {work}&found)
        the same, in the full turns nearest to a seed of {n} numbers, nearest first; -1 if one of
        them is none, or beyond {angle:g}
{held_line}{work_line}
found holds count solutions in its first rows, each with its residual, the larger of its errors of
position [m] and rotation [rad] on the exact chain; its branch{branch_line}
and free_joints, whose bit i says that joint i can move while the tip stays, because the solution is
singular: it stands for a family, along which {p}_ik_near does not move it. {complete}

    {p}_solutions found;
{example}    {p}_ik(T, {held}true, {work}&found);
    for (int k = 0; k < found.count; k++) {{
        printf("%g, residual %.0e\\n", found.q[k][0], found.residual[k]);
    }}

No function allocates or keeps anything between calls, and each may run in many threads at once.
{stack} bytes of the stack, {P}_STACK, are enough for any of them. With contraction off (gcc and
clang: -ffp-contract=off) results are those of dh2urdf to the last bit. Sums have to stay in their
order: -ffast-math, -Ofast and /fp:fast are refused below, and -fassociative-math, which no compiler
tells of, makes all numbers wrong."""

HELD_REFUSED = """,
        or held is outside its limits within_limits"""

WORK_LINE = """
work is a {p}_workspace of {size} bytes that {p}_prepare(&work) has filled once, what the solver
knows of the arm and works in: one for each thread.
"""

WORK_EXAMPLE = """\
    static {p}_workspace work;
    {p}_prepare(&work);
"""

SOLUTIONS = """\
#define {P}_JOINTS {n}
#define {P}_SOLUTIONS {kmax}
#define {P}_STACK {stack}
#define {P}_HAS_WORKSPACE {workspace}

/* Limits of the joints [rad] or [m]. */
static const double {P}_LOWER[{P}_JOINTS] = {lower};
static const double {P}_UPPER[{P}_JOINTS] = {upper};

typedef struct {{
    int64_t count;
    double q[{P}_SOLUTIONS][{P}_JOINTS];
    double residual[{P}_SOLUTIONS];
    int64_t branch[{P}_SOLUTIONS];
    int64_t free_joints[{P}_SOLUTIONS];
    bool complete;
}} {p}_solutions;
"""

INLINING = """\
#if defined(__FAST_MATH__) || defined(_M_FP_FAST)
#error "compile without -ffast-math, -Ofast and /fp:fast: these sums have to stay in their order"
#endif

/* What keeps the frames of functions apart, so that they do not add up on the stack; and what makes
 * those that return many numbers a part of their callers, where these need not go through memory.
 */
#if defined(__GNUC__)
#define {P}_NOINLINE __attribute__((noinline))
#define {P}_INLINE inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define {P}_NOINLINE __declspec(noinline)
#define {P}_INLINE __forceinline
#else
#define {P}_NOINLINE
#define {P}_INLINE inline
#endif
"""

FUNCTIONS = """\
/* The pose T_{base}_{tip}, 16 numbers row by row, of a configuration. */
static inline void {p}_fk(const double q[{n}], double T[16])
{{
    {fk};
}}

/* The geometric Jacobian, 6 x {n} numbers row by row: linear velocity of the tip, then angular. */
static inline void {p}_jacobian(const double q[{n}], double J[{n6}])
{{
    {jacobian};
}}

/* All configurations that reach a pose; their number, or -1 if T is no pose. */
static inline int {p}_ik({parameters}, {p}_solutions *found)
{{
    double pose[1][4][4];
{scratch}    memcpy(pose, T, sizeof pose);
    found->count = 0;
    found->complete = false;
    if (!{is_pose}) {{
        return -1;
    }}
{held_check}{steps}
    found->complete = found->count >= 0;
    if (found->count < 0) {{
        found->count = (-1 - found->count) % {deep};
    }}
    if (within_limits) {{
        {inside};
    }}
    return (int)found->count;
}}

/* The same, turned towards a seed of {n} numbers and sorted by distance from it. */
static inline int {p}_ik_near({near}, {p}_solutions *found)
{{
    double pose[1][4][4], distance[{kmax}];
    int i, count;
    found->count = 0;
    found->complete = false;
    for (i = 0; i < {n}; i++) {{
        if (!(seed[i] >= -{angle} && seed[i] <= {angle})) {{
            return -1;
        }}
    }}
    count = {p}_ik({given}, found);
    if (count > 0) {{
        memcpy(pose, T, sizeof pose);
        {arrange};
    }}
    return count;
}}
"""

HELD = """\
    if (!(held >= -{angle} && held <= {angle})) {{
        return -1;
    }}
    if (within_limits && !(held >= {P}_LOWER[{joint}] && held <= {P}_UPPER[{joint}])) {{
        return -1;
    }}
"""

WORKSPACE = """\
typedef struct {{
{1}}} {0}_workspace;

/* Fill what the solver knows and works in, once before all poses. */
static inline void {0}_prepare({0}_workspace *work)
{{
{2}    memset(work, 0, sizeof *work);
{3}}}

"""
