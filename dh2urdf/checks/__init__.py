"""What the consumers of a URDF would say of it: rules, and the consumers' own words.

:func:`check_urdf` walks the table of rules, each of which knows who breaks on what;
:func:`ask_all` loads the file in every consumer that is installed.
"""

from dh2urdf.checks.ask_consumers import Testimony, ask, ask_all, installed, why_not_asked
from dh2urdf.checks.findings import Consumer, Effect, Finding, Severity, Verdict
from dh2urdf.checks.mesh_files import locate
from dh2urdf.checks.rules import RULES, check_urdf
