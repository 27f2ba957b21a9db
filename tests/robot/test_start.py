"""What a process loads before its first answer."""

import subprocess
import sys

import pytest

FIRST = """
import sys
import dh2urdf
robot = dh2urdf.Robot.from_dh("ur5")
robot.ik(robot.fk([0.5] * 6))
print(*sys.modules)
"""

NOT_NEEDED = ("configparser", "email", "http", "numpy.ma", "scipy", "sympy", "urllib.request")
NOT_NEEDED += (
    "dh2urdf.conversions.assign",
    "dh2urdf.conversions.forms",
    "dh2urdf.dh_io.formats.csv",
)


@pytest.fixture(scope="module")
def loaded():
    """Names of all modules of such a process."""
    words = [sys.executable, "-c", FIRST]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    return done.stdout.split()


@pytest.mark.parametrize("name", NOT_NEEDED)
def test_a_first_answer_loads_no_module_that_it_does_not_ask(loaded, name):
    """Masked arrays, the web, mail and other people's algebra are not on the way."""
    assert not [m for m in loaded if m == name or m.startswith(f"{name}.")]
