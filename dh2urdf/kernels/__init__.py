"""Functions on floats and arrays in a part of Python; they import NumPy and one another only.

`numbers.engine` decides whether they run compiled; CONTRIBUTING.md says which part it is.

`shapes` says what entries take; `numbers`, `chain` and `certificate` serve all; then a room a
family: `spherical_wrist`, `parallel_axes`, `general_6r`, `nearly`, `short_chains`, `redundant`.
"""
