"""The arm's C file: its functions, which call the kernels, and its head."""

from typing import Any

import numpy as np

from dh2urdf.bounds import ANGLE
from dh2urdf.export.source.c_kernels import ArmFile, lanes_of
from dh2urdf.export.source.head import LICENCE, branches, joints, one_line, provenance
from dh2urdf.export.source.names import hidden
from dh2urdf.export.source.program import Call, Named, Program, definition, names_of
from dh2urdf.export.source.stack import kept_apart, stack_bytes
from dh2urdf.ik.arm import LIMIT_SLACK, middle
from dh2urdf.kernels.certificate import DEEP, arrange_near
from dh2urdf.kernels.chain import chain_fk, chain_jacobian
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.numbers import is_pose
from dh2urdf.kernels.redundant import families_inside
from dh2urdf.robot import Robot
from dh2urdf.translate.definitions import ELEMENT, folded, number
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import ELEMENTS, Array, Record, Tuple, Type

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
singular: it stands for a family, along which {p}_ik_near does not move it. complete is false
where there may be more solutions, because the pose is next to one at which solutions meet;
Robot.ik of dh2urdf searches there.

    {p}_solutions found;
{example}    {p}_ik(T, {held}true, {work}&found);
    for (int k = 0; k < found.count; k++) {{
        printf("%g, residual %.0e\\n", found.q[k][0], found.residual[k]);
    }}

