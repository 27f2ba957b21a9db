"""Chains whose joints follow fewer values: the kernels against the product and differences."""

import numpy as np
import pytest

from dh2urdf.chain import CoupledChain, Coupling, SerialChain
from dh2urdf.dh import JointType
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import Task, task_jacobian
from dh2urdf.kernels.certificate import measure_all
from dh2urdf.transforms import Array, product, rot_x, rot_z, trans

FAR = np.full(3, np.inf)


def _chain(kinds: str = "RRPR") -> SerialChain:
    """A chain of skew axes without limits."""
    rng = np.random.default_rng(5)
    links = [
        product(rot_z(a), rot_x(b), trans(*p))
        for a, b, p in zip(*rng.normal(size=(2, 5)), rng.normal(size=(5, 3)), strict=True)
    ]
    types = tuple(JointType.PRISMATIC if k == "P" else JointType.REVOLUTE for k in kinds)
    far = np.full(4, np.inf)
    return SerialChain(np.stack(links), types, ("a", "b", "c", "d"), -far, far)


MATRIX = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1], [-0.5, 0, 0]])
OFFSET = np.array([0.0, 0.2, 0.0, 0.7])


def _coupled(matrix: Array = MATRIX) -> CoupledChain:
    slides = np.array([False, False, True])
    return CoupledChain.of(_chain(), Coupling(matrix, OFFSET, ("a", "b", "c"), -FAR, FAR, slides))


def test_a_coupled_chain_is_where_its_joints_are():
    q = np.array([0.3, -1.1, 0.4])
    assert np.allclose(_coupled().fk(q), _chain().fk(MATRIX @ q + OFFSET), atol=1e-14)


def test_kernels_measure_a_coupled_chain_at_its_values():
    chain, q, residual = _coupled(), np.array([[[0.3, -1.1, 0.4]]]), np.empty((1, 1))
    T = chain.fk(q[0, 0])
    measure_all(chain.tables, 0, T[None], q, np.array([1]), residual)
    assert residual[0, 0] < 1e-14
    T[2, 3] += 1e-3
    measure_all(chain.tables, 0, T[None], q, np.array([1]), residual)
    assert abs(residual[0, 0] - 1e-3) < 1e-12


def test_the_jacobian_of_values_is_the_derivative():
    chain, q, h = _coupled(), np.array([0.3, -1.1, 0.4]), 1e-6
    J = task_jacobian(chain, Task.POSITION, q[None])[0]
    for v in range(3):
        step = h * np.eye(3)[v]
        slope = (chain.fk(q + step) - chain.fk(q - step))[:3, 3] / (2.0 * h)
        assert np.allclose(J[:, v], slope, atol=1e-9)


def test_in_turns_one_turn_brings_all_joints_back():
    chain = _coupled().in_turns
    assert chain.turns[0] == 2.0
    q = np.array([0.4, 0.1, 0.2])
    assert np.allclose(chain.fk(q + 2.0 * np.pi * np.eye(3)[0]), chain.fk(q), atol=1e-13)
    assert np.allclose(chain.fk(q), _coupled().fk(q * chain.value_units), atol=1e-13)


def test_a_ratio_that_is_none_is_refused_by_name():
    matrix = MATRIX.copy()
    matrix[3, 0] = 0.7183
    chain = _coupled(matrix)
    with pytest.raises(NoSolverError, match=r"follows a turns 0\.7183 times"):
        _ = chain.in_turns


def test_a_joint_that_follows_two_values_is_refused_by_name():
    matrix = MATRIX.copy()
    matrix[3, 1] = 1.0
    with pytest.raises(NoSolverError, match="'d' follows a and b"):
        _coupled(matrix)


def test_holding_a_value_holds_its_followers():
    q = np.array([0.3, -1.1, 0.4])
    held = _coupled().held({0: 0.3})
    assert held.names == ("b", "c")
    assert np.allclose(held.fk(q[1:]), _coupled().fk(q), atol=1e-14)
