"""OPW parameters as files: the keys of ROS-Industrial's ``opw_parameters_*.yaml``.

Read by ``opw_kinematics`` (C++), ``rs-opw-kinematics`` and others: seven lengths [m], six offsets
[rad], ``deg(-90)`` too, six signs. Names, limits, base and tool are ours.
"""

from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.chain.ortho_parallel import LETTERS, OrthoParallel, Six
from dh2urdf.conversions.assign import chain_to_dh, tidy_angle, tidy_length
from dh2urdf.conversions.forms.parts import (
    Read,
    check_keys,
    joint_names,
    limits,
    limits_of,
    mapping,
    number,
    numbers,
    step,
    step_of,
)
from dh2urdf.dh_io import Kind
from dh2urdf.doors import found
from dh2urdf.exceptions import TableError

LENGTHS = "opw_kinematics_geometric_parameters"
OFFSETS = "opw_kinematics_joint_offsets"
SIGNS = "opw_kinematics_joint_sign_corrections"
OPW_KEYS = (LENGTHS, OFFSETS, SIGNS)
OTHERS = ("name", "joint_names", "lower", "upper", "base", "tool", "dof")

HEAD = """\
OPW parameters [m, rad]: t = sign q - offset is 0 where the arm stands straight up
(Brandstötter, Angerer, Hofbauer 2014; the keys of ROS-Industrial's opw_kinematics)"""


def opw_content(chain: SerialChain, name: str) -> dict[str, Any]:
    """What a file of OPW parameters says of a chain.

    Raises
    ------
    NotOrthoParallelError
    """
    arm = OrthoParallel.of_chain(chain)
    lengths = {key: tidy_length(getattr(arm, key), chain.size) for key in LETTERS}
    offsets = [tidy_angle(offset) for offset in arm.offsets]
    out: dict[str, Any] = {"name": name, LENGTHS: lengths, OFFSETS: offsets}
    out[SIGNS] = list(arm.signs)
    out |= {"joint_names": list(chain.names), **limits_of(chain)}
    ends = {"base": arm.base, "tool": arm.tool}
    return out | {
        key: step_of(T, chain.size) for key, T in ends.items() if not np.array_equal(T, np.eye(4))
    }


def read_opw(content: Mapping[str, Any], name: str) -> Read:
    """The table of a file of OPW parameters.

    Raises
    ------
    TableError
    """
    check_keys(content, (*OPW_KEYS, *OTHERS))
    given = mapping(content[LENGTHS], LENGTHS, LETTERS)
    lengths = {key: number(given.get(key), f"{LENGTHS}.{key}", Kind.LENGTH) for key in LETTERS}
    offsets = numbers(content.get(OFFSETS, [0] * 6), OFFSETS, Kind.ANGLE, 6)
    signs = numbers(content.get(SIGNS, [1] * 6), SIGNS, Kind.NUMBER, 6)
    if any(abs(sign) != 1 for sign in signs):
        raise TableError(f"{SIGNS}: expected 1 or -1 for each joint, got {found(signs)}")
    arm = OrthoParallel(
        **lengths,
        offsets=cast(Six, tuple(offsets)),
        signs=tuple(map(int, signs)),
        base=step(content.get("base", {}), "base"),
        tool=step(content.get("tool", {}), "tool"),
    )
    chain = arm.chain(joint_names(content, 6), *limits(content, [Kind.ANGLE] * 6))
    table = chain_to_dh(chain, name=content.get("name") or name, signs=arm.signs).table
    return table, ()
