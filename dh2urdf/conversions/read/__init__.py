"""From a robot file to a tree of links and joints.

`kinematic_tree` is the result. `description` takes any format (`apart` runs foreign readers in a
process of their own, `xacro_file` says what a xacro takes, `packages` where others lie) and
hands the tree to Pinocchio; `urdf_tree` reads a URDF,
`urdf_elements` its elements one by one, with what is obvious mended, `read_mjcf` an MJCF.
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
    Actuation,
    KinematicTree,
    Step,
    TreeJoint,
    find_path,
    link_name,
    listed,
    no_such,
    rigid_part,
)
from dh2urdf.conversions.read.packages import find_package
from dh2urdf.conversions.read.urdf_elements import FLOAT
from dh2urdf.conversions.read.urdf_tree import count_elements
from dh2urdf.conversions.read.xacro_file import NOTHING, Xacro, xacro_given
