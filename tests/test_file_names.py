"""Files of tests are imported by their bare names."""

from collections import Counter
from pathlib import Path


def test_no_two_files_of_tests_have_one_name():
    """The second one of a name would not be collected, nor would anything run with it."""
    names = Counter(path.name for path in Path(__file__).parent.rglob("test_*.py"))
    assert [name for name, count in names.items() if count > 1] == []
