"""Families of arms, a module each: when it covers a chain, its constants, its kernel.

`spherical_wrist`, `closed_form` (three parallel axes), `reversed_chain` (these two, turned round so
that the tool is the base), `planar`, `short`, `short_position`, `tool_axis`, `near_family`,
`two_parallel`, `general_6r`; `straightened` (by its `straight_chain`) and `followers` (by its
`follower_plan`), where fewer values move the joints; and `numeric`, for any chain and some
solutions.
"""

from dh2urdf.ik.families.followers import Followers
from dh2urdf.ik.families.general_6r import SLIDES, General6R
from dh2urdf.ik.families.near_family import NearFamily
from dh2urdf.ik.families.numeric import NumericProblem, NumericSolutions
from dh2urdf.ik.families.planar import planar_reach, planar_rr_ik, planar_rrr_ik, wrist_centre
from dh2urdf.ik.families.short import search_short
from dh2urdf.ik.families.spherical_wrist import SphericalWrist
from dh2urdf.ik.families.tool_axis import with_tool_joint
