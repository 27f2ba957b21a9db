"""A table as source code of the toolboxes that people compute with.

``rtb``: robotics-toolbox-python. ``matlab``: Peter Corke's toolbox for MATLAB. ``matlab-rst``:
MathWorks' Robotics System Toolbox. The variable of every joint is the table's q.
"""

from collections.abc import Callable, Sequence

import numpy as np

from dh2urdf.conversions.write.inertia import tensor
from dh2urdf.conversions.write.table_chain import grouped_rows
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin
from dh2urdf.dh.quoting import matlab, one_line
from dh2urdf.exceptions import TableError
from dh2urdf.transforms import Array


def rtb_python(table: DHTable) -> str:
    """Python source of a ``DHRobot``; of a ``Robot`` by elementary transforms with fixed rows."""
    lines = ["import roboticstoolbox as rtb", "from spatialmath import SE3", ""]
    lines += [*(f"# {line}" for line in _head(table)), ""]  # a comment on top may name a coding
    robot = _rtb_links if all(row.is_joint for row in table.rows) else _rtb_ets
    return "\n".join([*lines, *robot(table)]) + "\n"


def _ends(table: DHTable) -> dict[str, Origin]:
    """Base and tool, where there are any."""
    return {key: T for key in ("base", "tool") if not (T := getattr(table, key)).is_identity}


def _se3(origin: Origin) -> str:
    return f"SE3({origin.matrix.tolist()}, check=False)"


def _parameters(row: DHRow, put: Callable[[str, float], str]) -> list[str]:
    """The three constants of a joint's row and the offset of its variable."""
    slides = row.joint_type is JointType.PRISMATIC
    other, offset = ("theta", "d") if slides else ("d", "theta")
    cells = [put(key, getattr(row, key)) for key in (other, "a", "alpha")]
    return [*cells, put("offset", getattr(row, offset))]


def _rtb_links(table: DHTable) -> list[str]:
    suffix = "DH" if table.convention is DHConvention.STANDARD else "MDH"
    lines = ["robot = rtb.DHRobot(", "    ["]
    for row in table.joints:
        cells = _parameters(row, lambda key, value: f"{key}={value!r}")
        if row.sign < 0:
            cells.append("flip=True")
        cells += _optional(row, lambda key, values: f"{key}={values!r}")
        kind = str(row.joint_type).capitalize()
        lines.append(f"        rtb.{kind}{suffix}({', '.join(cells)}),")
    lines += ["    ],", f"    name={table.name!r},"]
    lines += [f"    {key}={_se3(origin)}," for key, origin in _ends(table).items()]
    return [*lines, ")"]


def _rtb_ets(table: DHTable) -> list[str]:
    """Elementary transforms, which take the steps that a DH link cannot."""
    steps = []
    if not table.base.is_identity:
        steps.append(f"rtb.ET.SE3({_se3(table.base)})")
    for row in table.rows:
        if row.origin is not None:
            steps.append(f"rtb.ET.SE3({_se3(row.origin)})")
            continue
        crossing = [f"rtb.ET.tx({row.a!r})", f"rtb.ET.Rx({row.alpha!r})"]
        along = [f"rtb.ET.Rz({row.theta!r})", f"rtb.ET.tz({row.d!r})"]
        if row.is_joint:
            arguments = ["flip=True"] if row.sign < 0 else []
            if row.lower is not None and row.upper is not None:
                arguments.append(f"qlim=[{row.lower!r}, {row.upper!r}]")
            kind = "tz" if row.joint_type is JointType.PRISMATIC else "Rz"
            along.append(f"rtb.ET.{kind}({', '.join(arguments)})")
        standard = table.convention is DHConvention.STANDARD
        steps += [*along, *crossing] if standard else [*crossing, *along]
    if not table.tool.is_identity:
        steps.append(f"rtb.ET.SE3({_se3(table.tool)})")
    body = "\n    * ".join(steps)
    return [f"ets = (\n    {body}\n)", f"robot = rtb.Robot(ets, name={table.name!r})"]


def matlab_corke(table: DHTable) -> str:
    """MATLAB source of a ``SerialLink`` (Robotics Toolbox 10).

    Raises
    ------
    TableError
        A fixed row, which that toolbox's links do not have.
    """
    if not all(row.is_joint for row in table.rows):
        raise TableError(
            "format matlab: its links have no fixed rows; use matlab-rst, or extract with "
            "compact=False"
        )
    lines = [f"% {line}" for line in _head(table)]
    for i, row in enumerate(table.joints, 1):
        cells = [f"'{row.joint_type}'"]
        cells += _parameters(row, lambda key, value: f"'{key}', {value!r}")
        cells += _optional(row, lambda key, values: f"'{key}', {_matlab(values)}")
        if row.sign < 0:
            cells.append("'flip'")
        cells.append(f"'{table.convention}'")
        lines.append(f"L({i}) = Link({', '.join(cells)});")
    ends = [f", '{key}', SE3({_matlab(end.matrix)})" for key, end in _ends(table).items()]
    lines.append(f"robot = SerialLink(L, 'name', {matlab(table.name)}{''.join(ends)});")
    return "\n".join(lines) + "\n"


