"""From a Denavit-Hartenberg table to a verified URDF and every inverse-kinematics solution.

>>> import dh2urdf
>>> table = dh2urdf.load_table("denso_vs6556")
>>> robot = dh2urdf.Robot.from_dh(table)
>>> robot.fk([0, 0, 0, 0, 0, 0]).shape
(4, 4)

Importing this package loads nothing else; NumPy comes with the first name that is asked for,
Pinocchio with the first model.
"""

from importlib import import_module

from dh2urdf import exceptions
from dh2urdf.exceptions import Dh2UrdfError

TYPE_CHECKING = False
if TYPE_CHECKING:
    from dh2urdf import transforms
    from dh2urdf.chain import SerialChain
    from dh2urdf.checks.rules import check_urdf
    from dh2urdf.comparison import Comparison, compare
    from dh2urdf.conversions.assign import to_convention
    from dh2urdf.conversions.write import (
        ConversionReport,
        UrdfOptions,
        urdf_text,
        write_mjcf,
        write_urdf,
    )
    from dh2urdf.dh import (
        DHConvention,
        DHRow,
        DHTable,
        JointType,
        Mimic,
        Origin,
        dh_factors,
        dh_transform,
    )
    from dh2urdf.dh.reach import dh_parameters
    from dh2urdf.dh_io import write_table as save_table
    from dh2urdf.export.source import Exported, export_solver
    from dh2urdf.extract import Extraction, extract_dh
    from dh2urdf.ik.families import planar_reach, planar_rr_ik, planar_rrr_ik, wrist_centre
    from dh2urdf.ik.problem import IKBatch, IKPath, IKSolutions
    from dh2urdf.robot import Robot
    from dh2urdf.robots import list_tables, load_table

__version__ = "0.2.0"

_LATE = {
    name: (f"dh2urdf.{module}", name)
    for module, names in {
        "chain": "SerialChain",
        "checks.rules": "check_urdf",
        "comparison": "Comparison compare",
        "conversions.assign": "to_convention",
        "conversions.write": "ConversionReport UrdfOptions urdf_text write_mjcf write_urdf",
        "dh": "DHConvention DHRow DHTable JointType Mimic Origin dh_factors dh_transform",
        "dh.reach": "dh_parameters",
        "export.source": "Exported export_solver",
        "extract": "Extraction extract_dh",
        "ik.families": "planar_reach planar_rr_ik planar_rrr_ik wrist_centre",
        "ik.problem": "IKBatch IKPath IKSolutions",
        "robot": "Robot",
        "robots": "list_tables load_table",
    }.items()
    for name in names.split()
}
_LATE |= {"save_table": ("dh2urdf.dh_io", "write_table"), "transforms": ("dh2urdf.transforms", "")}
"""Public names whose modules are imported when they are first asked for."""

__all__ = [
    "Comparison",
    "ConversionReport",
    "DHConvention",
    "DHRow",
    "DHTable",
    "Dh2UrdfError",
    "Exported",
    "Extraction",
    "IKBatch",
    "IKPath",
    "IKSolutions",
    "JointType",
    "Mimic",
    "Origin",
    "Robot",
    "SerialChain",
    "UrdfOptions",
    "check_urdf",
    "compare",
    "dh_factors",
    "dh_parameters",
    "dh_transform",
    "exceptions",
    "export_solver",
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
    "write_mjcf",
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
