"""A written URDF loaded back by Pinocchio and compared with the DH product, frame by frame."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin

from dh2urdf.conversions.dh_to_urdf import default_limits
from dh2urdf.dh import DHTable, JointType
from dh2urdf.exceptions import VerificationError
from dh2urdf.transforms import Array, pose_error

__all__ = ["LARGEST_ERROR", "allowed_error", "random_configurations", "verify_urdf_text"]

LARGEST_ERROR = 1e-9
"""Largest FK difference [m and rad] with which a file may be written."""


def allowed_error(table: DHTable, digits: int | None) -> float:
    """Largest difference [m and rad] with which the file may be written.

    1e-9 where floats are whole; where they are rounded on request, what rounding every origin
    by half a last digit in each direction can add up to at the tip.
    """
    if digits is None:
        return LARGEST_ERROR
    return 0.5 * math.sqrt(3) * 10.0**-digits * (table.n + 2) * (2.0 + table.length) + LARGEST_ERROR


def random_configurations(table: DHTable, count: int, seed: int = 0) -> Array:
    """Configurations within the limits, at most one turn each way, shape (count, n)."""
    rng = np.random.default_rng(seed)
    bounds = np.array([default_limits(row, table) for row in table.joints])
    turns = np.array([row.joint_type is JointType.REVOLUTE for row in table.joints])
    low = np.where(turns, np.maximum(bounds[:, 0], -2 * np.pi), bounds[:, 0])
    high = np.where(turns, np.minimum(bounds[:, 1], 2 * np.pi), bounds[:, 1])
    return rng.uniform(low, np.maximum(low, high), size=(count, table.n))


def verify_urdf_text(
    text: str, table: DHTable, count: int = 16, allowed: float = LARGEST_ERROR
) -> float:
    """Largest difference [m and rad] between the file's frames and the DH product.

    Every ``dh_i`` frame that the file has, and ``tool0``, over ``count`` random configurations.

    Raises
    ------
    VerificationError
        The file does not load, or differs by more than is allowed.
    """
    try:
        model = pin.buildModelFromXML(text)
    except (ValueError, RuntimeError) as error:
        raise VerificationError(f"Pinocchio does not load the written file: {error}") from None
    data = model.createData()
    order = [model.joints[model.getJointId(name)].idx_q for name in table.joint_names]
    names = [f"dh_{i}" for i in range(table.n + 1)]
    body = pin.FrameType.BODY
    present = [i for i, name in enumerate(names) if model.existFrame(name, body)]
    ids = [model.getFrameId(names[i], body) for i in present]
    tip = model.getFrameId("tool0", body)
    largest = 0.0
    for q in random_configurations(table, count):
        q_model = np.empty(model.nq)
        q_model[order] = q
        pin.framesForwardKinematics(model, data, q_model)
        frames = table.frames(q)
        expected = [*frames[present], frames[-1] @ table.tool.matrix]
        placed = [data.oMf[k].homogeneous for k in [*ids, tip]]
        largest = max(largest, pose_error(np.stack(placed), np.stack(expected)))
    if not largest <= allowed:
        raise VerificationError(
            f"{table.name}: the written file differs from the DH product by {largest:.3g} "
            f"(allowed {allowed:.0e})"
        )
    return largest
