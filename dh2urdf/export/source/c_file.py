"""The arm's C file: its functions, which call the kernels, and its head."""

import re
from typing import Any

import numpy as np

from dh2urdf.bounds import ANGLE
from dh2urdf.export.source.c_kernels import ArmFile, lanes_of
from dh2urdf.export.source.c_text import (
    ABOUT,
    FUNCTIONS,
    HELD,
    HELD_REFUSED,
    INLINING,
    SOLUTIONS,
    WORK_EXAMPLE,
    WORK_LINE,
    WORKSPACE,
)
from dh2urdf.export.source.head import LICENCE, branches, complete, joints, one_line, provenance
from dh2urdf.export.source.names import hidden
from dh2urdf.export.source.program import Call, Named, Program, definition, names_of
from dh2urdf.export.source.stack import apart_or_part, stack_bytes
from dh2urdf.ik.arm import LIMIT_SLACK, middle
from dh2urdf.kernels.certificate import arrange_near
from dh2urdf.kernels.chain import chain_fk, chain_jacobian
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.numbers import is_pose
from dh2urdf.kernels.redundant import families_inside
from dh2urdf.robot import Robot
from dh2urdf.translate.definitions import ELEMENT, folded, number
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import ELEMENTS, Array, Record, Tuple, Type

CASTS = {"T": "(double (*)[4])T", "held": "&held"}
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
        kernels = apart_or_part(kernels, p.upper())
        body = hidden(f"{kernels}\n\n{functions}", p)
        self.stack = -(-stack_bytes(self._solutions(0) + body, f"{p}_ik_near") // 256) * 256
        guard = f"{p.upper()}_H"
        includes = [f"#include <{name}.h>" for name in ("math", "stdbool", "stdint", "string")]
        parts = [_comment(self._about()), _comment(LICENCE), f"#ifndef {guard}\n#define {guard}\n"]
        inlining = INLINING.format(P=p.upper())
        parts += ["\n".join([*includes, ""]), inlining, self._solutions(self.stack), body]
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
            work_line=WORK_LINE.format(p=p, size=program.workspace) if works else "",
            example=WORK_EXAMPLE.format(p=p) if works else "",
            branch_line=branches(self.robot, program),
            complete=complete(program, "true", "false"),
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
            workspace=int(bool(self.program.records)),
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
        inside_or_not = Named("within_limits", True)
        near = tables, inside_or_not, LIMIT_SLACK, POSE, pose, seed, out, distance
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
            steps="\n".join(f"    {self._call(call)};" for call in program.calls),
            inside=self._call(Call(families_inside, inside)),
            arrange=self._call(Call(arrange_near, near)),
        )
        return self._workspace() + functions if program.records else functions

    def _workspace(self) -> str:
        """What the solver works in, and the function that fills it."""
        consts, sets, parts = list[str](), list[str](), list[str]()
        for record in self.program.records:
            place = record.name.rpartition(".")[2]
            struct = self.file.struct(Record(place, record.like.dtype))
            parts.append(f"    {struct} {place};")
            for field in record.like.dtype.names or ():
                values = record.like[field][0]
                if not np.any(values):
                    continue
                if np.ndim(values):
                    sizes = "".join(f"[{d}]" for d in values.shape)
                    kind = ELEMENT[ELEMENTS[values.dtype.kind]]
                    consts += folded(f"static const {kind} {field}{sizes} = {number(values)};", 4)
                    sets.append(f"    memcpy(work->{place}.{field}, {field}, sizeof {field});")
                else:
                    sets.append(f"    work->{place}.{field} = {number(values)};")
        lines = ("\n".join([*x, ""]) if x else "" for x in (parts, consts, sets))
        return WORKSPACE.format(self.prefix, *lines)

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
            name = re.sub(r"^work\.", "&work->", argument.name)
            return [casts.get(name, name)]
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
                return Array(Record(argument.name.rpartition(".")[2], dtype), shape)
            return Array(ELEMENTS[dtype.kind], shape, argument.name in ("q", "seed"))
        return type(argument.like if isinstance(argument, Named) else argument).__name__


def _comment(text: str) -> str:
    """A text as a comment."""
    first, *rest = text.strip().split("\n")
    return "\n".join([f"/* {first}", *(f" * {line}".rstrip() for line in rest), " */", ""])
