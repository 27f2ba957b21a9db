"""Lines of joint axes are snapped to what they were drawn as, before noise."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from dh2urdf.kernels.axis_lines import CENTRAL, MEETING, PARALLEL, snap_lines

KINDS = "parallel", "meeting", "central", "skew"


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def drawn(rng, kinds):
    """Directions and points of lines whose neighbours do what ``kinds`` say."""
    axes, points = [unit(rng)], [rng.normal(size=3)]
    for kind in kinds:
        axis, point = unit(rng), rng.normal(size=3)
        if kind == "parallel":
            axis = axes[-1] * rng.choice([-1.0, 1.0])
        elif kind == "meeting":
            point = points[-1] + rng.uniform(0.5, 1.0) * axes[-1]
        elif kind == "central":
            point = points[-1]
        axes.append(axis)
        points.append(point)
    shifts = rng.normal(size=len(axes))
    return np.array(axes), np.array(points), shifts


def snapped(axes, points):
    n = len(axes)
    frames = np.zeros((n, 4, 4))
    frames[:, :3, 2], frames[:, :3, 3] = axes, points
    found = np.empty((n, 3)), np.empty((n, 3)), np.empty(n), np.empty(n, np.int64)
    snap_lines(frames, np.zeros(n, bool), 1e-5, 1e-5, *found)
    return found


@given(st.lists(st.sampled_from(KINDS), min_size=1, max_size=6), st.integers(0, 2**32 - 1))
def test_lines_that_nearly_do_something_do_it_and_stay_near(kinds, seed):
    rng = np.random.default_rng(seed)
    axes, points, shifts = drawn(rng, kinds)
    for i, kind in enumerate(kinds):  # neighbours that are nearly what they are not drawn as
        sine = np.linalg.norm(np.cross(axes[i], axes[i + 1]))
        if kind != "parallel" and sine < 0.1:
            return
    noise = 1e-8 * rng.normal(size=(2, *axes.shape))
    lines, places, signs, ties = snapped(
        axes + noise[0], points + axes * shifts[:, None] + noise[1]
    )
    off = np.linalg.norm(np.cross(lines, axes), axis=1)
    assert off.max() < 1e-6
    gaps = np.linalg.norm(np.cross(places - points, axes), axis=1)
    assert gaps.max() < 1e-5
    for i, kind in enumerate(kinds):
        assert bool(ties[i] & PARALLEL) == (kind == "parallel")
        if kind == "parallel":
            assert signs[i + 1] == np.sign(axes[i] @ axes[i + 1]) * signs[i]
            assert (lines[i] == lines[i + 1]).all()
        if kind in ("meeting", "central"):
            assert ties[i] & MEETING
    for i in range(len(kinds) - 1):
        if kinds[i + 1] == "central" and kinds[i] in ("meeting", "central"):
            assert ties[i] & CENTRAL
