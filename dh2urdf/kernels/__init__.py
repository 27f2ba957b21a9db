"""Jitted functions on floats and arrays; they import NumPy, Numba and one another only.

`numbers`, `chain` and `certificate` serve all; then a room a family: `spherical_wrist`,
`parallel_axes`, `general_6r`, `nearly`, `short_chains`, `redundant`.
"""
