"""Other people's forms of an arm, to a table and back; `dh2urdf.dh_io.forms` knows a file's form.

`opw`, `screws` and `kdl` read and write OPW parameters, screw axes with the home pose, and KDL's
segments, with what is in `parts`. `ur_calibration` reads what Universal Robots measures of each
arm: the driver's ``calibration.yaml`` and the controller's ``calibration.conf``.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

from dh2urdf.chain import SerialChain
from dh2urdf.conversions.forms import kdl, opw, screws
from dh2urdf.conversions.forms.kdl import read_kdl
from dh2urdf.conversions.forms.opw import OPW_KEYS, read_opw
from dh2urdf.conversions.forms.parts import form_text
from dh2urdf.conversions.forms.screws import read_axes_form, screw_axes
from dh2urdf.conversions.forms.ur_calibration import read_conf, read_kinematics


class Form(NamedTuple):
    """How a form is written: what a file says of a chain, and the comment above it."""

    content: Callable[[SerialChain, str], dict[str, Any]]
    head: str


FORMS = {
    "opw": Form(opw.opw_content, opw.HEAD),
    "screws": Form(screws.screws_content, screws.HEAD),
    "kdl": Form(kdl.kdl_content, kdl.HEAD),
}
