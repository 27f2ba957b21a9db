"""A generated file in MuJoCo: the arm moves from one inverse-kinematics solution to another.

`write_mjcf` proves the file against the table; joints are then driven by gravity compensation and a
computed torque along a smooth curve, which ends where `robot.fk` says.
"""

import tempfile
from pathlib import Path

import mujoco
import numpy as np

import dh2urdf

robot = dh2urdf.Robot.from_dh("denso_vs6556")
path = Path(tempfile.mkdtemp()) / "denso.xml"
report = dh2urdf.write_mjcf(robot.table, path)
print(f"{path.name}: FK agrees with the table to {report.max_error:.0e}")

model = mujoco.MjModel.from_xml_path(str(path))
model.opt.timestep = 1e-3
data = mujoco.MjData(model)

goal = robot.fk(np.radians([30, -40, 80, 10, 50, 0]))
q_goal = robot.ik(goal, seed=np.zeros(6)).q[0]
q_start, seconds = np.zeros(6), 1.5
data.qpos[:] = q_start

for _ in range(int(seconds / model.opt.timestep)):
    s = min(data.time / seconds, 1.0)
    shape = 10 * s**3 - 15 * s**4 + 6 * s**5
    speed = (30 * s**2 - 60 * s**3 + 30 * s**4) / seconds
    bend = (60 * s - 180 * s**2 + 120 * s**3) / seconds**2
    far = q_goal - q_start
    wanted = bend * far + 400.0 * (q_start + shape * far - data.qpos)
    data.qacc[:] = wanted + 40.0 * (speed * far - data.qvel)
    mujoco.mj_inverse(model, data)
    data.qfrc_applied[:] = data.qfrc_inverse
    mujoco.mj_step(model, data)

off = float(np.linalg.norm(data.site("tool0").xpos - goal[:3, 3]))
print(f"after {data.time:.1f} s the tool is {1000 * off:.3f} mm from the goal")
assert off < 1e-3
