"""The map of an arm's reach: a grid of positions times a uniform set of orientations.

`settings` says what a map is of, `orientations` which are tried; `measured` is what is kept of a
pose's solutions, `block` works out the voxels of a block, `refined` halves some; `dataset` is the
answer with its units, `provenance` where it came from, `store` its Zarr group; `job` is a block as
a task, `run` does all on threads or a Dask cluster; `reach_map` puts them together.
"""

from dh2urdf.workspace.reach.dataset import MapSummary, map_summary
from dh2urdf.workspace.reach.orientations import cone
from dh2urdf.workspace.reach.reach_map import reach_map, store_map
from dh2urdf.workspace.reach.settings import Grid, MapSettings, settings_of
