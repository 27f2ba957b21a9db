"""Sixteen postures for one pose: as many as six turning joints can have.

The arm is that of Manseur and Doty (1989), the first for which all sixteen were seen to be real.
"""

import numpy as np

import dh2urdf
from dh2urdf.figures import figure, save_picture

RIGHT, DEGREE = np.pi / 2, np.pi / 180
rows = [  # theta, d, a, alpha
    (0, 0.0, 0.3, RIGHT),
    (0, 0.0, 1.0, DEGREE),
    (0, 0.2, 0.0, RIGHT),
    (0, 0.0, 1.5, DEGREE),
    (0, 0.0, 0.0, RIGHT),
    (0, 0.0, 0.0, DEGREE),
]
table = dh2urdf.DHTable.from_array(rows, "standard", name="manseur_doty")
robot = dh2urdf.Robot.from_dh(table)

q = np.array([0.5, 0.57, -2.26, -1.19, 1.43, -0.72])
found = robot.ik(robot.fk(q), seed=q)
print(
    f"{robot.solver}: {len(found)} solutions, the worst of them off by {found.residual.max():.0e}"
)
print(np.degrees(found.q).round(1))

picture = figure(robot, q, ghosts=found.q[1:], frames=False, table=False)
save_picture(picture, "sixteen_solutions.png", force=True)
print("sixteen_solutions.png")
