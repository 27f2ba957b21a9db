"""What an arm reaches: the planar arm's annulus and surface, sections through a spatial arm.

Reach is decided by inverse kinematics at every point of a grid, never by the density of random
configurations, which says where an arm lingers, not what it reaches.
"""

from dh2urdf.workspace.envelope import Envelope, envelope
from dh2urdf.workspace.exact import (
    ExtremeReach,
    ReachSection,
    Ring,
    Volume,
    extreme_reach,
    reach_section,
    reach_volume,
)
from dh2urdf.workspace.maps import branch_counts, counts_at, dexterity, held_values, shares_at
from dh2urdf.workspace.nominal import mapped_robot
from dh2urdf.workspace.placing import BaseMap, Placement, base_map, place
from dh2urdf.workspace.planar import PlanarArm, planar_arm
from dh2urdf.workspace.reach import MapSummary, cone, map_summary, reach_map, settings_of, store_map
from dh2urdf.workspace.refine import Progress
from dh2urdf.workspace.section import PLANES, Plane, Section, caption, reach_ball, section
from dh2urdf.workspace.stored_map import map_surface, open_map
from dh2urdf.workspace.task import (
    Task,
    common_axis,
    default_orientation,
    orientations,
    solved,
    task_of,
    uniform_rotations,
)
