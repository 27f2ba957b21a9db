"""DH tables as files: YAML, TOML, JSON, CSV and Markdown, read with care and written whole.

`read_table` and `parse_table` tell all faults of a file at once, each with its line, column
and a hint; `write_table` and `table_to_text` keep every number to the last bit. They write LaTeX
and HTML for people, too.

Keys of a file
    ``convention`` and ``units: {length, angle}`` have no default. ``name``, ``source``,
    ``checked``, ``constants``, ``base: {xyz, rpy}`` and ``tool: {xyz, rpy}`` may be left out.
    ``joints`` is the list of rows. Where a file does not say convention and units, the caller
    may (`told`).
Keys of a row
    ``theta``, ``d``, ``a``, ``alpha`` at q = 0 (the one that the joint moves may be left out),
    ``name``, ``type`` (revolute, prismatic, fixed), ``sign``, ``lower``, ``upper``,
    ``velocity``, ``effort``, ``damping``, ``friction``, ``mass``, ``com``,
    ``inertia: [ixx, ixy, ixz, iyy, iyz, izz]``, ``inertia_frame: com | link``; a fixed row may
    have ``xyz`` and ``rpy`` instead of the four parameters.
Units
    Bare numbers of lengths and angles are in the file's units; velocities are in these per
    second, by the joint's type. Mass [kg], inertia [kg m^2], effort [N m or N], damping and
    friction are SI in every file.
Cells
    Numbers and expressions (`dh2urdf.dh_io.cells.expressions`). ``theta: theta3 + 90`` and
    ``d: 2 - q2`` show the joint's own variable; that gives the type and the sign.
CSV and Markdown
    A header row in any order, ``key: value`` lines around it (`dh2urdf.dh_io.formats.grid`).
Messages
    ``joints[3].alpha`` is the third row of the file, counted from 1.
"""

from dh2urdf.dh_io.atomic import atomic_write, refuse_foreign, refuse_unwritable
from dh2urdf.dh_io.cells.expressions import parse_cell
from dh2urdf.dh_io.cells.told import Told, told
from dh2urdf.dh_io.cells.units import SI, Kind, Units
from dh2urdf.dh_io.load import TableLike, as_table
from dh2urdf.dh_io.near_misses import NearMiss, near_misses
from dh2urdf.dh_io.read import FORMATS, TableFile, format_of, parse_table, read_table
from dh2urdf.dh_io.write import READ_BACK, WRITTEN, table_to_text, usual_units, write_table