No function allocates or keeps anything between calls, and each may run in many threads at once.
{stack} bytes of the stack, {P}_STACK, are enough for any of them. With contraction off (gcc and
clang: -ffp-contract=off) results are those of dh2urdf to the last bit."""

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

NOINLINE = """\
/* What keeps the frames of functions apart, so that they do not add up on the stack. */
#if defined(__GNUC__)
#define {P}_NOINLINE __attribute__((noinline))
#elif defined(_MSC_VER)
#define {P}_NOINLINE __declspec(noinline)
#else
#define {P}_NOINLINE
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
    found->complete = true;
    if (!{is_pose}) {{
        return -1;
    }}
{held_check}{steps}
    if (found->count < 0) {{
        found->count = (-1 - found->count) % {deep};
        found->complete = false;
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
    found->complete = true;
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

CASTS = {"T": "(double (*)[4])T", "held": "&held", "work": "work"}
CASTS |= {f"found->{x}": f"&found->{x}" for x in ("q", "residual", "count", "branch")}
CASTS |= {"found->free_joints": "&found->free_joints"}
"""How the functions of the file hand on what they have."""


class CProgram:
    """The C of a program under a prefix."""

    def __init__(self, robot: Robot, program: Program, prefix: str) -> None:
        self.robot, self.program, self.prefix = robot, program, prefix
        lanes = max(lanes_of(definition(call.kernel)) for call in program.calls)
        self.file, self.n = ArmFile(prefix, lanes), program.chain.n

    def text(self) -> str:
        """The whole file."""
        p, functions = self.prefix, self._functions()
        kernels = self.file.text()
        kernels = kept_apart(kernels, f"{p.upper()}_NOINLINE")
        body = hidden(f"{kernels}\n\n{functions}", p)
        self.stack = -(-stack_bytes(self._solutions(0) + body, f"{p}_ik_near") // 256) * 256
        guard = f"{p.upper()}_H"
        includes = [f"#include <{name}.h>" for name in ("math", "stdbool", "stdint", "string")]
        parts = [_comment(self._about()), _comment(LICENCE), f"#ifndef {guard}\n#define {guard}\n"]
        apart = NOINLINE.format(P=p.upper())
        parts += ["\n".join([*includes, ""]), apart, self._solutions(self.stack), body]
        return "\n".join([*parts, f"#endif /* {guard} */\n"])

    def _about(self) -> str:
        """What the head says."""
        p, program = self.prefix, self.program
        held, works = program.held, bool(program.records)
        line = ""
        if held:
            name = one_line(self.robot.joint_names[held[0]])
            line = f"\nheld is the value of {name}, q[{held[0]}], which is the caller's choice.\n"
        return ABOUT.format(
            p=p,
            P=p.upper(),
            n=self.n,
            provenance="\n".join(provenance(self.robot, program)),
            joints="\n".join(f"    {row}" for row in joints(self.robot)),
            base=one_line(self.robot.base),
            tip=one_line(self.robot.tip),
            angle=ANGLE,
            held="held, " if held else "",
            held_refused=HELD_REFUSED if held else "",
            held_line=line,
            work="&work, " if works else "",
            work_line="".join(
                WORK_LINE.format(p=p, size=record.like.dtype.itemsize) for record in program.records
            ),
            example=WORK_EXAMPLE.format(p=p) if works else "",
            branch_line=branches(program),
            stack=self.stack,
        )

    def _solutions(self, stack: int) -> str:
        """Sizes, limits and the struct of the solutions."""
        return SOLUTIONS.format(
            p=self.prefix,
            P=self.prefix.upper(),
            n=self.n,
            kmax=self.program.solver.kmax,
            stack=stack,
            workspace=len(self.program.records),
            lower=number(self.robot.lower),
            upper=number(self.robot.upper),
        )

    def _functions(self) -> str:
        """The arm's functions, with the kernels that they call added to the file."""
        program, p, n, out = self.program, self.prefix, self.n, self.program.out
        tables = program.chain.tables
        slides, q = tables[1][:, 0] != 0.0, Named("q", np.empty(n))
        T, J = Named("T", np.empty((4, 4))), Named("J", np.empty((6, n)))
        pose, seed = Named("pose", np.empty((1, 4, 4))), Named("seed", np.empty(n))
        distance = Named("distance", np.empty(program.solver.kmax))
        near = tables, LIMIT_SLACK, POSE, pose, seed, out, distance
        size, centre = float(program.chain.size), middle(program.chain)
        inside = tables, LIMIT_SLACK, POSE, size, centre, pose, out
        parameters = ["const double T[16]", *["double held"] * len(program.held)]
        given = ["T", *["held"] * len(program.held), "within_limits"]
        limits = "bool within_limits"
        if program.records:
            limits += f", {p}_workspace *work"
            given.append("work")
        functions = FUNCTIONS.format(
            p=p,
            n=n,
            n6=6 * n,
            kmax=program.solver.kmax,
            base=one_line(self.robot.base),
            tip=one_line(self.robot.tip),
            deep=DEEP,
            fk=self._call(Call(chain_fk, (tables[0], slides, q, T))),
            jacobian=self._call(Call(chain_jacobian, (tables[0], slides, q, J))),
            parameters=", ".join([*parameters, limits]),
            near=", ".join([*parameters, f"const double seed[{n}]", limits]),
            given=", ".join(given),
            scratch="".join(f"    {self._declared(x)};\n" for x in program.scratch),
            angle=ANGLE,
            held_check="".join(
                HELD.format(P=p.upper(), angle=ANGLE, joint=joint) for joint in program.held
            ),
            is_pose=self._call(Call(is_pose, (Named("pose[0]", np.empty((4, 4))),))),
            steps="\n".join(map(self._step, program.calls)),
            inside=self._call(Call(families_inside, inside)),
            arrange=self._call(Call(arrange_near, near)),
        )
        return "\n".join([*map(self._prepare, program.records), functions])

    def _prepare(self, record: Named) -> str:
        """The function that fills what the solver works in."""
        p, consts, sets = self.prefix, list[str](), list[str]()
        for field in record.like.dtype.names or ():
            values = record.like[field][0]
            if not np.any(values):
                continue
            if np.ndim(values):
                sizes = "".join(f"[{d}]" for d in values.shape)
                kind = ELEMENT[ELEMENTS[values.dtype.kind]]
                consts += folded(f"static const {kind} {field}{sizes} = {number(values)};", 4)
                sets.append(f"    memcpy(work->{field}, {field}, sizeof {field});")
            else:
                sets.append(f"    work->{field} = {number(values)};")
        lines = [f"static inline void {p}_prepare({p}_workspace *work)", "{", *consts]
        about = "/* Fill what the solver knows and works in, once before all poses. */"
        return "\n".join([about, *lines, "    memset(work, 0, sizeof *work);", *sets, "}", ""])

    def _step(self, call: Call) -> str:
        """A call that says whether the pose is in doubt, if it says anything."""
        text = self._call(call)
        if self.file.entries[-1].returned is None:
            return f"    {text};"
        return f"    if ({text}) {{\n        found->complete = false;\n    }}"

    def _declared(self, array: Named) -> str:
        """An array as a variable."""
        return self.file.declaration(self._type(array.name, array), array.name, storage=True)

    def _call(self, call: Call) -> str:
        """A call of a kernel in C."""
        kernel = definition(call.kernel)
        names = names_of(kernel, call.arguments)
        types = [self._type(name, a) for name, a in zip(names, call.arguments, strict=True)]
        entry = self.file.add_entry(kernel, types)
        return f"{entry.function}({', '.join(self._texts(entry, call.arguments))})"

    def _texts(self, entry: Body, argument: Any) -> list[str]:
        """What an argument is in a call: what is fixed is not handed on."""
        if isinstance(argument, tuple):
            return [text for a in argument for text in self._texts(entry, a)]
        if isinstance(argument, np.ndarray):
            return []
        if isinstance(argument, Named):
            casts = CASTS | {"J": f"(double (*)[{self.n}])J"}
            return [casts.get(argument.name, argument.name)]
        return [number(argument)]

    def _type(self, name: Any, argument: Any) -> Type:
        """The type of an argument as kernels have it."""
        if isinstance(argument, tuple):
            return Tuple(tuple(self._type(x, a) for x, a in zip(name, argument, strict=True)))
        if isinstance(argument, np.ndarray):
            return self.file.fixed(name, argument)
        if isinstance(argument, Named) and isinstance(argument.like, np.ndarray):
            dtype, shape = argument.like.dtype, argument.like.shape
            if dtype.names:
                return Array(Record("workspace", dtype), shape)
            return Array(ELEMENTS[dtype.kind], shape, argument.name in ("q", "seed"))
        return type(argument.like if isinstance(argument, Named) else argument).__name__


def _comment(text: str) -> str:
    """A text as a comment."""
    first, *rest = text.strip().split("\n")
    return "\n".join([f"/* {first}", *(f" * {line}".rstrip() for line in rest), " */", ""])
