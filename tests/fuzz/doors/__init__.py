"""The doors, by the module that knows what they take."""

from tests.fuzz.door import Door
from tests.fuzz.doors import cells, command_lines, edits, packages, poses, robots, stores, tables

DOORS: dict[str, Door] = {
    door.name: door
    for room in (tables, cells, robots, poses, command_lines, packages, stores, edits)
    for door in room.DOORS
}
