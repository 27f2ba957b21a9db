"""Tables that ship: one YAML file an arm, with its source and the check that it passed."""

from dh2urdf.dh_io.load import list_tables, load_table, load_table_file

__all__ = ["list_tables", "load_table", "load_table_file"]
