"""Roots that are followed to solutions: seeds that lead nowhere are told."""

import importlib
import math

import numpy as np
import pytest
from general_6r_arms import ARMS, forward, links_of

from dh2urdf.ik.families.general_6r import plan_general_6r
from dh2urdf.kernels.general_6r.follow import follow
from dh2urdf.kernels.general_6r.poses import make_ready
from dh2urdf.kernels.general_6r.roots import place_target


@pytest.mark.parametrize("lost", [math.nan, math.inf])
def test_seeds_that_are_no_numbers_count_as_far_off(monkeypatch, lost):
    """A double root whose seeds are lost, as where null vectors are no two, is in doubt."""
    arm = plan_general_6r(links_of(ARMS["ur5"]))[0]
    make_ready(arm)
    place_target(forward(ARMS["ur5"], np.full((1, 6), 0.4))[0], arm)
    arm["roots"][0], arm["slopes"][0] = 0.3, 0.0

    def seeds(*given):
        arm["cosines"][:], arm["sines"][:] = lost, lost
        return given[3] * given[4]

    monkeypatch.setattr(importlib.import_module(follow.__module__), "_seeds", seeds)
    with np.errstate(all="ignore"):
        answer = follow(0, 1, 0, np.empty((16, 6)), np.empty(16), arm)
    assert answer == (0, 1, math.inf)
