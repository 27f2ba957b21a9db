"""What is known of an arm's reach without a grid: extremes, the section's boundary, the volume.

`carried_point` says which point is meant and how it moves, `extremes` finds its farthest and
nearest places, `zero_curves` traces where a function of two joints is zero, `boundary` which pieces
of such curves bound the reach, `section` puts them together, `volume` turns them about axis 1.
"""

from dh2urdf.workspace.exact.extremes import ExtremeReach, extreme_reach
from dh2urdf.workspace.exact.section import ReachSection, Ring, reach_section
from dh2urdf.workspace.exact.volume import Volume, reach_volume
