"""Tables that ship: one YAML file an arm, with its source and the check that it passed."""

from dh2urdf.dh_io.load import load_table, load_table_file
from dh2urdf.dh_io.names import list_tables, other_names

__all__ = ["list_tables", "load_table", "load_table_file", "other_names"]
