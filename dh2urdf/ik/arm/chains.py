"""Chains made of a chain: in another unit of length, with joints held, with an end left off.

The thresholds of the solvers are meant for arms of about a metre. Out of that range a chain's
lengths are divided by a power of two, which rounds nothing, so that an arm of micrometres and one
of a thousand kilometres are solved as the one of a metre is.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.transforms import Array, product, rot_z, trans

NORMAL = (2.0**-4, 2.0**4)
"""Lengths [m] of arms whose unit is the metre."""

RIGID = 1e-6
"""Length of an arm, relative to the travel of its slides, below which the travel is its size."""


def in_own_unit(chain: SerialChain) -> SerialChain:
    """The chain with its lengths in a unit that makes it 1 to 2 long; itself if it is normal."""
    if isinstance(chain, CoupledChain):
        chain = chain.in_turns
    length = chain.length if chain.length > RIGID * chain.size else chain.size
    if NORMAL[0] <= length <= NORMAL[1]:
        return chain
    return chain.in_unit(2.0 ** math.floor(math.log2(length)))


def lengths_in(Ts: Array, unit: float) -> Array:
    """Poses Ts (..., 4, 4) with their positions in a unit [m]."""
    out = Ts.copy()
    out[..., :3, 3] /= unit
    return out


def hold(chain: SerialChain, held: Mapping[int, float]) -> SerialChain:
    """The chain without the held joints: ``links[i] Z_i(value) links[i + 1]`` become one link."""
    if isinstance(chain, CoupledChain):
        return chain.held(dict(held))
    links = [chain.links[0]]
    for i in range(chain.n):
        if i in held:
            Z = trans(0.0, 0.0, held[i]) if chain.prismatic[i] else rot_z(held[i])
            links[-1] = product(links[-1], Z, chain.links[i + 1])
        else:
            links.append(chain.links[i + 1])
    return part(chain, np.stack(links), [i for i in range(chain.n) if i not in held])


def without_end(chain: SerialChain, joint: int) -> SerialChain:
    """The chain without its first or last joint and the link beyond it, the same at any value."""
    rest = [i for i in range(chain.n) if i != joint]
    return part(chain, chain.links[1:] if joint == 0 else chain.links[:-1], rest)


def part(chain: SerialChain, links: Array, joints: list[int]) -> SerialChain:
    """Some of the joints of a chain between other links."""
    return replace(
        chain,
        links=links,
        joint_types=tuple(chain.joint_types[i] for i in joints),
        names=tuple(chain.names[i] for i in joints),
        lower=chain.lower[joints],
        upper=chain.upper[joints],
    )
