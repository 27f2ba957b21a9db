"""Rules of URDF files, a module a subject, and the table of them all."""

from dh2urdf.checks.rules.table import RULES, check_urdf

__all__ = ["RULES", "check_urdf"]
