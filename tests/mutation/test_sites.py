"""Changes are programs, each another one, and all that is said of a line is tried."""

import ast

from tests.mutation.__main__ import ROOMS, ROOT, drawn
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
