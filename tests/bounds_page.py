"""The page that lists the bounds, made from their module: ``python tests/bounds_page.py``."""

import ast
import itertools
import math
from pathlib import Path

from dh2urdf import bounds

PAGE = Path(__file__).parents[1] / "docs" / "bounds.md"

HEAD = """# Bounds

What is taken in has bounds, and what lies beyond is refused with a message that names them. This
page is written from `dh2urdf/bounds.py` by `python tests/bounds_page.py`.
"""

TABLE = "| name | value | reason |\n| --- | --- | --- |"


def page():
    """Sections by the module's comments, a row for each name: value and reason."""
    source = Path(bounds.__file__).read_text()
    lines, body = source.splitlines(), ast.parse(source).body
    out, last = [HEAD], 0
    for statement, reason in itertools.pairwise(body):
        if not isinstance(statement, ast.Assign):
            continue
        above = [line[2:] for line in lines[last : statement.lineno] if line.startswith("# ")]
        out += [
            f"\n## {title}\n\n| name | value | reason |\n| --- | --- | --- |" for title in above
        ]
        name, last = statement.targets[0].id, reason.end_lineno
        text = " ".join(reason.value.value.split())
        out.append(f"| `{name}` | {_value(getattr(bounds, name))} | {text} |")
    return "\n".join(out) + "\n"


def _value(value):
    if isinstance(value, tuple):
        return " to ".join(map(_value, value))
    large = value >= 1e6 and math.log10(value).is_integer()
    return f"{value:.0e}".replace("e+0", "e").replace("e+", "e") if large else f"{value:,.10g}"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
