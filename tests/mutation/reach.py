"""Which tests reach a line: of a run of ``tests.marked`` with its plugin ``each``."""

import json
from bisect import bisect_right
from collections import defaultdict
from pathlib import Path

from tests.marked.written import statements

SECONDS = 60.0
"""Of all tests that a change is shown to, as long as they took unchanged."""

FIRST = "tests/translate/test_golden.py"


class Reach:
    """Tests by the statements that they reach."""

    def __init__(self, place: Path) -> None:
        places = json.loads((place / "places.json").read_text())
        rows = [json.loads(row) for row in (place / "each.jsonl").read_text().splitlines()]
        rows = [row for row in rows if row["passed"] and "[/" not in row["test"]]
        # those with a path are named by where the copy is
        self.seconds = {row["test"]: row["seconds"] for row in rows}
        self.golden = {test for test in self.seconds if test.startswith(FIRST)}
        """For lines that are no part of what is compiled: tables are made by them."""
        self.tests = defaultdict[str, dict[int, set[str]]](dict)
        """Of each file, by the line at which a statement begins."""
        for file, _, line in [*places, *statements(place / "dh2urdf/kernels")]:
            self.tests[_path(file)].setdefault(line, set())
        for row in rows:
            compiled = ((places[k][0], places[k][2]) for k in row["reached"])
            for file, line in [*compiled, *row["interpreted"]]:
                self.tests[_path(file)].setdefault(line, set()).add(row["test"])

    def of(self, file: str, line: int) -> list[str]:
        """Tests that reach a line: golden answers first, then the quickest, for so many seconds."""
        lines = sorted(self.tests[file])
        at = bisect_right(lines, line) - 1
        found = (at >= 0 and self.tests[file][lines[at]]) or self.golden
        order = sorted(found, key=lambda t: (not t.startswith(FIRST), self.seconds[t]))
        total, out = 0.0, list[str]()
        for test in order:
            total += self.seconds[test]
            if total < SECONDS:
                out.append(test)
        return out


def _path(file: str) -> str:
    """Files of kernels are named by where they are below these."""
    return file if file.startswith("dh2urdf/") else f"dh2urdf/kernels/{file}"
