"""The map of an arm's reach: a grid of positions times a uniform set of orientations.

`settings` says what a map is of; `measured` what is kept of a pose's solutions; `block` works out
the voxels of a block; `dataset` is the answer with its units; `reach_map` puts them together.
"""

from dh2urdf.workspace.reach.orientations import cone
from dh2urdf.workspace.reach.reach_map import reach_map
from dh2urdf.workspace.reach.settings import Grid, MapSettings
