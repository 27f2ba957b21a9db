"""Mass properties: of solid primitives, moved between frames, and made physically possible."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from lxml import etree
from numpy.typing import ArrayLike

from dh2urdf.bounds import INERTIA, NUMBER
from dh2urdf.transforms import Array

TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
"""Attributes of an ``<inertia>``: the upper triangle of the tensor, row by row."""

TRIANGLE_MARGIN = 1e-6
"""Relative margin by which a balanced tensor satisfies the triangle inequality: a consumer
that reads seven digits must still accept it."""

NOISE = 1e-15
"""Entries of a rotated tensor below this share of its largest are rounding error."""


@dataclass(frozen=True, eq=False)
class Inertial:
    """Mass [kg], centre of mass [m] and tensor about it [kg m^2], all in one frame."""

    mass: float
    com: Array
    inertia: Array

    def moved(self, T_new_old: Array) -> Inertial:
        """The same body seen from another frame."""
        R = T_new_old[:3, :3]
        return Inertial(self.mass, R @ self.com + T_new_old[:3, 3], R @ self.inertia @ R.T)

    def scaled(self, mass: float) -> Inertial:
        """The same shape at another mass."""
        return Inertial(mass, self.com, self.inertia * (mass / self.mass))

    def rounded(self, digits: int = 9) -> Inertial:
        """Estimates need no more digits, and so read the same from every processor.

        What is too large for a file is written as large as may be.
        """
        size = _size(self.inertia)
        if size > 0.1 * INERTIA:
            inertia = self.inertia * (0.1 * INERTIA / size)
            return Inertial(min(self.mass, NUMBER), self.com, inertia)
        reach = float(np.abs(self.com).max())
        return Inertial(
            _significant(self.mass, abs(self.mass), digits),
            np.array([_significant(v, reach, digits) for v in self.com]),
            np.array([[_significant(v, size, digits) for v in r] for r in self.inertia]),
        )

    @staticmethod
    def total(parts: Iterable[Inertial]) -> Inertial:
        """Several bodies of one frame as one (parallel axis theorem)."""
        bodies = list(parts)
        mass = math.fsum(b.mass for b in bodies)
        com = np.sum([b.mass * b.com for b in bodies], axis=0) / mass
        inertia = np.zeros((3, 3))
        for b in bodies:
            r = b.com - com
            inertia += b.inertia + b.mass * ((r @ r) * np.eye(3) - np.outer(r, r))
        return Inertial(mass, com, inertia)


def without_noise(values: Array, least: float = 0.0) -> Array:
    """A tensor or place, entries that are rounding error of turning it set to 0.

    ``least`` is the size that its largest entry is taken to have at least.
    """
    return np.where(np.abs(values) <= NOISE * max(_size(values), least), 0.0, values)


def _size(inertia: Array) -> float:
    return float(np.abs(inertia).max())


def _significant(value: float, scale: float, digits: int) -> float:
    """The value rounded to so many digits of a number of the size of ``scale``."""
    if scale == 0.0:
        return 0.0
    return round(float(value), digits - 1 - math.floor(math.log10(scale)))


def tensor(six: ArrayLike) -> Array:
    """Symmetric tensor of ``(ixx, ixy, ixz, iyy, iyz, izz)``, shape (3, 3)."""
    ixx, ixy, ixz, iyy, iyz, izz = np.asarray(six, float)
    return np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])


def six_of(inertia: Array) -> tuple[float, float, float, float, float, float]:
    """``(ixx, ixy, ixz, iyy, iyz, izz)`` of a symmetric tensor, shape (3, 3)."""
    ixx, ixy, ixz, iyy, iyz, izz = inertia[np.triu_indices(3)].tolist()
    return ixx, ixy, ixz, iyy, iyz, izz


def whole_numbers(values: Iterable[float]) -> str:
    """Numbers with every digit, whatever is rounded elsewhere."""
    return " ".join(repr(float(v) + 0.0) for v in values)


def inertial_element(link: etree._Element, body: Inertial) -> None:
    """Write the ``<inertial>`` of a link, with every digit."""
    inertial = etree.SubElement(link, "inertial")
    mass, *six = whole_numbers((body.mass, *six_of(body.inertia))).split()
    etree.SubElement(inertial, "origin", xyz=whole_numbers(body.com), rpy="0.0 0.0 0.0")
    etree.SubElement(inertial, "mass", value=mass)
    etree.SubElement(inertial, "inertia", dict(zip(TENSOR, six, strict=True)))


def why_impossible(inertia: Array) -> str:
    """Why no distribution of mass has this tensor, in words; empty where one has."""
    low, mid, high = np.linalg.eigvalsh(inertia)
    if not np.any(inertia):
        return "it is zero"
    if low <= 0:
        return f"its smallest principal moment is {low:.4g} kg m^2"
    if high > low + mid:
        return (
            f"its largest principal moment, {high:.6g} kg m^2, exceeds the sum of the other two, "
            f"{low + mid:.6g}"
        )
    return ""


def balanced(inertia: Array) -> Array:
    """The tensor with its two smaller principal moments raised until a body could have it.

    The largest moment and all principal axes stay; the two smaller ones get the same increase.
    """
    moments, axes = np.linalg.eigh(inertia)
    low, mid, high = moments
    missing = max(high * (1.0 + TRIANGLE_MARGIN) - low - mid, 0.0)
    low, mid = low + 0.5 * missing, mid + 0.5 * missing
    if low <= 0:
        low, mid = high * TRIANGLE_MARGIN, max(mid, high)
    out: Array = axes @ np.diag([low, mid, high]) @ axes.T
    return 0.5 * (out + out.T)
