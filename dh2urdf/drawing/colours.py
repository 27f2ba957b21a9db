"""One colour per quantity, the same in figures and in the browser."""

from dh2urdf.grids import HTML_COLOURS

AXIS = {"x": "#d62728", "y": "#2ca02c", "z": "#1f5fc8"}
"""Colours of the frame axes."""

QUANTITY = HTML_COLOURS
"""Colours of theta, d, a and alpha."""

BRANCH_COLOURS = (
    *("#e69f00", "#56b4e9", "#009e73", "#d6c700"),
    *("#0072b2", "#d55e00", "#cc79a7", "#7f7f7f"),
)
"""Colours of branches, told apart with any colour vision (Okabe and Ito)."""

MATERIAL = {"base": "#3d4c66", "joint": "#546685", "link": "#d6dbe3"}
MATERIAL |= {"rail": "#9ea8b8", "bar": "#8fa9b8"}
"""Colours of drawn bodies in three dimensions."""


def rgb(colour: str) -> tuple[int, int, int]:
    """Red, green and blue, 0 to 255, of a ``#rrggbb`` colour."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
