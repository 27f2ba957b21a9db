"""Calibrated arms of Universal Robots: the driver's ``calibration.yaml``, ``calibration.conf``.

The controller's file has deltas, a number a joint, that add to the nominal DH table
(``[mounting]``: delta_theta, delta_a, delta_d, delta_alpha; [rad] and [m]). The driver's file has
six steps, each before the joint of its name, all joints at zero::

    T_base_tool = step_1 Z(q_1) step_2 Z(q_2) ... step_6 Z(q_6)
    step_i = Trans(x, y, z) Rot_x(roll) Rot_y(pitch) Rot_z(yaw)

That is the order in which ``ur_calibration`` (Universal_Robots_ROS2_Driver 2.4.6, calibration.cpp,
``eulerAngles(0, 1, 2)``) takes them from the controller's parameters. ``ur_description`` reads the
same numbers as a URDF does, ``Rot_z Rot_y Rot_x``; how far that moves the tool is told. The base
is the controller's (ROS: ``base``), the tip is ``tool0``.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.forms.parts import Read, mapping, number
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh import DHTable, JointType
from dh2urdf.dh_io import Kind, as_table
from dh2urdf.doors import choice, finite_array, found
from dh2urdf.exceptions import TableError
from dh2urdf.transforms import Array

MODELS = ("ur3", "ur3e", "ur5", "ur5e", "ur10", "ur10e", "ur16e", "ur20", "ur30")
"""Nominal tables, by the names under which they ship."""

LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
CELLS = ("x", "y", "z", "roll", "pitch", "yaw")

NEAR = 0.03
"""Distance [m] by which a calibration may move the tool; makers speak of centimetres."""

CLEAR = 4.0
"""How many times farther from its nominal arm the next model is, where one alone fits."""


def read_kinematics(content: Mapping[str, Any], name: str) -> Read:
    """The table of the driver's ``kinematics``, and what there is to say of it.

    Raises
    ------
    TableError
    """
    links = mapping(content["kinematics"], "kinematics", (*LINKS, "hash"))
    numbers = [_numbers(links, link) for link in LINKS]
    chain, urdf = (_chain([_step(row, order) for row in numbers]) for order in ("xyz", "zyx"))
    notes = []
    if (apart := _apart(chain, urdf)) > 1e-6:
        notes.append(
            f"{name}: roll, pitch, yaw are turned in this order, as ur_calibration wrote them: the "
            "arm is the controller's; ur_description turns them in the order of a URDF, which "
            f"puts the tool up to {apart * 1000:.2g} mm elsewhere"
        )
    misses = {model: _apart(dh_to_chain(as_table(model)), chain) for model in MODELS}
    model = min(misses, key=misses.__getitem__)
    table = chain_to_dh(chain, name=name).table
    if misses[model] > NEAR:
        notes.append(f"{name}: no UR that ships has these lengths: ranges are +-360 degrees")
        return table, tuple(notes)
    notes.append(f"{name}: the lengths are those of {model}, whose limits and speeds it has")
    source = f"calibration of a {model} by ur_calibration, {links.get('hash', 'no hash')}"
    return _driven(replace(table, source=source), as_table(model)), tuple(notes)


def _numbers(links: Mapping[str, Any], link: str) -> list[float]:
    """x, y, z [m] and roll, pitch, yaw [rad] of a link."""
    what = f"kinematics.{link}"
    cells = mapping(links.get(link), what, CELLS)
    kinds = [Kind.LENGTH] * 3 + [Kind.ANGLE] * 3
    return [number(cells.get(c), f"{what}.{c}", k) for c, k in zip(CELLS, kinds, strict=True)]


def _step(numbers: Sequence[float], order: str) -> Array:
    """A step of the driver's file, turned about the axes in an order, shape (4, 4)."""
    turns = dict(zip("xyz", (f(v) for f, v in zip(TURNS, numbers[3:], strict=True)), strict=True))
    return tf.product(tf.trans(*numbers[:3]), *(turns[axis] for axis in order))


TURNS = (tf.rot_x, tf.rot_y, tf.rot_z)


def _chain(steps: Sequence[Array]) -> SerialChain:
    """The chain of six steps, joints about z, ranges of a turn either way."""
    return SerialChain(
        links=np.stack([*steps, np.eye(4)]),
        joint_types=(JointType.REVOLUTE,) * 6,
        names=tuple(f"{joint}_joint" for joint in JOINTS),
        lower=np.full(6, -2.0 * math.pi),
        upper=np.full(6, 2.0 * math.pi),
    )


