"""The DH product written apart from the package: elementary 4 x 4 factors, nothing shared."""

import math

import numpy as np

ANGLES = {"h": math.pi / 2, "-h": -math.pi / 2, "pi": math.pi, "deg": math.pi / 180}
"""Words for a quarter turn either way, half a turn and a degree [rad]."""


def rows(text):
    """Rows of numbers and words of angles; semicolons between the rows."""
    lines = (row.split() for row in text.split(";"))
    return tuple(tuple(float(ANGLES.get(word, word)) for word in line) for line in lines)


def turn(axis, angle):
    """Rotation about x, y or z (0, 1, 2) as a homogeneous matrix, by Euler's formula on planes."""
    T = np.eye(4)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    z = np.exp(1j * angle)
    T[i, i] = T[j, j] = z.real
    T[i, j], T[j, i] = -z.imag, z.imag
    return T


def shift(axis, length):
    """Translation along x, y or z as a homogeneous matrix."""
    T = np.eye(4)
    T[axis, 3] = length
    return T


def rigid(xyz, rpy):
    """URDF origin: translation, then yaw, pitch, roll about moving axes."""
    T = shift(0, xyz[0]) @ shift(1, xyz[1]) @ shift(2, xyz[2])
    return T @ turn(2, rpy[2]) @ turn(1, rpy[1]) @ turn(0, rpy[0])


def row_matrix(row, value, modified):
    """One row's displacement at joint value ``value``."""
    if row.origin is not None:
        return rigid(row.origin.xyz, row.origin.rpy)
    theta, d = row.theta, row.d
    if row.joint_type == "revolute":
        theta += row.sign * value
    elif row.joint_type == "prismatic":
        d += row.sign * value
    joint = turn(2, theta) @ shift(2, d)
    link = shift(0, row.a) @ turn(0, row.alpha)
    return link @ joint if modified else joint @ link


def dh_frames(table, q):
    """Frames 0 ... n, then the tool, in base: a list of n + 2 matrices."""
    modified = table.convention == "modified"
    frames = [rigid(table.base.xyz, table.base.rpy)]
    values = iter(q)
    for row in table.rows:
        if row.joint_type == "fixed":
            frames[-1] = frames[-1] @ row_matrix(row, 0.0, modified)
        else:
            frames.append(frames[-1] @ row_matrix(row, next(values), modified))
    return [*frames, frames[-1] @ rigid(table.tool.xyz, table.tool.rpy)]


def difference(A, B):
    """Largest entry by which two homogeneous matrices (or stacks) differ."""
    return float(np.abs(np.asarray(A) - np.asarray(B)).max())
