"""Figures for print: the arm with its DH frames, and pictures of what it reaches.

The only package that imports matplotlib (extra ``plot``).
"""

from dh2urdf.figures.arm import figure
from dh2urdf.figures.branches import branch_ghosts
from dh2urdf.figures.curve import curve_figure
from dh2urdf.figures.joint_path import path_figure
from dh2urdf.figures.save import save_picture
from dh2urdf.figures.style import picture_bytes
from dh2urdf.figures.workspaces.base_picture import placement_figure
from dh2urdf.figures.workspaces.exact_section import exact_section_figure
from dh2urdf.figures.workspaces.map_picture import map_figure
from dh2urdf.figures.workspaces.workspace import workspace_figure

__all__ = [
    "branch_ghosts",
    "curve_figure",
    "exact_section_figure",
    "figure",
    "map_figure",
    "path_figure",
    "picture_bytes",
    "placement_figure",
    "save_picture",
    "workspace_figure",
]
