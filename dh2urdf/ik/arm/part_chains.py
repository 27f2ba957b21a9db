"""Chains with fewer joints: some held at a value, or one at an end left off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.transforms import Array, rot_z, trans

__all__ = ["hold", "without_end"]


def hold(chain: SerialChain, held: Mapping[int, float]) -> SerialChain:
    """The chain without the held joints: ``links[i] Z_i(value) links[i + 1]`` become one link."""
    links = [chain.links[0]]
    for i in range(chain.n):
        if i in held:
            Z = trans(0.0, 0.0, held[i]) if chain.prismatic[i] else rot_z(held[i])
            links[-1] = links[-1] @ Z @ chain.links[i + 1]
        else:
            links.append(chain.links[i + 1])
    return _part(chain, np.stack(links), [i for i in range(chain.n) if i not in held])


def without_end(chain: SerialChain, joint: int) -> SerialChain:
    """The chain without its first or last joint and the link beyond it, the same at any value."""
    rest = [i for i in range(chain.n) if i != joint]
    return _part(chain, chain.links[1:] if joint == 0 else chain.links[:-1], rest)


def _part(chain: SerialChain, links: Array, joints: list[int]) -> SerialChain:
    """Some of the joints of a chain between other links."""
    return replace(
        chain,
        links=links,
        joint_types=tuple(chain.joint_types[i] for i in joints),
        names=tuple(chain.names[i] for i in joints),
        lower=chain.lower[joints],
        upper=chain.upper[joints],
    )
