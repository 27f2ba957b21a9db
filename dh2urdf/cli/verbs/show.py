"""``dh2urdf show``: a table, its transforms, and how its inverse kinematics is solved."""

from json import loads
from typing import Any, Literal

import numpy as np

from dh2urdf.cli.options import Deg, Digits, Json, Values
from dh2urdf.cli.output import (
    emit,
    emit_file,
    emit_json,
    matrix_text,
    noted,
    parse_configuration,
    read_any,
)
from dh2urdf.cli.reading import AS_READ, Writing
from dh2urdf.conversions.assign import in_convention
from dh2urdf.dh import DHTable
from dh2urdf.dh.quoting import one_line
from dh2urdf.dh.variables import coupled_words
from dh2urdf.dh_io import table_to_text
from dh2urdf.exceptions import NoSolverError
from dh2urdf.grids import number
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array


def show_(
    table: str,
    /,
    *values: str,
    q: Values = None,
    deg: Deg = False,
    symbolic: bool = False,
    format: Literal["text", "yaml", "toml", "json", "csv", "markdown", "latex", "html"] = "text",
    digits: Digits = None,
    writing: Writing = AS_READ,
    json: Json = False,
) -> None:
    """Print a table, each of its transforms, their product, and its solver.

    Parameters
    ----------
    table
        A table file, the name of a table that ships, or a URDF, xacro or MJCF for the table that
        `extract` finds; - for stdin.
    values
        Joint values for the transforms; default: all zero.
    q
        The same as an option: --q=0,-pi/2,90deg.
    symbolic
        The transforms in symbols too (extra symbolic).
    format
        Of the table alone: text, which goes with the transforms; yaml, toml, json, csv and
        markdown, which read back as the same table; latex and html.
    digits
        Decimals of the table's lengths and angles; default: as few as keep them exact.
    """
    given = noted(read_any(table, writing))
    dh, _ = in_convention(given.table, writing.convention)
    arm, units = Robot.from_dh(dh), writing.units_of(dh, format, given.units)
    text = table_to_text(dh, format, units, digits)
    if format != "text" and not json:
        emit_file(text)
        return
    cells = [*values, *(q or [])]
    config = parse_configuration(cells, arm, deg=deg) if cells else np.zeros(arm.n)
    joints = arm.chain_configuration(config)
    try:
        name, why = str(arm.solver), arm.solver.explain()
    except NoSolverError as error:
        name, why = "none", str(error)
    if dh.joint_map is not None:
        words = coupled_words(dh.joint_names, dh.joint_map)
        why = why if words in why else f"{words}\n{why}"
    if json:
        solver = {"joint_names": arm.joint_names, "solver": name, "solver_explained": why}
        told = {"text": text} if format != "text" else {}
        emit_json(
            "show",
            **_table(dh, config, joints),
            **solver,
            **(_symbols(dh) if symbolic else {}),
            **told,
        )
        return
    emit(text)
    for label, text in (("source", dh.source), ("checked", dh.checked)):
        if text:
            emit(f"\n{label}: {' '.join(one_line(text).split())}")
    _show_transforms(dh, config, joints)
    if symbolic:
        _show_symbols(dh)
    emit(f"\ninverse kinematics: {name}\n{why}")


def _show_transforms(dh: DHTable, config: Array, joints: Array) -> None:
    shown, moved = (", ".join(number(float(f"{v:.10g}")) for v in q) for q in (config, joints))
    emit(f"\nat q = ({shown}){f', joints at ({moved})' * (dh.joint_map is not None)}:")
    for i, T in enumerate(dh.transforms(joints), 1):
        emit(f"\nH_{i}^{i - 1} =\n{matrix_text(T)}")
    frames = dh.frames(joints)
    emit(f"\nH_{dh.n}^0 =\n{matrix_text(np.linalg.inv(frames[0]) @ frames[-1])}")
    if not (dh.tool.is_identity and np.array_equal(frames[0], np.eye(4))):
        emit(f"\nT_base_tool =\n{matrix_text(dh.fk(joints))}")


def _table(dh: DHTable, config: Array, joints: Array) -> dict[str, Any]:
    """A table and its transforms as JSON has them."""
    return {
        "name": dh.name,
        "convention": str(dh.convention),
        "source": dh.source,
        "checked": dh.checked,
        "q": config,
        "joints": joints,
        "transforms": dh.transforms(joints),
        "T_base_tool": dh.fk(joints),
        "table": loads(table_to_text(dh, "json")),
    }


def _symbols(dh: DHTable) -> dict[str, Any]:
    """The transforms and their product in symbols, each cell an expression of SymPy."""
    from dh2urdf.symbolic import symbolic_product, symbolic_transforms

    each = [*symbolic_transforms(dh), symbolic_product(dh)]
    *transforms, product = ([list(map(str, row)) for row in H.tolist()] for H in each)
    return {"symbolic_transforms": transforms, "symbolic_product": product}


def _show_symbols(dh: DHTable) -> None:
    from dh2urdf.symbolic import symbolic_product, symbolic_text, symbolic_transforms

    emit("\nin symbols, c1 = cos(q_1), s12 = sin(q_1 + q_2):")
    for i, H in enumerate(symbolic_transforms(dh), 1):
        emit(f"\nH_{i}^{i - 1} =\n{symbolic_text(H)}")
    emit(f"\nH_{dh.n}^0 =\n{symbolic_text(symbolic_product(dh))}")
