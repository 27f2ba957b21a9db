"""``dh2urdf list``: the tables that ship."""

from dh2urdf.cli.options import Json
from dh2urdf.cli.output import emit, emit_json
from dh2urdf.grids import grid_text
from dh2urdf.robots import list_tables, load_table


def list_(*, json: Json = False) -> None:
    """List the tables that ship with the package."""
    tables = [load_table(name) for name in list_tables()]
    if json:
        emit_json(
            "list",
            tables=[
                {
                    "name": t.name,
                    "joints": [str(row.joint_type) for row in t.joints],
                    "convention": str(t.convention),
                    "source": t.source,
                    "checked": t.checked,
                }
                for t in tables
            ],
        )
        return
    rows = []
    for t in tables:
        letters = "".join(str(row.joint_type)[0].upper() for row in t.joints)
        rows.append([t.name, letters, str(t.convention), _short(t.source)])
    emit(grid_text(["name", "joints", "convention", "source"], rows, left=(0, 1, 2, 3)))


def _short(source: str, width: int = 60) -> str:
    line = " ".join(source.split())
    return line if len(line) <= width else line[: width - 1] + "…"
