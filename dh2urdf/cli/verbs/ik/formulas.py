"""What is said of all poses: formulas in the letters of the arm's table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dh2urdf.cli.output import emit_file, emit_json

if TYPE_CHECKING:
    from dh2urdf.robot import Robot


def tell_formulas(arm: Robot, format: str, *, json: bool) -> int:
    """Print the formulas of an arm in one form, or in all in JSON."""
    found = arm.symbolic_ik()
    texts = {form: getattr(found, form) for form in ("text", "markdown", "latex", "python")}
    if json:
        emit_json("ik", family=found.family, **texts)
    else:
        emit_file(texts["markdown" if format == "md" else format])
    return 0
