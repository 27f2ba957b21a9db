"""Denavit-Hartenberg tables: a row (`row`), its two motions (`motions`), the table (`table`).

Joints that follow others: `mimic` of a row, `coupling` of all.
"""

from dh2urdf.dh.coupling import JointMap
from dh2urdf.dh.mimic import Couplings, Mimic
from dh2urdf.dh.motions import DHConvention, dh_factors, dh_transform
from dh2urdf.dh.row import DHRow, JointType, Origin
from dh2urdf.dh.table import DHTable

__all__ = [
    "Couplings",
    "DHConvention",
    "DHRow",
    "DHTable",
    "JointMap",
    "JointType",
    "Mimic",
    "Origin",
    "dh_factors",
    "dh_transform",
]
