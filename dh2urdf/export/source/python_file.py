"""The arm's Python file: the kernels as they are written, and what of NumPy they use."""

import inspect
import io
import math
import re
import textwrap
import tokenize
from pathlib import Path
from typing import Any

import numpy as np

from dh2urdf.bounds import ANGLE
from dh2urdf.export.source.head import LICENCE, branches, complete, joints, one_line, provenance
from dh2urdf.export.source.program import Call, Named, Program, definition, names_of
from dh2urdf.export.source.python_text import ABOUT, FUNCTIONS, HELD, HELD_REFUSED
from dh2urdf.ik.arm import LIMIT_SLACK, middle
from dh2urdf.kernels.certificate import arrange_near
from dh2urdf.kernels.chain import chain_fk, chain_jacobian
from dh2urdf.kernels.counts import DEEP
from dh2urdf.kernels.newton import POSE
from dh2urdf.kernels.numbers import is_pose
from dh2urdf.kernels.redundant import families_inside
from dh2urdf.robot import Robot
from dh2urdf.translate.definitions import home_of
from dh2urdf.translate.source import Source, source_of
from dh2urdf.translate.types import ELEMENTS

ARRAYS = Path(__file__).with_name("arrays.py.in").read_text()
"""What stands in the place of NumPy."""

SPELT = {"found->" + x: x for x in ("q", "residual", "count", "branch", "free_joints")}
"""Where solutions go, as the functions call it."""


class PythonProgram:
    """The Python of a program."""

    stack = 0

    def __init__(self, robot: Robot, program: Program) -> None:
        self.robot, self.program = robot, program
        self.names: dict[object, str] = {}
        self.constants: dict[str, str] = {}
        self.kernels: dict[str, str] = {}

    def text(self) -> str:
        """The whole file."""
        functions = self._functions()
        licence = "\n".join(f"# {line}".rstrip() for line in LICENCE.strip().split("\n"))
        about = self._about().replace('"""', "'''")
        head = [f'"""{about}\n"""', "", licence, "", "import math", "from typing import NamedTuple"]
        constants = [f"{name} = {value}" for name, value in self.constants.items()]
        kernels = "\n\n\n".join(self.kernels.values())
        return "\n".join([*head, "", "", ARRAYS, *constants, "", "", kernels, "", "", functions])

    def _about(self) -> str:
        """What the head says."""
        held = self.program.held
        name = one_line(self.robot.joint_names[held[0]]) if held else ""
        line = (
            f"\nheld is the value of {name}, q[{held[0]}], the caller's choice.\n" if held else ""
        )
        return ABOUT.format(
            n=self.program.chain.n,
            provenance="\n".join(provenance(self.robot, self.program)),
            joints="\n".join(f"    {row}" for row in joints(self.robot)),
            base=one_line(self.robot.base),
            tip=one_line(self.robot.tip),
            held="held, " if held else "",
            held_refused=HELD_REFUSED if held else "",
            held_line=line,
            held_given=", held" if held else "",
            branch_line=branches(self.robot, self.program),
            complete=complete(self.program, "True", "False"),
        )

    def _functions(self) -> str:
        """The arm's functions, and all that they call."""
        program, n, k = self.program, self.program.chain.n, self.program.solver.kmax
        links, table = tables = program.chain.tables
        q, slides = Named("q", None), table[:, 0] != 0.0
        pose, seed, distance = Named("pose", None), Named("seed", None), Named("distance", None)
        inside_or_not = Named("within_limits", True)
        near = tables, inside_or_not, LIMIT_SLACK, POSE, pose, seed, program.out, distance
        size, centre = float(program.chain.size), middle(program.chain)
        inside = tables, LIMIT_SLACK, POSE, size, centre, pose, program.out
        scratch = [f"{x.name} = {self._blank(x.like)}" for x in program.scratch]
        scratch += ["held = _floats([held], (1,))"] if program.held else []
        scratch += [f"{_place(x.name)} = [{self._record(x.like[0])}]" for x in program.records]
        return FUNCTIONS.format(
            n=n,
            k=k,
            lower=_listed(self.robot.lower),
            upper=_listed(self.robot.upper),
            deep=DEEP,
            given="T, held, " if program.held else "T, ",
            handed="held, " if program.held else "",
            fk=self._call(Call(chain_fk, (links, slides, q, Named("T", None)))),
            jacobian=self._call(Call(chain_jacobian, (links, slides, q, Named("J", None)))),
            angle=ANGLE,
            held_check="".join(HELD.format(angle=ANGLE, joint=joint) for joint in program.held),
            is_pose=self._call(Call(is_pose, (Named("pose[0]", None),))),
            scratch=textwrap.indent("\n".join(scratch), "    "),
            steps="\n".join(f"    {self._call(call)}" for call in program.calls),
            inside=self._call(Call(families_inside, inside)),
            arrange=self._call(Call(arrange_near, near)),
        )

    def _call(self, call: Call) -> str:
        """A call of a kernel."""
        written = definition(call.kernel)
        kernel, names = self._kernel(source_of(written)), names_of(written, call.arguments)
        return f"{kernel}{self._argument(names, call.arguments)}"

    def _argument(self, name: Any, argument: Any) -> str:
        """An argument of a call, or a tuple of them."""
        if isinstance(argument, tuple):
            each = (self._argument(n, a) for n, a in zip(name, argument, strict=True))
            return f"({', '.join(each)})"
        if isinstance(argument, np.ndarray):
            return self._constant(name.upper(), argument)
        if isinstance(argument, Named):
            return SPELT.get(argument.name, _place(argument.name))
        return repr(argument)

    def _kernel(self, source: Source) -> str:
        """Name of a kernel, which the file has from now on with all that it calls."""
        if source.function in self.names:
            return self.names[source.function]
        name = self._unique(source.name, source.module.__name__, source.function)
        renamed = {source.name: name}
        for word in source.function.__code__.co_names:
            value, inner = source.stands_for(word), source.kernel(word)
            if word in ("math", "np") or value is range or word not in vars(source.module):
                continue
            home, _ = home_of(source.module, word)
            renamed[word] = (
                self._kernel(inner) if inner else self._constant(word, value, home.__name__)
            )
        lines = textwrap.dedent("".join(inspect.getsourcelines(source.function)[0])).splitlines()
        body = "\n".join(lines[source.tree.body[0].lineno - 1 :])
        text = f"def {name}({', '.join(source.parameters)}):\n{_renamed(body, renamed)}"
        self.kernels[name] = text.rstrip()
        return name

    def _constant(self, name: str, value: Any, module: str = "") -> str:
        """Name of a constant, which the file has from now on."""
        key = name, _spelt(value)
        if key not in self.names:
            self.names[key] = self._unique(name.lstrip("_"), module, key)
            self.constants[self.names[key]] = key[1]
        return self.names[key]

    def _unique(self, name: str, module: str, key: object) -> str:
        """A name that nothing else in the file has."""
        room = module.rpartition(".")[2]
        taken = {*self.names.values(), *RESERVED}
        some = (name, f"{name}_{room}", *(f"{name}_{i}" for i in range(2, 999)))
        found = next(x for x in some if x not in taken)
        self.names[key] = found
        return found

    @staticmethod
    def _blank(array: np.ndarray[Any, Any]) -> str:
        kind = ", int64" * (array.dtype.kind == "i") + ", bool_" * (array.dtype.kind == "b")
        return f"empty({array.shape}{kind})"

    @staticmethod
    def _record(record: np.void) -> str:
        """What a solver knows and works in, a dictionary."""
        assert record.dtype.names
        fields = []
        for name in record.dtype.names:
            value = np.asarray(record[name])
            if value.shape and not value.any():
                kind = ", int64" * (value.dtype.kind == "i") + ", bool_" * (value.dtype.kind == "b")
                fields.append(f"{name!r}: zeros({value.shape}{kind})")
            else:
                fields.append(f"{name!r}: {_spelt(value if value.shape else value.item())}")
        return f"{{{', '.join(fields)}}}"


