"""One to five joints of any kind, planar arms, sliding arms, and the task ``position``.

`poses` solves the closed loop as a linear system (`loop`, then `candidates`); `position` puts
the tool's origin at a point; `planar` are the notes' RR and RRR arms (8.2), `three_slides` arms
with three sliding joints; `search` looks from many starts where the loop says too little.
"""

from dh2urdf.kernels.short_chains.loop import loop_columns, loop_matrix
from dh2urdf.kernels.short_chains.planar import planar_rr, solve_planar
from dh2urdf.kernels.short_chains.poses import ShortChain, close_loop, solve_short_chains
from dh2urdf.kernels.short_chains.position import solve_short_positions
from dh2urdf.kernels.short_chains.search import come_near, search_starts
from dh2urdf.kernels.short_chains.three_slides import solve_three_slides
