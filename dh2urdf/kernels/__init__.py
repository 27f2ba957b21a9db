"""Functions on floats and arrays in a part of Python; they import NumPy and one another only.

`dh2urdf.engine` decides whether they run compiled; CONTRIBUTING.md says which part it is.

`shapes` says what entries take; `numbers`, `rigid`, `chain`, `newton` and `certificate` serve all,
`axis_lines` finds what joint axes do to one another, `measures` says how good solutions are,
`blocks` serves those that work on many poses side by side; then the families: `spherical_wrist`,
`parallel_axes`, `general_6r`, `two_parallel`, `followers`, `short_chains`, `nearly`, `redundant`.
"""
