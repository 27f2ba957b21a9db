"""Other people's forms of an arm, to a table; `dh2urdf.dh_io.forms` knows which file is which.

`ur_calibration`: what Universal Robots measures of each arm, the driver's ``calibration.yaml`` and
the controller's ``calibration.conf``.
"""

from dh2urdf.conversions.forms.ur_calibration import read_conf, read_kinematics
