"""Where a robot should stand: bases from which all poses of a job are reached with margin.

`asked` checks what is asked, `job` says what a base is worth, `lattice` which bases are tried,
`placement` takes the best one and says which poses stand in the way where none is found.
"""

from dh2urdf.workspace.placing.job import Job
from dh2urdf.workspace.placing.lattice import BaseMap
from dh2urdf.workspace.placing.placement import Placement, base_map, place
