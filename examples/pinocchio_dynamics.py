"""A dynamics loop in Pinocchio, with a model that a DH table made.

`robot.model` is a plain `pin.Model`. The arm swings freely from a bent posture, by `pin.aba` and a
fourth-order Runge-Kutta step; nothing takes energy away, so kinetic plus potential must stay.
"""

import numpy as np
import pinocchio as pin

import dh2urdf

robot = dh2urdf.Robot.from_dh("denso_vs6556")
model, data = robot.model, robot.model.createData()


def slope(state: np.ndarray) -> np.ndarray:
    """Velocity and acceleration of a state (q, v) without torques."""
    q, v = np.split(state, 2)
    return np.concatenate([v, pin.aba(model, data, q, v, np.zeros(robot.n))])


def energy(state: np.ndarray) -> float:
    """Kinetic and potential energy [J]."""
    q, v = np.split(state, 2)
    return float(
        pin.computeKineticEnergy(model, data, q, v) + pin.computePotentialEnergy(model, data, q)
    )


state, dt = np.concatenate([np.radians([0, -60, 100, 20, 40, 0]), np.zeros(6)]), 1e-3
before = energy(state)
for _ in range(1000):
    k1 = slope(state)
    k2 = slope(state + 0.5 * dt * k1)
    k3 = slope(state + 0.5 * dt * k2)
    k4 = slope(state + dt * k3)
    state = state + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
drift = energy(state) - before

print(f"mass of the moving links: {pin.computeTotalMass(model):.1f} kg")
print(f"after one second joint 2 stands at {np.degrees(state[1]):.1f} deg")
print(f"energy: {before:.3f} J, and {drift:+.1e} J after 1000 steps")
assert abs(drift) < 1e-5
