"""What the links of a table weigh: as its rows say, or as the bodies drawn for them do."""

from collections.abc import Sequence

import numpy as np

from dh2urdf.conversions.write.bodies import Body
from dh2urdf.conversions.write.inertia import (
    Inertial,
    balanced,
    tensor,
    why_impossible,
    without_noise,
)
from dh2urdf.conversions.write.urdf_options import UrdfOptions
from dh2urdf.dh import DHRow, DHTable
from dh2urdf.transforms import Array


def link_masses(
    table: DHTable, dh: Sequence[Array], bodies: Sequence[list[Body]], options: UrdfOptions
) -> tuple[list[Inertial], list[str]]:
    """Mass properties of base_link and links 1 ... n in their URDF frames, and what was assumed.

    ``dh`` are the DH frames and ``bodies`` the drawn bodies in the frames of the links.
    """
    drawn = [
        Inertial.total(body.inertial(options.density) for body in link).rounded() for link in bodies
    ]
    warnings: list[str] = []
    weighed = drawn[:1]
    for i, row in enumerate(table.joints, 1):
        name = table.joint_names[i - 1]
        weighed.append(_of_link(row, name, dh[i], drawn[i], options.balance_inertia, warnings))
    return weighed, warnings


def _of_link(
    row: DHRow, name: str, T_link_dh: Array, drawn: Inertial, balance: bool, warnings: list[str]
) -> Inertial:
    """Mass properties of a link: as given, or of the drawn bodies."""
    if row.mass is None:
        return drawn
    shape = drawn.scaled(row.mass).rounded()
    com = shape.com if row.com is None else (T_link_dh @ np.array([*row.com, 1.0]))[:3]
    if row.inertia is None:
        return Inertial(row.mass, com, shape.inertia)
    R = T_link_dh[:3, :3]
    possible = _possible(tensor(row.inertia), name, shape.inertia, balance, warnings)
    given = R @ possible @ R.T
    return Inertial(row.mass, com, without_noise(0.5 * (given + given.T)))


def _possible(inertia: Array, name: str, drawn: Array, balance: bool, warnings: list[str]) -> Array:
    """The given tensor, or the nearest that a body could have."""
    why = why_impossible(inertia)
    if not why:
        return inertia
    problem = f"{name}: no body has this inertia tensor, as {why}; "
    if not balance:
        warnings.append(f"{problem}kept as given, MuJoCo and Drake will not take it")
        return inertia
    if np.linalg.eigvalsh(inertia)[-1] <= 0:
        warnings.append(f"{problem}that of the drawn body is written instead")
        return drawn
    warnings.append(
        f"{problem}its two smaller moments were raised (balance_inertia=False, or "
        "--no-balance-inertia, keeps it as given)"
    )
    return balanced(inertia)
