"""Arms of the sweeps: chains made of a table by the DH product of the tests, nothing shared."""

from typing import NamedTuple

import numpy as np
from dh_product import rigid, row_matrix, shift, turn

FLIP = np.diag([1.0, -1.0, -1.0, 1.0])
"""Half a turn about x: between two of them a joint turns or slides the other way."""


class DHArm(NamedTuple):
    """What the referee's kinematics take: ``T = links[0] Z(q1) links[1] ... Z(qn) links[n]``."""

    links: np.ndarray
    prismatic: np.ndarray
    size: float

    @property
    def n(self):
        """Number of joints."""
        return len(self.prismatic)


def arm_of(table):
    """The chain of a table."""
    links, slides, modified = [rigid(table.base.xyz, table.base.rpy)], [], False
    modified = table.convention == "modified"
    for row in table.rows:
        if row.joint_type == "fixed":
            links[-1] = links[-1] @ row_matrix(row, 0.0, modified)
            continue
        joint, along, link = turn(2, row.theta), shift(2, row.d), shift(0, row.a)
        link = link @ turn(0, row.alpha)
        before, after = (link @ joint, along) if modified else (joint, along @ link)
        flip = FLIP if row.sign < 0 else np.eye(4)
        links[-1] = links[-1] @ before @ flip
        links.append(flip @ after)
        slides.append(row.joint_type == "prismatic")
    links[-1] = links[-1] @ rigid(table.tool.xyz, table.tool.rpy)
    links = np.stack(links)
    size = float(np.linalg.norm(links[:, :3, 3], axis=1).sum()) or 1.0
    return DHArm(links, np.array(slides), size)
