"""Screw axes in the space frame and the home pose, as in *Modern Robotics* (Lynch and Park 2017).

``T_base_tip(q) = exp([S_1] q_1) ... exp([S_n] q_n) M`` with ``S = (omega, v)``; the file is one of
joint axes (`dh2urdf.conversions.chains.typed_axes`), M its ``tool``.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.assign import chain_to_dh, tidy_length
from dh2urdf.conversions.chains import axes_to_chain
from dh2urdf.conversions.forms.parts import Read, limits_of
from dh2urdf.transforms import Array

HEAD = """\
Screw axes (omega, v) in the base frame at q = 0 and the home pose M [m, rad]
(Lynch and Park, Modern Robotics: Slist is the transpose of screws, M is tool)"""


def screw_axes(chain: SerialChain) -> tuple[Array, Array]:
    """Screws (n, 6) of a chain, omega before v [m], and ``T_base_tip`` at q = 0, (4, 4)."""
    omega = np.where(chain.prismatic[:, None], 0.0, chain.axes)
    v = np.where(chain.prismatic[:, None], chain.axes, np.cross(chain.points, chain.axes))
    return _tidy(np.hstack([omega, v]), chain.size), _tidy(chain.tool, chain.size)


def _tidy(numbers: Array, size: float) -> Array:
    """Numbers without the rounding errors of products in an arm of some size [m]."""
    flat = [tidy_length(float(v), max(1.0, size)) for v in numbers.flat]
    return np.array(flat).reshape(numbers.shape)


def screws_content(chain: SerialChain, name: str) -> dict[str, Any]:
    """What a file of screw axes says of a chain."""
    S, M = screw_axes(chain)
    out: dict[str, Any] = {"name": name, "screws": S.tolist(), "tool": M.tolist()}
    return out | {"names": list(chain.names), **limits_of(chain)}


def read_axes_form(content: Mapping[str, Any], name: str) -> Read:
    """The table of a file of joint axes, by frame assignment.

    Raises
    ------
    UrdfError
    """
    chain, called = axes_to_chain(content, name)
    return chain_to_dh(chain, name=called).table, ()
