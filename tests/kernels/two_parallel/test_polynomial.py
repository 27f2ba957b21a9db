"""The polynomial in joint 1: degree 8, a root at every solution, for either class."""

import math

import numpy as np
import pytest
from ik_referee import arm, draw, forward

from dh2urdf.ik.families.two_parallel import TwoParallel
from dh2urdf.kernels.two_parallel.polynomial import sample
from dh2urdf.kernels.two_parallel.poses import see

MEETING = {"4 meets 5": 3, "5 meets 6": 4}


def values(solver, T, angles):
    """The polynomial at angles (k,), any number of them."""
    seen, hidden, out = np.empty((9, 3)), np.empty((2, 24)), np.empty(24)
    see(solver.form, T, 0.0, np.empty((4, 4)), seen)
    samples = []
    for angle in angles:
        hidden[0], hidden[1] = math.cos(angle), math.sin(angle)
        sample(solver.form, seen, hidden, 1, out)
        samples.append(out[0])
    return np.array(samples)


@pytest.mark.parametrize("meeting", MEETING)
@pytest.mark.parametrize("mirrored", [False, True])
def test_it_has_degree_8_and_a_root_at_joint_1(meeting, mirrored):
    """Harmonics above the eighth vanish, and the value at the joint that made the pose."""
    rng = np.random.default_rng(0)
    rows = rng.uniform((-0.5, 0.1, 0.4), (0.5, 0.5, 2.7), (6, 3))
    rows[1, 2], rows[MEETING[meeting], 1] = 0.0, 0.0
    chain = arm(tuple(map(tuple, rows.tolist())))
    if mirrored:
        chain = chain.reversed()
    solver = TwoParallel(chain)
    assert solver.mirrored == mirrored
    for q in draw(chain, 5, 1):
        T = np.ascontiguousarray(forward(chain, q))
        angles = 2.0 * np.pi * np.arange(64) / 64 + 0.01
        harmonics = np.abs(np.fft.rfft(values(solver, T, angles)))
        assert harmonics[8] > 1e-9 * harmonics.max()
        assert harmonics[9:].max() < 1e-11 * harmonics.max()
        first = solver.form.joints[0]
        at = values(solver, T, [solver.form.signs[0] * q[first]])[0]
        assert abs(at) < 1e-12 * np.abs(values(solver, T, angles)).max()
