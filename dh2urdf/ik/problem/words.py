"""The word by which a maker's controller says which solution is meant.

For arms with an ortho-parallel base and a spherical wrist, see
:mod:`dh2urdf.chain.ortho_parallel`. Words speak of the controller's joint angles: joints 2 to 5 are
counted from the maker's zero in the maker's direction, which the geometry tells; joints 1 and 6
turn in the maker's direction about the base's and the flange's z, and their zero is the arm's own.
For the tables that ship of these makers, the angles are q itself; FANUC's J3 is the angle of the
forearm to the level, not to the upper arm.

KUKA
    Zero stretched out level, A1 and A6 clockwise. S, bit 0: the wrist centre is behind axis 1
    (overhead area); bit 1: A3 at or beyond the angle where the arm is stretched, 0 if axes 3 and 4
    meet; bit 2: A5 < 0. T, bits 0 to 5: A1 < 0 to A6 < 0. (KUKA's expert programming manual,
    "Status and Turn"; the same words are STAT and TU of Siemens, *SINUMERIK ONE NC programming*,
    6FC5398-2EP40-0BA0, 12/2019, pages 710 and 713. Some KUKA manuals print bit 2 the other way
    round; points that were taught have A5 < 0.)
ABB
    Zero with the upper arm upright and the forearm level. cf1, cf4, cf6: quarter turns of axes 1, 4
    and 6, 0 from 0 to 90 degrees, -1 from -90 to 0. cfx, bit 2: the wrist centre is behind axis 1;
    bit 1: behind the lower arm, beyond the angle where the arm is stretched; bit 0: axis 5
    negative. (*RAPID reference manual part 2, Functions and data types A-Z*, 3HAC16581-1 rev. B,
    confdata; tested on answers of RobotStudio.) Arms with a parallel rod take no notice of cfx.
FANUC
    Zero as ABB's. F (flip) for J5 > 0, else N; U (up) or D for the elbow, where the arm is
    stretched between them; T (front) or B (back) for the wrist centre; then full turns of J1, J4
    and J6: 0 below 180 degrees, 1 from 180 to 539, -1 from -180 to -539. (*HandlingTool Operator's
    Manual*, position data: configuration; tested on answers of ROBOGUIDE for an arm with these
    three turn numbers, which a controller may assign to other axes.)
"""

from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.chain import SerialChain
from dh2urdf.chain.ortho_parallel import OrthoParallel
from dh2urdf.doors import choice
from dh2urdf.transforms import Array

EDGE = 1e-9
"""Angle [rad] and, per m of arm, length on either side of a bound that is on it: rounding of
solutions must not tell 0 from -0."""


class KukaWord(NamedTuple):
    """Status and turn of a KUKA controller."""

    status: int
    turn: int

    def __str__(self) -> str:
        return f"S {self.status}, T {self.turn}"


class AbbWord(NamedTuple):
    """``confdata`` of an ABB controller."""

    cf1: int
    cf4: int
    cf6: int
    cfx: int

    def __str__(self) -> str:
        return f"[{self.cf1},{self.cf4},{self.cf6},{self.cfx}]"


class FanucWord(NamedTuple):
    """Configuration of a FANUC controller."""

    flip: str
    elbow: str
    side: str
    turn1: int
    turn4: int
    turn6: int

    def __str__(self) -> str:
        letters = " ".join(self[:3])
        return f"{letters}, {self.turn1}, {self.turn4}, {self.turn6}"


class _Postures(NamedTuple):
    """The controller's angles (k, 6) [rad], and where the arm is towards its singularities (k,)."""

    angles: Array
    behind: NDArray[np.bool_]
    stretched_over: NDArray[np.bool_]


def _kuka(p: _Postures) -> Iterator[KukaWord]:
    negative = p.angles < -EDGE
    status = p.behind + 2 * ~p.stretched_over + 4 * negative[:, 4]
    return map(KukaWord, status.tolist(), (negative @ 2 ** np.arange(6)).tolist())


def _abb(p: _Postures) -> Iterator[AbbWord]:
    quarters = np.floor((p.angles[:, [0, 3, 5]] + EDGE) / (0.5 * np.pi)).astype(int)
    cfx = 4 * p.behind + 2 * p.stretched_over + (p.angles[:, 4] < -EDGE)
    return map(AbbWord, *quarters.T.tolist(), cfx.tolist())


def _fanuc(p: _Postures) -> Iterator[FanucWord]:
    flip = np.where(p.angles[:, 4] > EDGE, "F", "N").tolist()
    elbow, side = np.where(p.stretched_over, "D", "U"), np.where(p.behind, "B", "T")
    a = p.angles[:, [0, 3, 5]]
    turns = np.sign(a) * np.floor((np.abs(a) + np.pi + EDGE) / (2.0 * np.pi))
    return map(FanucWord, flip, elbow.tolist(), side.tolist(), *turns.astype(int).T.tolist())


class _Maker(NamedTuple):
    """Offsets [rad] and signs of the maker's angles, ``t = sign q - offset``, and its words."""

    offsets: tuple[float, ...]
    signs: tuple[int, ...]
    words: Callable[[_Postures], Iterator[NamedTuple]]


_H = 0.5 * np.pi

MAKERS = {
    "kuka": _Maker((0, -_H, 0, 0, 0, 0), (-1, 1, 1, -1, 1, -1), _kuka),
    "abb": _Maker((0, 0, -_H, 0, 0, 0), (1, 1, 1, 1, 1, 1), _abb),
    "fanuc": _Maker((0, 0, -_H, 0, 0, 0), (1, 1, -1, -1, -1, -1), _fanuc),
}

_of_chain = lru_cache(maxsize=16)(OrthoParallel.of_chain)


def controller_words(chain: SerialChain, q: Array, maker: str) -> tuple[NamedTuple, ...]:
    """The word of each configuration q (k, 6) of a chain, in the terms of a maker.

    Raises
    ------
    NotOrthoParallelError
        The arm has not the shape that these words speak of; the message says where, by how much.
    """
    chosen = MAKERS[choice(maker, "maker", MAKERS)]
    return tuple(chosen.words(_postures(_of_chain(chain), q, chosen)))


def _postures(arm: OrthoParallel, q: Array, maker: _Maker) -> _Postures:
    """Angles of configurations (k, 6) as the maker counts them, and the postures."""
    signs = np.asarray(arm.signs)
    t = signs * q - np.asarray(arm.offsets)
    angles = np.asarray(maker.signs) * (t + np.asarray(maker.offsets))
    angles[:, [0, 5]] = (np.asarray(maker.signs) * signs * q)[:, [0, 5]]
    forearm, bend = np.hypot(arm.a2, arm.c3), np.arctan2(arm.a2, arm.c3)
    upper, lower = t[:, 1], t[:, 1] + t[:, 2] + bend
    reach = arm.a1 + arm.c2 * np.sin(upper) + forearm * np.sin(lower)
    near = EDGE * max(1.0, arm.c2 + forearm)
    return _Postures(angles, reach < -near, np.sin(t[:, 2] + bend) < -EDGE)