def matlab_rst(table: DHTable) -> str:
    """MATLAB source of a ``rigidBodyTree`` with the joints set by ``'dh'`` or ``'mdh'``.

    ``setFixedTransform`` ignores the parameter that the joint moves, so a constant part of it
    becomes a fixed body of its own; base, tool and fixed rows do too.
    """
    tree = _Tree(weighs=any(row.mass is not None for row in table.joints))
    leading, groups = grouped_rows(table)
    if not table.base.is_identity:
        tree.fixed("frame_0", table.base.matrix)
    for k, row in enumerate(leading, 1):
        tree.fixed(f"frame_0_step_{k}", row.transform(0.0, table.convention))
    standard = table.convention is DHConvention.STANDARD
    for name, (joint, steps) in zip(table.joint_names, groups, strict=True):
        slides = joint.joint_type is JointType.PRISMATIC
        theta, d = (0.0, joint.d) if slides else (joint.theta, 0.0)
        kept = DHRow(theta, d, joint_type=JointType.FIXED)
        offset = [(f"{name}_offset", kept)] if kept.d or kept.theta else []
        extra = [(f"{name}_step_{k}", row) for k, row in enumerate(steps, 1)]
        for label, row in offset if standard else []:
            tree.fixed(label, row.transform(0.0, table.convention))
        after = extra if standard else [*offset, *extra]
        tree.joint(name, joint, "dh" if standard else "mdh", carries=not after)
        for label, row in after:
            carried = joint if label == after[-1][0] else None
            tree.fixed(label, row.transform(0.0, table.convention), carried)
    if not table.tool.is_identity:
        tree.fixed("tool0", table.tool.matrix)
    head = [f"% {line}" for line in _head(table)]
    return "\n".join([*head, "robot = rigidBodyTree('DataFormat', 'row');", *tree.lines]) + "\n"


class _Tree:
    """Bodies of a ``rigidBodyTree``, each on the one before."""

    def __init__(self, weighs: bool) -> None:
        self.lines: list[str] = []
        self.weighs = weighs
        self.parent = "robot.BaseName"

    def fixed(self, name: str, T: Array, carried: DHRow | None = None) -> None:
        self._start(name, "fixed")
        self.lines.append(f"setFixedTransform(jnt, {_matlab(T)});")
        self._end(name, carried)

    def joint(self, name: str, row: DHRow, kind: str, *, carries: bool) -> None:
        self._start(name, str(row.joint_type))
        numbers = _matlab([row.a, row.alpha, row.d, row.theta])
        self.lines.append(f"setFixedTransform(jnt, {numbers}, '{kind}');")
        if row.sign < 0:
            self.lines.append("jnt.JointAxis = [0 0 -1];")
        if row.lower is not None and row.upper is not None:
            self.lines.append(f"jnt.PositionLimits = {_matlab([row.lower, row.upper])};")
        self._end(name, row if carries else None)

    def _start(self, name: str, kind: str) -> None:
        self.lines.append(f"body = rigidBody({matlab(name)});")
        self.lines.append(f"jnt = rigidBodyJoint({matlab(name)}, '{kind}');")

    def _end(self, name: str, carried: DHRow | None) -> None:
        self.lines.append("body.Joint = jnt;")
        if self.weighs:
            self.lines += _rst_inertial(carried)
        self.lines.append(f"addBody(robot, body, {self.parent});")
        self.parent = matlab(name)


def _rst_inertial(row: DHRow | None) -> list[str]:
    """Mass properties about the body frame's origin; a body of that toolbox weighs 1 kg else."""
    if row is None or row.mass is None:
        return ["body.Mass = 0;", "body.Inertia = zeros(1, 6);"]
    com = np.zeros(3) if row.com is None else np.array(row.com)
    about_com = np.zeros((3, 3)) if row.inertia is None else tensor(row.inertia)
    m = about_com + row.mass * ((com @ com) * np.eye(3) - np.outer(com, com))
    six = [m[0, 0], m[1, 1], m[2, 2], m[1, 2], m[0, 2], m[0, 1]]
    return [
        f"body.Mass = {row.mass!r};",
        f"body.CenterOfMass = {_matlab(com)};",
        f"body.Inertia = {_matlab(six)};",
    ]


def _optional(row: DHRow, put: Callable[[str, list[float]], str]) -> list[str]:
    """Limits and inertial parameters in the order of Corke's toolboxes."""
    values: dict[str, Sequence[float] | None] = {
        "qlim": None if row.lower is None or row.upper is None else (row.lower, row.upper),
        "m": None if row.mass is None else (row.mass,),
        "r": row.com,
        "I": row.inertia and [row.inertia[k] for k in (0, 3, 5, 1, 4, 2)],  # diagonal, xy, yz, xz
    }
    return [put(key, list(value)) for key, value in values.items() if value is not None]


def _head(table: DHTable) -> list[str]:
    lines = [f"{table.name}, {table.convention} DH, metres and radians"]
    lines += [text for text in (table.source, table.checked) if text]
    return [one_line(line) for line in lines]


def _matlab(values: Sequence[float] | Array) -> str:
    """A vector or matrix in MATLAB's brackets."""
    array = np.asarray(values, float)
    if array.ndim == 1:
        return "[" + " ".join(repr(float(v)) for v in array) + "]"
    return "[" + "; ".join(" ".join(repr(float(v) + 0.0) for v in row) for row in array) + "]"


CONSTRUCTORS: dict[str, Callable[[DHTable], str]] = {
    "rtb": rtb_python,
    "matlab": matlab_corke,
    "matlab-rst": matlab_rst,
}
"""Names of the formats and their writers."""
