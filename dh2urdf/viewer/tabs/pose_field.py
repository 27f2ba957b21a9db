"""The target as text: typed or pasted in any form, copied out in the one chosen."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np

from dh2urdf.dh_io import Kind, Units, parse_cell
from dh2urdf.drawing.readings import MINUS, UNITS, scale_of, sign_of
from dh2urdf.exceptions import Dh2UrdfError, PoseError, TableError
from dh2urdf.grids import number
from dh2urdf.poses import check_pose, nearest_rotation
from dh2urdf.transforms import Array, matrix_to_rpy, pose, quaternion_to_matrix, rpy_to_matrix
from dh2urdf.viewer.arm_scene import quaternions
from dh2urdf.viewer.door import by_visitor
from dh2urdf.viewer.tabs import html
from dh2urdf.viewer.tabs.editor import copy_button, editor

FORMS = ("xyz, rpy", "xyz, quaternion xyzw", "4 × 4")

HEIGHT = 84
"""Of the field [px]: four rows of a matrix."""

WORDS = re.compile(r"[\[\](){},;=:|]|\b(?:np|numpy|array|matrix|xyz|rpy|quaternion|xyzw|T)\b")
"""What may stand around the numbers of a pasted pose."""

DIGITS = {"m": 8, "mm": 5, "deg": 7, "rad": 8, "": 8}
"""Digits after the point that are copied out, by unit."""

ROUNDED = 1e-7
"""Angle [rad] from which it is said that a rotation was rounded: more than our own digits leave."""

NEEDED = "3 (xyz), 6 (xyz, rpy), 7 (xyz, quaternion xyzw), 12 or 16 (matrix by rows)"


class PoseField:
    """A field with the target's pose; ``on_pose`` is called with one that was typed (4, 4)."""

    def __init__(self, gui: Any, on_pose: Callable[[Array, Any], None]) -> None:
        self.on_pose = on_pose
        self.T, self.units = np.eye(4), UNITS
        with gui.add_folder("Target as text", expand_by_default=False):
            self.form = gui.add_dropdown("Written as", FORMS, initial_value=FORMS[0])
            self.field = editor(gui, "pose", "Type or paste a pose in any of the forms", HEIGHT)
            gui.add_html(copy_button("pose"))
            self.set = gui.add_button("Set the target")
            self.note = gui.add_html("")
        self.form.on_update(by_visitor(lambda _: self.show(self.T, self.units)))
        self.set.on_click(by_visitor(lambda event: self._set(event.client)))

    def show(self, T: Array, units: Units) -> None:
        """Write a pose (4, 4) in the form chosen."""
        self.T, self.units = T, units
        text = pose_text(T, self.form.value, units)
        if self.field.value != text:
            self.field.value, self.note.content = text, ""

    def _set(self, visitor: Any) -> None:
        try:
            T, far = read_pose(self.field.value, self.units, self.T)
        except Dh2UrdfError as error:
            self.note.content = html.message(f"{error}\nThe target stays.", "bad")
            return
        self.on_pose(T, visitor)
        if far > ROUNDED:
            words = f"Rounded: the nearest rotation was taken, {far:.1e} rad away."
            self.note.content = html.message(words)


def pose_text(T: Array, form: str, units: Units) -> str:
    """A pose (4, 4) in one of the forms, lengths and angles in their units."""
    xyz = _line(T[:3, 3], Kind.LENGTH, units)
    if form == FORMS[0]:
        return f"xyz {xyz}\nrpy {_line(matrix_to_rpy(T), Kind.ANGLE, units)}"
    if form == FORMS[1]:
        w, *vector = quaternions(T[:3, :3])
        return f"xyz {xyz}\nquaternion {_line((*vector, w), Kind.NUMBER, units)}"
    rows = [
        f"{_line(row[:3], Kind.NUMBER, units)} {_line(row[3:], Kind.LENGTH, units)}"
        for row in T[:3]
    ]
    return "\n".join([*rows, "0 0 0 1"])


def _line(values: Any, kind: Kind, units: Units) -> str:
    scale, digits = scale_of(units, kind), DIGITS[units.of(kind)]
    return " ".join(number(round(float(v) * scale, digits) + 0.0, minus="-") for v in values)


def read_pose(text: str, units: Units, T: Array) -> tuple[Array, float]:
    """A pose in any of the forms, and how far [rad] its rotation is from what was written.

    Three numbers leave the rotation of ``T`` as it is. Raises PoseError.
    """
    cells = WORDS.sub(" ", text.replace(MINUS, "-")).split()
    kinds = _kinds(len(cells))
    values = []
    for k, (cell, kind) in enumerate(zip(cells, kinds, strict=True), 1):
        try:
            values.append(parse_cell(cell, kind, units))
        except TableError as error:
            sign = sign_of(units, kind)
            raise PoseError(f"number {k}{f' [{sign}]' * bool(sign)}: {cell!r}: {error}") from None
    v = np.array(values)
    if len(v) == 3:
        return pose(T[:3, :3], v), 0.0
    if len(v) == 6:
        return pose(rpy_to_matrix(v[3:].tolist()), v[:3]), 0.0
    if len(v) == 7:
        size = float(np.linalg.norm(v[3:]))
        if not 0.95 < size < 1.05:
            raise PoseError(f"the quaternion must have length 1, got {size:.3g}")
        return pose(quaternion_to_matrix(v[3:] / size), v[:3]), 0.0
    matrix = np.vstack([v.reshape(-1, 4)[:3], v[12:] if len(v) == 16 else np.eye(4)[3:]])
    nearest, far = nearest_rotation(matrix, what="the matrix")
    return check_pose(nearest, what="the matrix"), float(far)


def _kinds(count: int) -> list[Kind]:
    """What each of so many numbers measures."""
    length, angle, plain = Kind.LENGTH, Kind.ANGLE, Kind.NUMBER
    row = [plain] * 3 + [length]
    forms = {3: [length] * 3, 6: [length] * 3 + [angle] * 3, 7: [length] * 3 + [plain] * 4}
    forms |= {12: row * 3, 16: row * 3 + [plain] * 4}
    if count not in forms:
        raise PoseError(f"a pose is written with {NEEDED} numbers, got {count}")
    return forms[count]
