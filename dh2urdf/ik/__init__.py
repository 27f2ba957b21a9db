"""Inverse kinematics, the layer between chains and kernels.

`arm` what is known before a pose, `families` solvers with a closed form and without, `redundant`
joints to spare, `problem` from poses to solutions; `solve` is the entry.
"""
