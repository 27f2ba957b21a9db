"""From a Denavit-Hartenberg table to a verified URDF and every inverse-kinematics solution.

>>> import dh2urdf
>>> table = dh2urdf.load_table("denso_vs6556")
>>> robot = dh2urdf.Robot.from_dh(table)
>>> robot.fk([0, 0, 0, 0, 0, 0]).shape
(4, 4)

Importing this package loads nothing else; NumPy comes with the first name that is asked for,
Pinocchio with the first model, Numba with the first array of configurations or the first inverse
kinematics.
"""

from __future__ import annotations

from importlib import import_module

from dh2urdf import exceptions
from dh2urdf.exceptions import Dh2UrdfError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from dh2urdf import transforms
    from dh2urdf.chain import SerialChain
    from dh2urdf.checks.rules import check_urdf
    from dh2urdf.conversions.assign import to_convention
    from dh2urdf.conversions.write import ConversionReport, UrdfOptions, urdf_text, write_urdf
    from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType, Origin, dh_factors, dh_transform
    from dh2urdf.dh.reach import dh_parameters
    from dh2urdf.dh_io import write_table as save_table
    from dh2urdf.extract import Extraction, extract_dh
    from dh2urdf.ik.families import planar_reach, planar_rr_ik, planar_rrr_ik, wrist_centre
    from dh2urdf.ik.problem import IKBatch, IKPath, IKSolutions
    from dh2urdf.robot import Robot
    from dh2urdf.robots import list_tables, load_table

__version__ = "0.1.0"

_LATE = {
    **{
        name: ("dh2urdf.dh", name)
        for name in (
            *("DHConvention", "DHRow", "DHTable", "JointType", "Origin"),
            *("dh_factors", "dh_transform"),
        )
    },
    "dh_parameters": ("dh2urdf.dh.reach", "dh_parameters"),
    "transforms": ("dh2urdf.transforms", ""),
    "ConversionReport": ("dh2urdf.conversions.write", "ConversionReport"),
    "Extraction": ("dh2urdf.extract", "Extraction"),
    "IKBatch": ("dh2urdf.ik.problem", "IKBatch"),
    "IKPath": ("dh2urdf.ik.problem", "IKPath"),
    "IKSolutions": ("dh2urdf.ik.problem", "IKSolutions"),
    "Robot": ("dh2urdf.robot", "Robot"),
    "SerialChain": ("dh2urdf.chain", "SerialChain"),
    "UrdfOptions": ("dh2urdf.conversions.write", "UrdfOptions"),
    "check_urdf": ("dh2urdf.checks.rules", "check_urdf"),
    "extract_dh": ("dh2urdf.extract", "extract_dh"),
    "list_tables": ("dh2urdf.robots", "list_tables"),
    "load_table": ("dh2urdf.robots", "load_table"),
    "planar_reach": ("dh2urdf.ik.families", "planar_reach"),
    "planar_rr_ik": ("dh2urdf.ik.families", "planar_rr_ik"),
    "planar_rrr_ik": ("dh2urdf.ik.families", "planar_rrr_ik"),
    "save_table": ("dh2urdf.dh_io", "write_table"),
    "to_convention": ("dh2urdf.conversions.assign", "to_convention"),
    "urdf_text": ("dh2urdf.conversions.write", "urdf_text"),
    "wrist_centre": ("dh2urdf.ik.families", "wrist_centre"),
    "write_urdf": ("dh2urdf.conversions.write", "write_urdf"),
}
"""Public names whose modules are imported when they are first asked for."""

__all__ = [
    "ConversionReport",
    "DHConvention",
    "DHRow",
    "DHTable",
    "Dh2UrdfError",
    "Extraction",
    "IKBatch",
    "IKPath",
    "IKSolutions",
    "JointType",
    "Origin",
    "Robot",
    "SerialChain",
    "UrdfOptions",
    "check_urdf",
    "dh_factors",
    "dh_parameters",
    "dh_transform",
    "exceptions",
    "extract_dh",
    "list_tables",
    "load_table",
    "planar_reach",
    "planar_rr_ik",
    "planar_rrr_ik",
    "save_table",
    "to_convention",
    "transforms",
    "urdf_text",
    "wrist_centre",
    "write_urdf",
]


def __getattr__(name: str) -> object:
    if name not in _LATE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    path, attribute = _LATE[name]
    module = import_module(path)
    value = getattr(module, attribute) if attribute else module
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
