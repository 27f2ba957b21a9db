"""Differential inverse kinematics that starts on the branch that you want.

A local method such as Pink goes on from the posture that it is given, and from a far one it comes
late or to another elbow. The closed form says which postures there are; the one that is wanted is
the seed, from which Pink does what it is good at: tasks, postures, constraints.
"""

import numpy as np
import pink
import pinocchio as pin
from pink.tasks import FrameTask, PostureTask

import dh2urdf

robot = dh2urdf.Robot.from_dh("ur5")
above = pin.SE3(np.diag([1.0, -1.0, -1.0]), np.array([-0.35, -0.25, 0.30]))

branches = robot.ik(above)
wanted = branches.branch.index("shoulder left, elbow up, wrist no flip")
q_seed = branches.q[wanted]

task = FrameTask("tool0", position_cost=1.0, orientation_cost=1.0)
posture = PostureTask(cost=1e-6)
posture.set_target(q_seed)


def follow(q: np.ndarray) -> tuple[np.ndarray, float]:
    """A circle of 10 cm with a step of 20 ms, and the largest distance from it [m]."""
    configuration, worst, dt = (
        pink.Configuration(robot.model, robot.model.createData(), q),
        0.0,
        0.02,
    )
    for phase in np.linspace(0.0, 2.0 * np.pi, 200):
        offset = 0.05 * np.array([np.cos(phase) - 1.0, np.sin(phase), 0.0])
        target = pin.SE3(above.rotation, above.translation + offset)
        task.set_target(target)
        velocity = pink.solve_ik(configuration, [task, posture], dt, solver="daqp")
        configuration.integrate_inplace(velocity, dt)
        reached = configuration.get_transform_frame_to_world("tool0").translation
        if phase > 0.5:
            worst = max(worst, float(np.linalg.norm(reached - target.translation)))
    return configuration.q, worst


q_end, worst = follow(q_seed)
nearest = robot.ik(robot.fk(q_end), seed=q_end)
print(f"from {branches.branch[wanted]}: within {1000 * worst:.2f} mm of the circle")
print(f"it ends on {nearest.branch[0]}")

_, lost = follow(np.zeros(6))
print(f"from q = 0: as far as {1000 * lost:.0f} mm from it")