OWN = """
fk jacobian ik ik_near Solutions JOINTS LOWER UPPER math NamedTuple elimination search valleys held
T J q residual count branch free_joints complete pose seed distance within_limits
"""

RESERVED = {*re.findall(r"^(?:def |class )?(\w+)(?=\(|:| =)", ARRAYS, re.MULTILINE), *OWN.split()}
"""Names that the file has for itself."""


def _place(name: str) -> str:
    """What a part of the workspace is called."""
    return name.rpartition(".")[2] if name.startswith("work.") else name


def _renamed(body: str, names: dict[str, str]) -> str:
    """A kernel's body with other names for what it has from its module."""
    out, line, column = list[str](), 1, 0
    lines, before = body.splitlines(keepends=True), ""
    for token in tokenize.generate_tokens(io.StringIO(f"if 1:\n{body}\n").readline):
        (row, start), (_, end) = token.start, token.end
        if token.type == tokenize.NAME and row > 1:
            row -= 1
            while line < row:
                out.append(lines[line - 1][column:])
                line, column = line + 1, 0
            new = names.get(token.string, token.string) if before != "." else token.string
            out += [lines[row - 1][column:start], new]
            column = end
        before = token.string
    out.append(lines[line - 1][column:])
    out += lines[line:]
    return re.sub(r"\bnp\.", "", "".join(out))


def _listed(values: np.ndarray[Any, Any]) -> str:
    """Numbers as a list that Python reads back."""
    text = repr(values.tolist())
    return re.sub(r"\b(inf|nan)\b", r"math.\1", text)


def _spelt(value: Any) -> str:
    """A constant as Python reads it back."""
    if isinstance(value, np.ndarray):
        kind = {"float": "", "int": ", int64", "bool": ", bool_"}[ELEMENTS[value.dtype.kind]]
        return f"Array({_listed(value.ravel())}, {value.shape}{kind})"
    if isinstance(value, float) and not math.isfinite(value):
        return re.sub(r"(inf|nan)", r"math.\1", repr(value))
    return repr(value)
