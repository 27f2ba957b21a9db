"""Denavit-Hartenberg tables: a row (`row`), its two motions (`motions`), the table (`table`)."""

from dh2urdf.dh.motions import DHConvention, dh_factors, dh_transform
from dh2urdf.dh.row import DHRow, JointType, Origin
from dh2urdf.dh.table import DHTable

__all__ = ["DHConvention", "DHRow", "DHTable", "JointType", "Origin", "dh_factors", "dh_transform"]
