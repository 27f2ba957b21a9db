"""Walks from a solution to see whether others are next to it: where they begin."""

import importlib
import math

import numpy as np
import pytest

walk = importlib.import_module("dh2urdf.kernels.certificate.walk")
finish = importlib.import_module("dh2urdf.kernels.certificate.finish")

EVERY = finish.EVERY_JOINT


def test_walks_begin_both_ways_in_each_direction_once(monkeypatch):
    """In directions in which the tool stays, and against them; where none arrives nothing moves."""
    ways, began, moved = np.array([[1.0, 0.0], [0.6, 0.8], [9.0, 9.0]]), [], np.zeros(2)

    def nowhere(chain, T, q, way, *rest):
        began.append(way.tolist())
        return False

    monkeypatch.setattr(walk, "_come_back", nowhere)
    some = np.zeros((3, 2))
    assert not walk._walks_turned(None, None, np.zeros(2), ways, 2, 0.1, 1.0, 3, some, (), moved)
    assert began == [[1.0, 0.0], [-1.0, -0.0], [0.6, 0.8], [-0.6, -0.8]]
    assert not moved.any()


@pytest.mark.parametrize("lowest", [0.1, 0.7, 1.5, 2.9])
def test_a_walk_between_two_directions_begins_where_the_pose_is_kept_best(monkeypatch, lowest):
    """In the direction, and against it, in which a point is least off, of all angles."""
    began = []

    def off(chain, T, q, ways, angle, *rest):
        ways[2] = math.cos(angle), math.sin(angle)
        return abs(math.sin(angle - lowest))

    monkeypatch.setattr(walk, "_off", off)
    monkeypatch.setattr(walk, "_walks", lambda *given: began.append(given[3].copy()))
    ways, moved = np.eye(3, 2), np.zeros(2)
    assert not walk._walks_between(
        *(None, None, np.zeros(2), ways, 0.1, 1.0, 3, np.zeros((3, 2)), (), moved)
    )
    best = np.array([math.cos(lowest), math.sin(lowest)])
    for way, expected in zip(began, (best, -best), strict=True):
        np.testing.assert_allclose(way, expected, atol=1e-2)


@pytest.mark.parametrize(("floor", "arrives"), [(walk.FLAT, True), (walk.NOTHING, False)])
def test_a_walk_that_all_directions_lead_back_far_aside_does_not_arrive(
    monkeypatch, floor, arrives
):
    """It ends on another family; led back across the flat directions alone it stays on its own."""

    def aside(chain, T, q, way, length, floor, mask, trial, room):
        trial[:] = q + length * way + [0.0, 0.6 * length]
        return True

    monkeypatch.setattr(walk, "_come_back", aside)
    monkeypatch.setattr(walk, "pose_residual", lambda *_: 0.0)
    given = None, None, np.zeros(2), np.array([1.0, 0.0]), 0.05, 1.0
    assert walk._arrives(*given, floor, 3, np.zeros(2), ()) == arrives


@pytest.mark.parametrize(
    ("mask", "tries"), [(3, [(0, 3), (0, EVERY), (1, 3), (2, 3)]), (EVERY, [(0, EVERY)])]
)
def test_what_a_closed_form_tells_of_is_walked_by_shorter_lengths_in_the_end(
    monkeypatch, mask, tries
):
    """After all joints have been, by the longest; shorter walks of all joints tell nothing."""
    tried = []

    def nowhere(chain, T, q, length, mask, alone):
        tried.append((walk.LENGTHS.index(length), mask))
        return 0

    monkeypatch.setattr(finish, "free_of", nowhere)
    assert finish._free_where_singular(None, None, np.zeros(2), mask, True) == 0
    assert tried == tries
