"""``dh2urdf list``: the tables that ship."""

from dh2urdf.cli.options import Json
from dh2urdf.cli.output import emit, emit_json
from dh2urdf.grids import grid_text
from dh2urdf.robots import list_tables, load_table, other_names


def list_(*, json: Json = False) -> None:
    """List the tables that ship with the package."""
    tables = [load_table(name) for name in list_tables()]
    if json:
        emit_json(
            "list",
            tables=[
                {
                    "name": t.name,
                    "other_names": other_names(t.name),
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
        names = ", ".join(other_names(t.name)[:3])
        rows.append([t.name, names, letters, str(t.convention), _short(t.source)])
    header = ["name", "also called", "joints", "convention", "source"]
    emit(grid_text(header, rows, left=range(5)))


def _short(source: str, width: int = 40) -> str:
    line = " ".join(source.split())
    return line if len(line) <= width else line[: width - 1] + "…"
