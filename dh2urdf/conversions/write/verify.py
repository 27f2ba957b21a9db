"""A written URDF loaded back by Pinocchio and compared with the DH product, frame by frame."""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pinocchio as pin

from dh2urdf.conversions.write.table_file import COARSE, arm_size, random_configurations
from dh2urdf.conversions.write.urdf_elements import default_limits
from dh2urdf.dh import DHTable
from dh2urdf.exceptions import VerificationError
from dh2urdf.transforms import Array, pose_error

LARGEST_ERROR = 1e-9
"""Largest FK difference [rad, and m per m of arm beyond 1 m] of a file with whole floats."""


def verify_urdf_text(
    text: str, table: DHTable, count: int = 16, digits: int | None = None
) -> float:
    """Largest difference [m and rad] between the file's frames and the DH product.

    Every ``dh_i`` frame that the file has, and ``tool0``, over ``count`` random configurations;
    limits are compared too. An error where it is more than rounding to ``digits`` explains, or
    than a rounded file of any use has.
    """
    try:
        model = pin.buildModelFromXML(text)
    except (ValueError, RuntimeError) as error:
        raise VerificationError(f"Pinocchio does not load the written file: {error}") from None
    data = model.createData()
    order = [model.joints[model.getJointId(name)].idx_q for name in table.joint_names]
    limits = np.stack([model.lowerPositionLimit, model.upperPositionLimit], axis=1)[order]
    body = pin.FrameType.BODY
    present = [i for i in range(table.n + 1) if model.existFrame(f"dh_{i}", body)]
    ids = [model.getFrameId(name, body) for name in [*(f"dh_{i}" for i in present), "tool0"]]

    def place(q: Array) -> Array:
        pin.framesForwardKinematics(model, data, q[np.argsort(order)])
        return np.stack([data.oMf[k].homogeneous for k in ids])

    return compare_with_table(table, limits, present, place, digits, count)


def compare_with_table(
    table: DHTable,
    limits: Array,
    present: Sequence[int],
    place: Callable[[Array], Array],
    digits: int | None = None,
    count: int = 16,
) -> float:
    """Largest difference [m and rad] between a written file, as its reader has it, and the table.

    ``limits`` (n, 2) are those that the reader found; ``place`` puts the DH frames of the numbers
    ``present`` and the tool, (k + 1, 4, 4), where they are at q (n,).
    """
    _check_limits(limits, table, 0.0 if digits is None else 0.5 * 10.0**-digits)
    size = arm_size(table) if digits is not None else max(1.0, arm_size(table))
    largest = relative = 0.0
    for q in random_configurations(table, count):
        frames, placed = table.frames(q), place(q)
        expected = np.stack([*frames[present], frames[-1] @ table.tool.matrix])
        largest = max(largest, pose_error(placed, expected))
        for T in (placed, expected):
            T[:, :3, 3] /= size
        relative = max(relative, pose_error(placed, expected))
    allowed, hint = LARGEST_ERROR, ""
    if digits is not None:
        share = math.sqrt(3) * 10.0**-digits * (table.n + 2) * (1.0 + 0.5 * table.length) / size
        allowed, hint = min(allowed + share, COARSE), f" with {digits} decimals; give more digits"
    if not relative <= allowed:
        raise VerificationError(
            f"{table.name}: the written file differs from the DH product by {largest:.3g} m or "
            f"rad, {relative:.3g} of the arm (allowed {allowed:.3g}){hint}"
        )
    return largest


def _check_limits(limits: Array, table: DHTable, slack: float) -> None:
    """Compare the limits that were read with the table's."""
    for i, (name, read) in enumerate(zip(table.joint_names, limits.tolist(), strict=True)):
        low, high = wanted = default_limits(table, i)
        close = np.allclose(read, wanted, rtol=1e-15, atol=slack)
        if not close or read[0] > read[1] or (read[0] == read[1] and low < high):
            raise VerificationError(
                f"{table.name}: {name} has the limits {read[0]:g} to {read[1]:g} in the written "
                f"file, {low:g} to {high:g} in the table"
            )
