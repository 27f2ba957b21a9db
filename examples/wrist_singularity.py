"""A straight line through a wrist singularity, where axes 4 and 6 are one line.

A program that keeps to one branch by its name, "no flip", has to turn joints 4 and 6 by half a turn
there within one step. `ik_path` takes all solutions of every pose, the singular families among
them, and finds the motion that goes straight on: joint 5 through zero into the other branch.
"""

import numpy as np

import dh2urdf

robot = dh2urdf.Robot.from_dh("puma560")
singular = np.radians([20, 50, -130, 30, 0, -10])  # joint 5 at zero
line = np.linspace(-0.08, 0.08, 81)
poses = np.repeat(robot.fk(singular)[None], len(line), axis=0)
poses[:, 1, 3] += line  # along the base's y, the orientation kept

start = robot.ik(poses[0], seed=singular)
path = robot.ik_path(poses, start=start.q[0])
steps = np.degrees(np.abs(np.diff(path.q, axis=0)).max(axis=0))
errors = [np.abs(robot.fk(q) - T).max() for q, T in zip(path.q, poses, strict=True)]
print(f"ik_path: largest step of each joint {steps.round(2)} deg, poses met to {max(errors):.0e}")
print(f"joint 5 goes from {np.degrees(path.q[0, 4]):.1f} to {np.degrees(path.q[-1, 4]):.1f} deg")

branch, kept = start.branch[0], [start.q[0]]
for T in poses[1:]:
    found = robot.ik(T, seed=kept[-1])
    same = [q for q, name in zip(found.q, found.branch, strict=True) if name == branch]
    kept += same[:1]
steps = np.degrees(np.abs(np.diff(kept, axis=0)).max(axis=0))
print(f"always {branch!r}: largest step of each joint {steps.round(2)} deg")
