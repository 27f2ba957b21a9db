"""The DH table: a row explained, cells edited, the URDF to take away."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from dh2urdf.conversions.write import verified_urdf
from dh2urdf.dh import DHConvention, DHRow, DHTable, JointType
from dh2urdf.dh_io import Kind, Units, parse_cell, parse_table, table_to_text
from dh2urdf.dh_io.cells.units import decimal_text
from dh2urdf.drawing.lesson import Motion, lesson_words, walked
from dh2urdf.drawing.readings import UNITS, sign_of
from dh2urdf.drawing.row import DHRowPicture, length_index, row_words, subscript
from dh2urdf.exceptions import Dh2UrdfError, TableError
from dh2urdf.viewer.door import by_visitor, send
from dh2urdf.viewer.tabs import html
from dh2urdf.viewer.tabs.editor import caret, editor
from dh2urdf.viewer.tabs.html import KINDS_OF, SYMBOLS

NOTHING = "none"

WAYS = {"‹ Previous": -1, "Next ›": 1, "All at once": 0}
"""Buttons of the lesson that goes motion by motion."""

EDITOR_HEIGHT = 300
"""Of the YAML field [px]; its corner drags it taller."""

PLACE = re.compile(r"table:(\d+):(\d+):")
"""Where the first fault of a text stands."""


class TableTab:
    """Shows, explains and edits the table.

    ``on_explain`` is called with the row to explain, 0 for none, and the visitor who asked;
    ``on_table`` with an edited table and the visitor, and raises Dh2UrdfError where it cannot be.
    """

    def __init__(
        self,
        gui: Any,
        tab: Any,
        on_explain: Callable[[int, Any], None],
        on_table: Callable[[DHTable, Any], None],
    ) -> None:
        self.gui, self.on_explain, self.on_table = gui, on_explain, on_table
        self.table = new_table()
        self.row, self.units = 0, UNITS
        self.step: int | None = None
        with tab:
            self.shown = gui.add_html("")
            self.choice = gui.add_dropdown("Explain row", (NOTHING,), initial_value=NOTHING)
            self.walk = gui.add_button_group("Motions", tuple(WAYS))
            self.words = gui.add_html("")
            with gui.add_folder("Edit the row", expand_by_default=False) as self.row_folder:
                self.cells = self._cells()
            with gui.add_folder("Edit the whole table", expand_by_default=False):
                self.text = editor(gui, "yaml", "YAML", EDITOR_HEIGHT)
                self.rebuild = gui.add_button("Rebuild the arm")
            self.note = gui.add_html("")
            self.save_urdf = gui.add_button("Save the URDF")
            self.save_table = gui.add_button("Save the table")
        self.choice.on_update(by_visitor(self._chosen))
        self.walk.on_click(by_visitor(self._walked))
        self.apply.on_click(by_visitor(lambda event: self._try(self._with_row_cells, event.client)))
        self.rows.on_click(by_visitor(lambda event: self._try(self._with_rows, event.client)))
        self.rebuild.on_click(by_visitor(lambda event: self._try(self._with_text, event.client)))
        self.save_urdf.on_click(self._save_urdf)
        self.save_table.on_click(self._save_table)

    def _cells(self) -> dict[str, Any]:
        gui = self.gui
        cells = {
            "joint_type": gui.add_dropdown("joint", ("revolute", "prismatic")),
            **{key: gui.add_text(SYMBOLS[key], "") for key in SYMBOLS},
            "sign": gui.add_dropdown("sign of q", ("+1", "-1")),
            "lower": gui.add_text("lower", ""),
            "upper": gui.add_text("upper", ""),
        }
        self.apply = gui.add_button("Apply to the row")
        self.rows = gui.add_button_group("Rows", ("Add below", "Remove"))
        return cells

    def build(self, table: DHTable, units: Units) -> None:
        """Show another table, or other units; the row stays chosen where it still exists."""
        kept = self.step if table == self.table else None
        self.table, self.units = table, units
        self.choice.options = (NOTHING, *[str(i) for i in range(1, table.n + 1)])
        self.text.value = table_to_text(table, "yaml", units)
        self.choose(min(self.row, table.n))
        self.step = kept

    def explain(self, picture: DHRowPicture | None, steps: Sequence[Motion] = ()) -> None:
        """Say what a row says, with its matrix, or which motion is made; None says nothing."""
        if picture is None:
            self.words.content = html.message(
                "Choose a row to see what its numbers measure, "
                "or Next to go through the table motion by motion."
            )
            return
        name = f"T<sub>{picture.i - 1},{picture.i}</sub>"
        if self.step is not None:
            said = lesson_words(self.table, picture, steps, self.step, self.units)
            self.words.content = html.lesson(said, picture.i, steps, self.step, self.units)
            return
        words = html.message(row_words(self.table, picture, self.units))
        self.words.content = words + html.matrix(picture.T_prev_next, name, self.units)

    def choose(self, row: int) -> None:
        """Choose a row, 0 for none, as a visitor would."""
        self.row, self.step = row, None
        self.choice.value = str(row) if row else NOTHING
        self._refresh()

    def say(self, text: str, kind: str = "info") -> None:
        """Put a note under the table."""
        self.note.content = html.message(text, kind) if text else ""

    def _refresh(self) -> None:
        self.shown.content = html.table(self.table, self.row, self.units)
        self.row_folder.visible = self.row > 0
        if not self.row:
            return
        row = self.table.joints[self.row - 1]
        bound = Kind.LENGTH if row.joint_type is JointType.PRISMATIC else Kind.ANGLE
        shown = {
            "joint_type": str(row.joint_type),
            **{key: self._typed(getattr(row, key), kind) for key, kind in KINDS_OF.items()},
            "sign": f"{row.sign:+d}",
            "lower": "" if row.lower is None else self._typed(row.lower, bound),
            "upper": "" if row.upper is None else self._typed(row.upper, bound),
        }
        for key, text in shown.items():
            self.cells[key].value = text
        for key, sign in SYMBOLS.items():
            index = length_index(self.table, self.row) if key[0] == "a" else self.row
            unit = sign_of(self.units, KINDS_OF[key])
            self.cells[key].label = f"{subscript(sign, index)} [{unit}]"
        for key in ("lower", "upper"):
            self.cells[key].label = f"{key} [{sign_of(self.units, bound)}]"

    def _typed(self, value: float, kind: Kind) -> str:
        """All digits of a number, as one would type it."""
        return decimal_text(value, self.units.of(kind))

    def _walked(self, event: Any) -> None:
        """Go on or back by one motion, or see all of the row's at once."""
        before, way = self.row, WAYS[self.walk.value]
        row, step = walked(self.table, self.row, self.step, way) if way else (self.row, None)
        self.choose(row)
        self.step = step
        self.on_explain(row, event.client if row != before else None)

    def _chosen(self, event: Any) -> None:
        self.step = None
        self.row = 0 if self.choice.value == NOTHING else int(self.choice.value)
        self._refresh()
        self.on_explain(self.row, event.client)

    def _try(self, edit: Callable[[], DHTable], visitor: Any = None) -> None:
        """Make the edited table the arm's, or say what is wrong and change nothing."""
        try:
            table = edit()
            self.on_table(table, visitor)
        except Dh2UrdfError as error:
            self.say(f"{error}\nNothing was changed.", "bad")
            if place := PLACE.match(str(error)):
                line, column = map(int, place.groups())
                self.note.content += caret("yaml", line, column, self.rebuild.label)
        else:
            self.say(f"The arm was rebuilt: {table.n} joints.", "good")

    def _with_row_cells(self) -> DHTable:
        slides = self.cells["joint_type"].value == "prismatic"
        bound = Kind.LENGTH if slides else Kind.ANGLE
        found: dict[str, float | None] = {"lower": None, "upper": None}
        problems: list[str] = []
        for key in (*KINDS_OF, *found):
            text = self.cells[key].value.strip()
            try:
                if text or key in KINDS_OF:
                    found[key] = parse_cell(text, KINDS_OF.get(key, bound), self.units)
            except TableError as error:
                problems.append(f"{self.cells[key].label}: {text!r}: {error}")
        if problems:
            raise TableError(problems)
        row = replace(
            self.table.joints[self.row - 1],
            joint_type=JointType(self.cells["joint_type"].value),
            sign=int(self.cells["sign"].value),
            **found,  # type: ignore[arg-type]
        )
        return self._with(row)

    def _with(self, *rows: DHRow) -> DHTable:
        """The table with other rows in place of the joint's that is chosen."""
        old = self.table.rows
        at = [k for k, row in enumerate(old) if row.is_joint][self.row - 1]
        return replace(self.table, rows=(*old[:at], *rows, *old[at + 1 :]))

    def _with_rows(self) -> DHTable:
        if self.rows.value == "Remove":
            return self._with()
        known = set(self.table.joint_names)
        name = next(f"joint_{k}" for k in range(1, 1000) if f"joint_{k}" not in known)
        return self._with(self.table.joints[self.row - 1], DHRow(a=0.1, name=name))

    def _with_text(self) -> DHTable:
        return parse_table(self.text.value, "yaml", "table").table

    def _save_urdf(self, event: Any) -> None:
        try:
            text, max_error, warnings = verified_urdf(self.table)
        except Dh2UrdfError as error:
            self.say(str(error), "bad")
            return
        name = send(event.client, self.table.name, "urdf", text.encode())
        notes = "".join(f"\n{warning}" for warning in warnings)
        checked = f"largest difference between Pinocchio and the DH product {max_error:.1e}"
        self.say(f"{name}: {checked}{notes}", "good")

    def _save_table(self, event: Any) -> None:
        text = table_to_text(self.table, "yaml")
        name = send(event.client, self.table.name, "yaml", text.encode())
        self.say(f"{name} was sent to your browser.", "good")


def new_table() -> DHTable:
    """Where a table that is typed in from scratch begins: one joint."""
    row = DHRow(a=0.5, name="joint_1")
    return DHTable((row,), DHConvention.STANDARD, "my_arm")
