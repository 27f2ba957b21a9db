"""Recursive Newton-Euler on the DH frames (Luh, Walker and Paul), written apart from the package.

All vectors in base axes. Outwards: angular velocity and acceleration of each link, acceleration
of its DH frame's origin. Inwards: force and moment that the link before passes on.
"""

import numpy as np
from dh_product import dh_frames

GRAVITY = np.array([0.0, 0.0, -9.81])


def symmetric(six):
    """Tensor of (ixx, ixy, ixz, iyy, iyz, izz)."""
    xx, xy, xz, yy, yz, zz = six
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def joint_torques(table, q, v, a):
    """Torques [N m] or forces [N] for a motion of a table whose rows all carry mass properties."""
    frames = dh_frames(table, q)
    axes = joint_axes(table, q)
    loads, w, dw, acc = [], np.zeros(3), np.zeros(3), -GRAVITY
    for i, (row, (z, point)) in enumerate(zip(table.joints, axes, strict=True)):
        T_before, T = frames[i], frames[i + 1]
        here = acc + spun(w, dw, point - T_before[:3, 3])
        rate, change = row.sign * v[i], row.sign * a[i]
        if row.joint_type == "revolute":
            dw = dw + z * change + np.cross(w, z * rate)
            w = w + z * rate
            acc = here + spun(w, dw, T[:3, 3] - point)
        else:
            slid = 2 * np.cross(w, z * rate) + z * change
            acc = here + spun(w, dw, T[:3, 3] - point) + slid
        R = T[:3, :3]
        com = R @ np.array(row.com)
        inertia = R @ symmetric(row.inertia) @ R.T
        force = row.mass * (acc + spun(w, dw, com))
        moment = inertia @ dw + np.cross(w, inertia @ w)
        loads.append((force, moment, T[:3, 3] + com))
    return inwards(table, axes, loads)


def inwards(table, axes, loads):
    """Torques from the inertial force and moment of each link, summed from the tip."""
    tau, f, n, at = np.zeros(table.n), np.zeros(3), np.zeros(3), np.zeros(3)
    for i in reversed(range(table.n)):
        force, moment, com = loads[i]
        z, point = axes[i]
        n = n + np.cross(at - point, f) + np.cross(com - point, force) + moment
        f = f + force
        at = point
        tau[i] = table.joints[i].sign * (z @ (n if table.joints[i].joint_type == "revolute" else f))
    return tau


def spun(w, dw, r):
    """Acceleration of a point at r of a turning body, less that of the body's own point."""
    return np.cross(dw, r) + np.cross(w, np.cross(w, r))


def joint_axes(table, q):
    """Unit axis of each joint and a point on it, in base axes (no fixed rows)."""
    frames = dh_frames(table, q)
    shift = 1 if table.convention == "modified" else 0
    return [(frames[i + shift][:3, 2], frames[i + shift][:3, 3]) for i in range(table.n)]
