"""Joints of a chain that mimic one another: fewer values in q than joints in the chain."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.read import Mimic
from dh2urdf.transforms import Array


@dataclass(frozen=True, eq=False)
class Coupling:
    """``q_chain = matrix @ q + offset``.

    Parameters
    ----------
    matrix : array, shape (chain.n, n)
    offset : array, shape (chain.n,)
    names : tuple of n str
        The leading joints.
    lower, upper : array, shape (n,)
        Bounds within which every follower stays in its own.
    first : tuple of n int
        For each value, the first joint of the chain that it moves.
    warnings : tuple of str
        Joints whose own bounds leave nothing of those of the others, and so count for nothing.
    """

    matrix: Array
    offset: Array
    names: tuple[str, ...]
    lower: Array
    upper: Array
    first: tuple[int, ...]
    warnings: tuple[str, ...] = ()


def couple(chain: SerialChain, mimics: Mapping[str, Mimic]) -> Coupling | None:
    """The coupling of a chain; None where no joint of it mimics another.

    A leader that is not on the chain itself is still a value of q, since it moves the tip.
    """
    if not any(name in mimics for name in chain.names):
        return None
    terms = [_resolve(name, mimics) for name in chain.names]
    names = tuple(dict.fromkeys(leader for leader, _, _ in terms))
    matrix = np.zeros((chain.n, len(names)))
    offset = np.array([constant for _, _, constant in terms])
    lower, upper = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    first = [chain.n] * len(names)
    warnings = []
    leads = [name == leader for name, (leader, _, _) in zip(chain.names, terms, strict=True)]
    for k in sorted(range(chain.n), key=lambda k: not leads[k]):  # leaders before followers
        leader, factor, constant = terms[k]
        v = names.index(leader)
        matrix[k, v] = factor
        first[v] = min(first[v], k)
        if factor:
            ends = sorted(
                ((bound - constant) / factor) for bound in (chain.lower[k], chain.upper[k])
            )
            low, high = max(lower[v], ends[0]), min(upper[v], ends[1])
            if low <= high:
                lower[v], upper[v] = low, high
            else:
                warnings.append(
                    f"joint {chain.names[k]!r}: its limits exclude those of {leader!r}, which it "
                    "follows; left out"
                )
    return Coupling(matrix, offset, names, lower, upper, tuple(first), tuple(warnings))


def _resolve(name: str, mimics: Mapping[str, Mimic]) -> tuple[str, float, float]:
    """Leader, factor and constant of a joint, through chains of mimics."""
    factor, constant, seen = 1.0, 0.0, {name}
    while name in mimics and mimics[name].leader not in seen:
        mimic = mimics[name]
        constant += factor * mimic.offset
        factor *= mimic.multiplier
        name = mimic.leader
        seen.add(name)
    return name, factor, constant
