"""What is said of all poses: formulas in the letters of the arm's table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dh2urdf.cli.output import emit_file, emit_json

if TYPE_CHECKING:
    from dh2urdf.robot import Robot


def tell_formulas(arm: Robot, format: str, *, json: bool) -> int:
    """Print the formulas of an arm as text, latex or python, or all three in JSON."""
    found = arm.symbolic_ik()
    texts = {"text": found.text, "latex": found.latex, "python": found.python}
    if json:
        emit_json("ik", family=found.family, **texts)
    else:
        emit_file(texts[format])
    return 0
