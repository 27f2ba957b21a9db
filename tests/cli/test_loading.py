"""What is loaded, and when: heavy packages come with the call that needs them."""

import subprocess
import sys

import pytest

HEAVY = "matplotlib viser mujoco dask yourdfpy sympy scipy"

CONVERT = """
from dh2urdf.cli import main
try: main(["convert", "ur5", "-o", "-"])
except SystemExit as stop: assert stop.code == 0
"""

CSV = """
import dh2urdf.dh_io as io
io.parse_table("# convention: standard\\n# units: m, rad\\ntheta,d,a,alpha\\n0,1,2,3\\n", "csv")
"""

FIGURE = """
import dh2urdf
assert dh2urdf.Robot.from_dh("planar_rr").figure()._repr_png_().startswith(b"\\x89PNG")
"""

OURS = "dh2urdf dh2urdf.cli dh2urdf.cli.progress dh2urdf.exceptions"


def loaded(code):
    """Modules that a Python process has when it has run some code."""
    program = f"import sys\n{code}\nprint(file=sys.stderr, *sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return set(done.stderr.split())


@pytest.mark.parametrize(
    ("code", "spared"),
    [
        ("import dh2urdf", f"pinocchio rich cyclopts lxml {HEAVY}"),
        ("import dh2urdf.cli", "numpy cyclopts rich pinocchio"),
        (CONVERT, HEAVY),
        ("import dh2urdf; dh2urdf.Robot.from_dh('ur5e')", "viser matplotlib"),
        (CSV, "ruamel ruamel.yaml pinocchio matplotlib"),
        (FIGURE, "matplotlib.pyplot"),
    ],
    ids=["import", "cli", "convert", "robot", "csv", "notebook"],
)
def test_nothing_is_loaded_before_it_is_needed(code, spared):
    """The package, a command, a robot, a CSV file and a picture come without what others need."""
    assert not loaded(code) & set(spared.split())


def test_the_command_line_is_imported_before_anything_heavy():
    """What is imported outside of the guarded part is the package's names and errors alone."""
    ours = {name for name in loaded("import dh2urdf.cli") if name.startswith("dh2urdf")}
    assert ours == set(OURS.split())
