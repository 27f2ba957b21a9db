"""``dh2urdf fk``: where the tip is."""

import math

import numpy as np

from dh2urdf.cli.options import Arm, Json, Link, Values
from dh2urdf.cli.output import (
    emit,
    emit_json,
    matrix_text,
    parse_configuration,
    robot_of,
    ten_digits,
)
from dh2urdf.cli.progress import note
from dh2urdf.cli.reading import DEFAULT, Reading
from dh2urdf.dh_io.files import shown
from dh2urdf.transforms import matrix_to_rpy


def fk_(
    robot: Arm,
    /,
    *values: str,
    q: Values = None,
    deg: bool = False,
    base: Link = None,
    tip: Link = None,
    reading: Reading = DEFAULT,
    json: Json = False,
) -> None:
    """Place the tip: forward kinematics of a table or a URDF.

    Parameters
    ----------
    values
        Joint values: radians (degrees with --deg) and metres; 90deg, 120mm, -pi/2 also do.
    q
        The same as an option: --q=0,-pi/2,90deg.
    deg
        Bare angles are degrees, and the orientation is shown in degrees.
    """
    arm = robot_of(robot, base, tip, reading)
    config = parse_configuration([*values, *(q or [])], arm, deg=deg)
    T = arm.fk(config)
    rpy = matrix_to_rpy(T)
    over = np.flatnonzero((config < arm.lower) | (config > arm.upper))
    outside = [arm.joint_names[k] for k in over]
    if json:
        ends, pose = {"base": arm.base, "tip": arm.tip}, {"xyz": T[:3, 3], "rpy": rpy}
        emit_json("fk", **ends, q=config, T_base_tip=T, **pose, outside_limits=outside)
        return
    if outside:
        note(f"warning: outside the joint limits: {', '.join(map(shown, outside))}")
    angles = [math.degrees(a) for a in rpy] if deg else list(rpy)
    emit(f"{shown(arm.tip)} in {shown(arm.base)}:\n{matrix_text(T)}")
    emit(f"xyz [m]: {'  '.join(map(ten_digits, T[:3, 3]))}")
    emit(f"rpy [{'deg' if deg else 'rad'}]: {'  '.join(map(ten_digits, angles))}")
