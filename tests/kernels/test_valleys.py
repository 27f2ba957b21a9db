"""Points of a valley beside exact solutions: when they are none."""

import importlib

import numpy as np
import pytest

from dh2urdf.engine import INTERPRETED

members = importlib.import_module("dh2urdf.kernels.in_doubt.members")
valley = importlib.import_module("dh2urdf.kernels.certificate.valley")


@pytest.mark.parametrize(("slides", "best", "left"), [
    ([0, 1], 1e-15, [0, 2]), ([1, 0], 1e-15, [0, 2]), ([0, 0], 1e-15, [0, 1, 2]),
    ([0, 1], 2e-14, [0, 1, 2]),
])  # fmt: skip
def test_dull_points_beside_exact_solutions_of_slides_are_dropped(monkeypatch, slides, best, left):
    """Not those of arms that only turn, of families, or where no solution is exact."""
    joints = np.column_stack([slides, [-2.0, -3.0], [2.0, 3.0]]).astype(float)
    q, residual = np.arange(6.0).reshape(3, 2), np.array([best, 2e-13, 2e-13])
    rows = q, residual, np.zeros(3, int), np.array([0, 0, 1])
    monkeypatch.setattr(members, "_hardly_moves", lambda *_: True)
    count = members.drop_valleys((None, joints), None, 1.0, rows, 3)
    assert q[:count, 0].tolist() == [2.0 * k for k in left]


@pytest.mark.parametrize(
    ("left", "sigma", "emitted"), [(0.0, 0.0, 1), (0.0, 0.9, 0), (1.0, 0.0, 0)]
)
def test_a_valley_begins_where_a_seed_comes_near_and_one_direction_is_weak(
    monkeypatch, left, sigma, emitted
):
    """Seeds that stay far off, or whose Jacobian is as strong in every direction, begin none.

    It is walked along by steps as long both ways.
    """
    seen, ways = [], []

    def settle(chain, goal, start, room):
        room[2][:], room[3][:] = (1.0, sigma), 1.0 - sigma
        return left, 1, 1.0

    def emit(chain, goal, start, room, q, count):
        seen.append(start.tolist())
        return count

    monkeypatch.setattr(valley, "_settle", settle)
    monkeypatch.setattr(valley, "_emit", emit)

    def walk(*given):
        ways.append(given[3])
        return given[6], given[8]

    monkeypatch.setattr(valley, "_walk", walk)
    search = INTERPRETED["dh2urdf.kernels.certificate.valley.search_valleys"]
    seeds, count = np.full((1, 1, 2), 0.4), np.zeros(1, int)
    q, many = np.zeros((1, 4, 2)), np.ones(1, int)
    search((None, np.zeros((2, 3))), 1.0, np.eye(4)[None], seeds, many, q, count)
    assert seen == [[0.4, 0.4]] * emitted
    assert ways == [1.0, -1.0] * emitted


def test_a_valley_is_walked_as_long_as_it_goes_on(monkeypatch):
    """Each step's end is remembered, until no direction leads on."""
    begun, room = [], (None, np.eye(2), np.array([1.0, 0.0]), None, np.empty((7, 2)))

    def goes_on(*_):
        begun.append(True)
        return len(begun) <= 3

    monkeypatch.setattr(valley, "_settle", lambda *_: (0.0, 1, 1.0))
    monkeypatch.setattr(valley, "_ahead", goes_on)
    chain, goal = (None, np.zeros((2, 3))), (0, np.eye(4), 1.0)
    trail, found = np.zeros((9, 2)), np.zeros((4, 2))
    passed, count = valley._walk(chain, goal, np.zeros(2), -1.0, room, trail, 0, found, 0)
    assert (passed, count) == (3, 0)
    np.testing.assert_allclose(trail[:3], [[0.0, -k * valley.STEP] for k in (1, 2, 3)])


@pytest.mark.parametrize(("residual", "most", "count"), [(0.0, 2, 2), (0.0, 1, 1), (1e-9, 2, 1)])
def test_a_valley_gives_a_solution_that_is_sharp_while_there_is_room(
    monkeypatch, residual, most, count
):
    """Where Newton's method ends beside the pose there is none."""
    monkeypatch.setattr(valley, "pose_residual", lambda *_: residual)
    monkeypatch.setattr(valley, "look", lambda *_: (1, 1.0))
    monkeypatch.setattr(valley, "add_step", lambda *_: (0.0, 0.0, 0.0))
    chain, goal, room = (None, np.zeros((2, 3))), (0, np.eye(4), 1.0), (None,) * 4 + (np.eye(7, 2),)
    found = np.full((most, 2), 2.0)
    assert valley._emit(chain, goal, np.array([0.5, 7.0]), room, found, 1) == count
    if count == 2:
        np.testing.assert_allclose(found[1], [0.5, 7.0 - 2.0 * np.pi])
