"""DH tables as files: YAML, TOML, JSON, CSV and Markdown, read with care and written whole.

`read_table` and `parse_table` tell all faults of a file at once, each with its line, column
and a hint; `write_table` and `table_to_text` keep every number to the last bit.
"""

from dh2urdf.dh_io.atomic import atomic_write
from dh2urdf.dh_io.expressions import parse_cell
from dh2urdf.dh_io.near_misses import NearMiss, near_misses
from dh2urdf.dh_io.read import FORMATS, TableFile, format_of, parse_table, read_table
from dh2urdf.dh_io.units import SI, Kind, Units
from dh2urdf.dh_io.write import table_to_text, write_table

__all__ = [
    "FORMATS",
    "SI",
    "Kind",
    "NearMiss",
    "TableFile",
    "Units",
    "atomic_write",
    "format_of",
    "near_misses",
    "parse_cell",
    "parse_table",
    "read_table",
    "table_to_text",
    "write_table",
]
