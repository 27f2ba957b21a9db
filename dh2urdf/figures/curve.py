"""The polynomial that an elimination leaves, over its angle, with its real roots."""

import numpy as np

from dh2urdf.drawing.colours import BRANCH_COLOURS
from dh2urdf.figures.style import INK, MUTED, RC, Picture, mpl
from dh2urdf.lessons import Curve

HIGH = 2.4
"""Height of the figure [in]."""


def curve_figure(curve: Curve, *, width: float = 7.5) -> Picture:
    """The curve of a step of :meth:`dh2urdf.Robot.explain_ik`, large values compressed.

    Parameters
    ----------
    curve : Curve
        ``step.curve`` of a step that has one.
    width : float
        Of the figure [in].
    """
    count, roots = len(curve.values), np.degrees(curve.roots)
    angles = -180.0 + 360.0 * (np.arange(count) + 0.5) / count
    letter, _, index = curve.name.partition("_")
    name = rf"$\{letter}_{{{index}}}$" if len(letter) > 1 else rf"${letter}_{{{index}}}$"
    with mpl.rc_context(RC):
        figure = Picture(figsize=(width, HIGH))
        axes = figure.subplots()
        figure.subplots_adjust(left=0.6 / width, right=1 - 0.3 / width, top=0.86, bottom=0.22)
        axes.axhline(0.0, color=MUTED, lw=0.9)
        axes.plot(angles, curve.levels, color=BRANCH_COLOURS[0], lw=1.6)
        axes.plot(roots, np.zeros(len(roots)), "o", color=INK, ms=5)
        axes.set_xlim(-180.0, 180.0)
        axes.set_xticks(np.arange(-180, 181, 60))
        axes.set_yticks([0.0], ["0"])
        axes.set_xlabel(f"{name} [deg]")
        many = f"{len(roots) or 'no'} real root{'' if len(roots) == 1 else 's'}"
        axes.set_title(many, loc="left", size=9, color=INK)
        return figure
