"""Every bound on what is taken in: numbers, sizes, depths and counts, each with its reason.

A bound is met where something enters: a file, a cell, an argument, an option. What lies beyond is
refused with a message that names it; nothing inside has to ask again.
"""

# Numbers

LENGTH = 1e9
"""Largest length [m]: beyond it sixteen digits no longer hold a micrometre."""

ANGLE = 1e5
"""Largest angle [rad], some 16,000 turns: the rounding of it, 7e-12, is still far below the
residual of 1e-9 that a solution may have."""

NUMBER = 1e30
"""Largest number of any other kind: squares and products of it are still floats."""

RATIO = 1e6
"""Largest multiplier of a joint that follows another or adds to it: rounding of so many turns is
seen in the eleventh digit."""

COUPLED = 1e6
"""Largest condition, the spectral radius of ``|C^-1| |C|``, of the matrix by which values move
coupled joints: the values of a turn then are millions of turns, which round to 1e-9."""

INERTIA = 1e29
"""Largest entry of an inertia tensor [kg m^2]: in other axes it may be three times as large."""

# Arms

JOINTS = 60
"""Joints of a chain: those free along a singular family are the bits of one 64-bit word."""

ROWS = 500
"""Rows of a table, fixed ones included: eight to a joint."""

LINKS = 2_000
"""Links of a robot description, ten times a humanoid with both hands: Pinocchio's reader descends
a level per link, and ends the process some thousand further on."""

SNAP = 0.1
"""Tolerance [rad and m] within which numbers are set right; a larger one would make another arm."""

# Files

TABLE_BYTES = 1_000_000
"""A table file; one of 60 joints with everything given has 20 kB."""

ROBOT_BYTES = 5_000_000
"""A robot description without its meshes; makers' largest have 1 MB."""

POSES_BYTES = 100_000_000
"""A file of poses: a million rows."""

DEPTH = 16
"""Brackets within brackets of a table file, which needs four."""

NODES = 20_000
"""Cells of a table file; a hundred rows with everything given have some 3000."""

CELL_CHARACTERS = 200
"""Text of one number or expression."""

CELL_DEPTH = 24
"""Brackets and signs within one another in an expression."""

EXPONENT = 10
"""Largest power in an expression."""

TEXT_CHARACTERS = 2_000
"""A name, a source: what is printed in one line, or one paragraph."""

# Work asked for in one call

APART_SECONDS = 7
"""Time that xacro or MuJoCo may take over a file; makers' largest take one second."""

PACKAGE_FOLDERS = 2_000
"""Folders of a workspace that are gone through for a package."""

XACRO_ARGS = 100
"""Arguments of a xacro; makers' files have up to forty."""

APART_BYTES = 900_000_000
"""Memory that they may ask for, libraries apart."""

TURNS = 100_000
"""Solutions that ``turns="all"`` may list for one pose."""

SAMPLES = 100_000
"""Values of a swept joint; its range in steps of a thousandth of a degree has 360,000."""

STARTS = 100_000
"""Starts of a numeric search: some seconds."""

THREADS = 1_024
"""Threads of a batch."""

ORIENTATIONS = 10_000
"""Orientations of a workspace map: 5 degrees apart."""

JOB_POSES = 100_000
"""Poses of a job for which a base is sought: some 15,000 bases are asked for each."""

POINTS = (2, 1_000)
"""Points along a side of a workspace map: a million poses."""

HALVINGS = 6
"""How often a voxel of a map may be halved: a quarter of a million for one."""

VOXELS = 1_000_000_000
"""Voxels of a map of the reach: a metre and a half in steps of 1.5 mm."""

DPI = (10.0, 1_000.0)
"""Dots per inch of a picture: more than a printer's take 1 GB."""
