"""The bounds: one module, each with its reason, listed in the documentation, each in use."""

import re
from pathlib import Path

from bounds_page import PAGE, page

from dh2urdf import bounds

PACKAGE = Path(bounds.__file__).parent


def test_the_page_of_bounds_is_written_from_their_module():
    """docs/bounds.md says what dh2urdf/bounds.py says."""
    assert PAGE.read_text(encoding="utf-8") == page()


def test_every_bound_is_used():
    """No name stands in bounds.py that nothing asks."""
    text = "\n".join(p.read_text() for p in PACKAGE.rglob("*.py") if p.name != "bounds.py")
    names = [name for name in vars(bounds) if name.isupper()]
    assert [name for name in names if not re.search(rf"\b{name}\b", text)] == []
