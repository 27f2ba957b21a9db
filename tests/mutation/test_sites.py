"""Changes are programs, each another one, and all that is said of a line is tried."""

import ast
import json

from tests.mutation import __main__ as tool
from tests.mutation.__main__ import ROOMS, ROOT, drawn
from tests.mutation.reach import FIRST, Reach
from tests.mutation.sites import changed, sites

TEXT = '''
def f(a: int = 1) -> float:
    """A text: 1 < 2."""
    if a < 2 and not a == -3:
        a += 1
    return 2.5 * (a + 1)
'''

CHANGED = """
a <= 2; a >= 2; a < 3; a < 2 or not; a < 2 and a == -3; not a != -3; a == 3; not a == -4;
pass; a += 2; 5.0; 2.5 / (; (a - 1; (a + 2
"""


def test_each_part_of_a_line_is_changed():
    """Comparisons, signs, numbers, words and statements; no annotation, default or docstring."""
    found = {changed(TEXT, site) for site in sites(TEXT)}
    assert len(found) == len(CHANGED.split(";"))
    for part in CHANGED.split(";"):
        assert sum(part.strip() in text for text in found) == 1, part


def test_changes_of_the_package_are_programs():
    """Of each room some are drawn, the same for the same seed; none is a fault of syntax."""
    for room in ROOMS:
        assert drawn(room, 20, 3) == drawn(room, 20, 3)
        for file, site in drawn(room, 20, 3):
            text = (ROOT / file).read_text()
            assert ast.dump(ast.parse(changed(text, site))) != ast.dump(ast.parse(text))


def test_the_share_is_of_changes_that_no_test_sees_now(monkeypatch):
    """Those that a test was added for count as seen; those that change nothing are told apart."""
    seen = ["", "seen since by `a.py`", "the same: as long", "why"]
    rows = [["kernels", "1", "f.py", "3", "0", "<", "<=", "survived", why] for why in seen]
    rows += [["kernels", "1", "f.py", "4", "0", "1", "2", how, ""] for how in ("answers", "none")]
    monkeypatch.setattr(tool, "kept", lambda: rows)
    assert "| kernels | 5 | 1 | 0 | 0 | 4 | 1 | 1 | 2 | 60.0% | 50.0% | 75.0% |" in tool.page()


def test_a_line_is_shown_to_tests_that_run_it_compiled_or_interpreted(tmp_path):
    """Golden answers first, then the quickest; lines that none reaches to the golden answers."""
    (tmp_path / "dh2urdf/kernels").mkdir(parents=True)
    text = "def f(x):\n    y = x\n    return y\n\n\ndef g():\n    return 1\n"
    (tmp_path / "dh2urdf/kernels/one.py").write_text(text)
    (tmp_path / "places.json").write_text(json.dumps([["one.py", "f", 2], ["one.py", "f", 3]]))
    golden, quick, slow, bad = f"{FIRST}::test", "quick", "slow", "bad"
    rows = [(golden, 9.0, [0], []), (slow, 2.0, [0], []), (bad, 0.1, [0, 1], [])]
    rows += [(quick, 1.0, [], [["one.py", 2]])]
    keys = "test", "seconds", "reached", "interpreted"
    lines = [dict(zip(keys, row, strict=True)) | {"passed": row[0] != bad} for row in rows]
    (tmp_path / "each.jsonl").write_text("\n".join(map(json.dumps, lines)))
    reach = Reach(tmp_path)
    assert reach.of("dh2urdf/kernels/one.py", 2) == [golden, quick, slow]
    assert (
        reach.of("dh2urdf/kernels/one.py", 3) == reach.of("dh2urdf/kernels/one.py", 7) == [golden]
    )