def _apart(a: SerialChain, b: SerialChain) -> float:
    """Largest distance [m] between the tools of two arms over a few configurations."""
    draws = np.random.default_rng(0).uniform(-math.pi, math.pi, (16, 6))
    return max(math.dist(a.fk(q)[:3, 3], b.fk(q)[:3, 3]) for q in draws)


def _driven(table: DHTable, nominal: DHTable) -> DHTable:
    """The table with the limits and speeds of the nominal one."""
    keys = ("lower", "upper", "velocity", "effort")
    rows, drives = list(table.rows), iter(nominal.joints)
    for i, row in enumerate(rows):
        if row.is_joint:
            drive = next(drives)
            rows[i] = replace(row, **{key: getattr(drive, key) for key in keys})
    return replace(table, rows=tuple(rows))


def read_conf(text: str, name: str, model: str | None = None) -> Read:
    """The table of the controller's file: the nominal one of a model plus the deltas.

    The model is the one given here, that of a line ``model = ur5e`` in the file, or else the only
    one that the deltas leave near its nominal arm.

    Raises
    ------
    TableError
    """
    cells = _cells(text)
    rows = {key: _deltas(cells, f"delta_{key}") for key in ("theta", "d", "a", "alpha")}
    given = model if model is not None else cells.get("model")
    if given is not None:
        choice(given, "model", MODELS, TableError)
    tables = {m: _corrected(as_table(m), rows) for m in ([given] if given else MODELS)}
    misses = {
        m: _apart(dh_to_chain(as_table(m)), dh_to_chain(table)) for m, table in tables.items()
    }
    best, *others = sorted(misses, key=misses.__getitem__)
    if others and not (misses[best] < NEAR and misses[others[0]] > CLEAR * misses[best]):
        raise TableError(_which(misses))
    how = "given" if given else "the only UR that the deltas fit"
    notes = [f"{name}: the deltas are added to the nominal table of {best} ({how})"]
    if misses[best] > NEAR:
        notes.append(
            f"{name}: they move the tool by {misses[best]:.2g} m from the nominal {best}; are they "
            "of another model?"
        )
    source = f"calibration.conf, deltas added to the nominal table of {best}"
    table = replace(tables[best], name=name, source=source, checked="")
    return table, tuple(notes)


def _which(misses: Mapping[str, float]) -> str:
    """Ask for the model, with how far each is from its nominal arm."""
    near = [m for m in MODELS if misses[m] < NEAR] or list(MODELS)
    far = ", ".join(f"{m} {misses[m] * 1000:.2g} mm" for m in near)
    return (
        "model: the file has deltas and does not say of which UR; they move the tool from the "
        f"nominal arm by {far}\n"
        f"  hint: --model {near[0]}, or a line 'model = {near[0]}' in the file"
    )


def _cells(text: str) -> dict[str, str]:
    """Keys of all sections; comments begin with #."""
    import configparser

    parser = configparser.ConfigParser(interpolation=None, inline_comment_prefixes=("#",))
    try:
        parser.read_string(text)
    except configparser.Error as error:
        raise TableError(f"not a calibration.conf: {' '.join(str(error).split())}") from None
    return {key: cell.strip() for section in parser.values() for key, cell in section.items()}


def _deltas(cells: Mapping[str, str], key: str) -> list[float]:
    """Six numbers of a key."""
    expected = "six numbers in brackets, as of UR's calibration.conf"
    if key not in cells:
        raise TableError(f"{key}: missing; {expected}")
    try:
        values = json.loads(cells[key])
    except ValueError:
        values = cells[key]
    numbers = finite_array(values, key, expected, TableError)
    if numbers.shape != (6,):
        raise TableError(f"{key}: expected {expected}, got {found(values)}")
    return numbers.tolist()  # type: ignore[no-any-return]


def _corrected(nominal: DHTable, deltas: Mapping[str, Sequence[float]]) -> DHTable:
    """The nominal table with deltas added, row by row."""
    rows = tuple(
        replace(row, **{key: getattr(row, key) + deltas[key][i] for key in deltas})
        for i, row in enumerate(nominal.rows)
    )
    return replace(nominal, rows=rows)
