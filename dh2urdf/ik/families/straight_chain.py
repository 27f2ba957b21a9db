"""Values that move more joints than there are, where that is a chain of joints that move freely.

Turns about parallel axes are turns in a plane: neighbours with parallel axes do together a sum of
ways, each turned by a sum of values, and a turn by another such sum. Ways that are turned by the
same sum are one, those by none are fixed, and the order does not matter. So a palletiser's four
parallel axes, two of which follow so that its tool stays level, are a planar arm of two links.
"""

import itertools
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.dh import JointType
from dh2urdf.ik.arm import NOMINAL, Task
from dh2urdf.transforms import Array, dot, inverse, length, product, trans

WHOLE = 1e-9
"""Rounding of a whole number."""

FLAT = np.array([1.0, 1.0, 0.0])
"""What of a way counts in the plane."""


class Straight(NamedTuple):
    """A chain of joints that move freely, at ``matrix @ q`` of another chain's values q."""

    chain: SerialChain
    matrix: Array


@lru_cache(maxsize=8)
def straighten(chain: CoupledChain, task: Task = Task.POSE) -> Straight:
    """The chain with fewer joints where neighbours have parallel axes, or with all of its own.

    For a position, how the tool is turned does not matter: its origin is another point.
    """
    frames: list[Array] = []
    rows: list[Array] = []
    kinds: list[JointType] = []
    runs, tip = _runs(chain), None
    if task is Task.POSITION:
        runs, tip = _that_move_the_origin(chain, runs), chain.tool
    for run in runs:
        own = [chain.joint_frames[i] for i in run], [chain.matrix[i] for i in run]
        some = _in_plane(chain, run, tip if run is runs[-1] else None) if len(run) > 1 else own
        some = some if len(some[0]) < len(run) else own
        frames += some[0]
        rows += some[1]
        kinds += [chain.kinds[run[0]]] * len(some[0])
    links = [frames[0], *(product(inverse(a), b) for a, b in itertools.pairwise(frames))]
    links.append(product(inverse(frames[-1]), chain.tool))
    far, names = np.full(len(rows), np.inf), tuple(str(i + 1) for i in range(len(rows)))
    straight = SerialChain(np.stack(links), tuple(kinds), names, -far, far, chain.unit)
    return Straight(straight, np.array(rows))


def _runs(chain: CoupledChain) -> list[list[int]]:
    """Neighbours that turn about parallel axes; others alone."""
    runs: list[list[int]] = []
    for i, axis in enumerate(chain.axes):
        last = runs[-1][-1] if runs else -1
        turning = not chain.sliding[i] and runs and not chain.sliding[last]
        if turning and length(np.cross(axis, chain.axes[last])) <= NOMINAL:
            runs[-1].append(i)
        else:
            runs.append([i])
    return runs


def _that_move_the_origin(chain: CoupledChain, runs: list[list[int]]) -> list[list[int]]:
    """The runs without the last joints, as many as turn about axes through the tool's origin."""
    kept, origin = [i for run in runs for i in run], chain.tool[:3, 3]
    while len(kept) > 1 and not chain.sliding[kept[-1]]:
        away = np.cross(chain.axes[kept[-1]], origin - chain.joint_frames[kept[-1]][:3, 3])
        if length(away) > NOMINAL * max(chain.size, 1.0):
            break
        kept.pop()
    return [some for run in runs if (some := [i for i in run if i in kept])]


def _in_plane(
    chain: CoupledChain, run: list[int], tip: Array | None
) -> tuple[list[Array], list[Array]]:
    """Frames and rows of fewer joints that do the same as a run of parallel ones.

    Before the ``tip``, where there is one, they do the same to its origin.
    """
    first, near = chain.joint_frames[run[0]], NOMINAL * max(chain.size, 1.0)
    signs = [1.0 if dot(chain.axes[i], first[:3, 2]) > 0.0 else -1.0 for i in run]
    turned = np.cumsum([s * chain.matrix[i] for s, i in zip(signs, run, strict=True)], axis=0)
    ways: dict[tuple[float, ...], Array] = {}
    along = np.zeros(3)
    stops = [chain.joint_frames[i] for i in run] + ([] if tip is None else [tip])
    points = [product(inverse(first), stop)[:3, 3] for stop in stops]
    for angle, (start, end) in zip(turned, itertools.pairwise(points), strict=False):
        way = end - start
        along[2] += way[2]
        key = tuple(np.round(angle, 9).tolist())
        ways[key] = ways.get(key, np.zeros(3)) + way * FLAT
    fixed, whole = tuple(np.zeros(chain.n).tolist()), tuple(np.round(turned[-1], 9).tolist())
    at = along + ways.pop(fixed, np.zeros(3))
    order = sorted((k for k in ways if length(ways[k]) > near), key=lambda k: k == whole)
    frames, rows, before = [], [], np.zeros(chain.n)
    for key in [*order, whole] if tip is None else order:
        row = np.array(key) - before
        if np.abs(row).max() > WHOLE:
            frames.append(_shifted(first, at))
            rows.append(row)
        before = np.array(key)
        at = at + ways.get(key, np.zeros(3)) if key in order and key != whole else at
    return frames, rows


def _shifted(frame: Array, way: Array) -> Array:
    """A frame moved along its own axes."""
    return product(frame, trans(*way))
