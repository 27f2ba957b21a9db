"""From a DH table to a URDF, proved.

`table_chain`, `urdf_elements` (every joint and link of the file), `bodies`, `link_paths` and
`inertia` (what is drawn and weighed), `urdf_file` (the whole way, checked by `verify`),
`urdf_options`; `unfiled_model` and `link_masses` (Pinocchio's model of it without a file);
`mjcf_file` the same for MuJoCo; `table_file` writes tables in their own formats, `constructors` as
code of other toolboxes.
"""

from dh2urdf.conversions.write.bodies import Body, draw_bodies, frame_along
from dh2urdf.conversions.write.constructors import CONSTRUCTORS
from dh2urdf.conversions.write.inertia import (
    TENSOR,
    Inertial,
    inertial_element,
    six_of,
    tensor,
    why_impossible,
    without_noise,
)
from dh2urdf.conversions.write.link_paths import is_far, straight_points
from dh2urdf.conversions.write.mjcf_file import verified_mjcf, write_mjcf
from dh2urdf.conversions.write.table_chain import (
    FLIP,
    LinkFrames,
    dh_to_chain,
    grouped_rows,
    link_frames,
    turned_round,
)
from dh2urdf.conversions.write.table_file import table_difference, table_text_and_error
from dh2urdf.conversions.write.unfiled_model import add_masses, table_model
from dh2urdf.conversions.write.urdf_elements import (
    DEFAULT_EFFORT,
    DEFAULT_VELOCITY,
    default_limits,
    urdf_text_and_warnings,
)
from dh2urdf.conversions.write.urdf_file import (
    ConversionReport,
    urdf_text,
    verified_urdf,
    write_urdf,
)
from dh2urdf.conversions.write.urdf_options import UrdfOptions
