"""Walks from a solution to see whether others are next to it: where they begin."""

import importlib

import numpy as np

walk = importlib.import_module("dh2urdf.kernels.certificate.walk")


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
