"""From a robot file to a tree of links and joints.

`description` takes any format (`apart` runs foreign readers in a process of their own); `read_urdf`
and `urdf_reader` read a URDF and mend what is obvious, `read_mjcf` an MJCF; `kinematic_tree` is
the result, `bare_urdf` hands it to Pinocchio, `naming` names things in messages.
"""

from dh2urdf.conversions.read.description import (
    TEXT,
    description_bytes,
    is_xacro,
    mended_urdf,
    read_description,
)
from dh2urdf.conversions.read.kinematic_tree import (
    MOVING,
    TIP_NAMES,
    KinematicTree,
    Mimic,
    Step,
    find_path,
    rigid_part,
)
from dh2urdf.conversions.read.naming import link_name, listed, no_such
from dh2urdf.conversions.read.urdf_tree import count_elements
from dh2urdf.conversions.read.mended_elements import FLOAT
