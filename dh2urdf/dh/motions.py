"""The four DH motions and their product, the Big Equation, in both conventions.

::

    standard  T_{i-1,i} = Rot_z(theta) Trans_z(d) Trans_x(a) Rot_x(alpha)
    modified  T_{i-1,i} = Trans_x(a) Rot_x(alpha) Rot_z(theta) Trans_z(d)

Lecture notes section 5; Spong, Hutchinson and Vidyasagar, eq. 3.10; Craig, eq. 3.6.
"""

import math
from collections.abc import Iterator
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np

from dh2urdf import transforms as tf
from dh2urdf.bounds import NUMBER
from dh2urdf.doors import choice, number
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError
from dh2urdf.transforms import Array


class DHConvention(StrEnum):
    """Which end of the link carries the frame."""

    STANDARD = "standard"  # distal: Paul, Spong, the lecture notes
    MODIFIED = "modified"  # proximal: Craig, Khalil


def convention_of(value: object, error: type[Dh2UrdfError] = ArgumentError) -> DHConvention:
    """The convention that a word names; an error for any other."""
    if isinstance(value, DHConvention):
        return value
    return DHConvention(choice(value, "convention", tuple(DHConvention), error))


def _numbers(*values: object) -> Iterator[float]:
    """The four parameters as finite floats; an error that names the one that is none."""
    for key, value in zip(("theta", "d", "a", "alpha"), values, strict=True):
        yield number(value, key, -NUMBER, NUMBER)


class DHFactors(NamedTuple):
    """The four simple displacements of one row, each (4, 4)."""

    rot_z: Array
    trans_z: Array
    trans_x: Array
    rot_x: Array


def dh_factors(theta: float, d: float, a: float, alpha: float) -> DHFactors:
    """``Rot_z(theta)``, ``Trans_z(d)``, ``Trans_x(a)`` and ``Rot_x(alpha)`` of one row.

    Examples
    --------
    >>> from dh2urdf import dh_factors, dh_transform
    >>> Rz, Tz, Tx, Rx = dh_factors(0.5, 0.3, 0.1, -1.0)
    >>> bool(abs(Rz @ Tz @ Tx @ Rx - dh_transform(0.5, 0.3, 0.1, -1.0)).max() < 1e-15)
    True
    """
    theta, d, a, alpha = _numbers(theta, d, a, alpha)
    return DHFactors(tf.rot_z(theta), tf.trans(0, 0, d), tf.trans(a, 0, 0), tf.rot_x(alpha))


def dh_transform(
    theta: float,
    d: float,
    a: float,
    alpha: float,
    convention: DHConvention | str = DHConvention.STANDARD,
) -> Array:
    """``T_{i-1,i}`` of one row: the Big Equation, or Craig's (3.6) for modified tables.

    Parameters
    ----------
    theta, d, a, alpha : float
        Joint angle [rad], link offset [m], link length [m], link twist [rad].

    Returns
    -------
    array, shape (4, 4)

    Raises
    ------
    ArgumentError

    Examples
    --------
    >>> from math import pi
    >>> from dh2urdf import dh_transform
    >>> dh_transform(theta=pi / 2, d=0.3, a=0.1, alpha=0).round(3) + 0.0
    array([[ 0. , -1. ,  0. ,  0. ],
           [ 1. ,  0. ,  0. ,  0.1],
           [ 0. ,  0. ,  1. ,  0.3],
           [ 0. ,  0. ,  0. ,  1. ]])
    """
    theta, d, a, alpha = _numbers(theta, d, a, alpha)
    functions = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array(dh_matrix(*functions, d, a, convention_of(convention)))


def dh_matrix(
    ct: Any, st: Any, ca: Any, sa: Any, d: Any, a: Any, convention: DHConvention
) -> list[list[Any]]:
    """The rows of :func:`dh_transform`, of cosines, sines and lengths in numbers or symbols."""
    if convention is DHConvention.STANDARD:
        rows = [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0, sa, ca, d]]
    else:
        rows = [[ct, -st, 0, a], [st * ca, ct * ca, -sa, -sa * d], [st * sa, ct * sa, ca, ca * d]]
    return [*rows, [0, 0, 0, 1]]
