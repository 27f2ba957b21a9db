"""Colours, type and strokes of all figures; the only door to matplotlib."""

import io
from typing import Any

import numpy as np

from dh2urdf.dh.quoting import one_line
from dh2urdf.exceptions import MissingExtraError

try:
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
except ImportError:
    raise MissingExtraError("plot", "drawing a figure") from None

__all__ = ["FAINT", "INK", "MUTED", "RC", "Picture", "mix", "mpl", "picture_bytes", "plain"]

INK = "#1b2333"
MUTED = "#5c6470"
FAINT = "#b4b8be"

RC: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "mathtext.fontset": "stix",
    "svg.fonttype": "none",
    "svg.hashsalt": "dh2urdf",
    "pdf.fonttype": 42,
    "axes.unicode_minus": True,
    **dict.fromkeys(("axes.spines.top", "axes.spines.right"), False),
    **dict.fromkeys(("axes.edgecolor", "axes.labelcolor", "text.color"), INK),
    **dict.fromkeys(("xtick.color", "ytick.color"), INK),
    "axes.linewidth": 0.9,
    "font.size": 10.0,
}
"""Settings in force while a figure is made and saved; nobody else's figures see them."""


MARK = "dh2urdf figure"
"""Written into every file: what has it may be replaced."""

METADATA: dict[str, dict[str, object]] = {
    "png": {"Software": MARK},
    "svg": {"Date": None, "Creator": MARK},
    "pdf": {"CreationDate": None, "ModDate": None, "Creator": MARK, "Producer": None},
}


class Picture(Figure):
    """A matplotlib figure that shows itself in a notebook without pyplot."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        FigureCanvasAgg(self)

    def _repr_png_(self) -> bytes:
        return picture_bytes(self, "png", dpi=110)


def picture_bytes(figure: Picture, format: str, *, dpi: float = 180.0) -> bytes:
    """The figure in one of :data:`FORMATS`; ``dpi`` is the resolution of a PNG."""
    out = io.BytesIO()
    with mpl.rc_context(RC):
        figure.savefig(out, format=format, dpi=dpi, metadata=METADATA[format])
    return out.getvalue()


def mix(colour: str, share: float, other: str = "#ffffff") -> str:
    """A colour blended with another one, ``share`` of the first."""
    from matplotlib.colors import to_hex, to_rgb

    first, second = np.array(to_rgb(colour)), np.array(to_rgb(other))
    r, g, b = (share * first + (1.0 - share) * second).tolist()
    return str(to_hex((r, g, b)))


def plain(text: str) -> str:
    """A text of a user as it is drawn: no formula, and only what the font has."""
    from matplotlib.font_manager import findfont, get_font

    drawn = get_font(findfont(RC["font.sans-serif"][0])).get_charmap()
    signs = "".join(c if ord(c) in drawn else "\N{WHITE SQUARE}" for c in one_line(text))
    return signs.replace("$", r"\$")
