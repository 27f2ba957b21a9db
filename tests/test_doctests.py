"""The examples in the docstrings give what they show."""

import doctest
from importlib import import_module
from pathlib import Path

import pytest

import dh2urdf

PACKAGE = Path(dh2urdf.__file__).parent
MODULES = [
    ".".join(("dh2urdf", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(
        ".__init__"
    )
    for path in sorted(PACKAGE.rglob("*.py"))
    if ">>> " in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_give_what_they_show(name):
    """Every line behind >>> prints what stands below it."""
    failed, tried = doctest.testmod(import_module(name))
    assert tried
    assert not failed


def test_every_entry_of_the_package_has_an_example():
    """Functions of the public list, and what a robot does most, are shown at work."""
    functions = [getattr(dh2urdf, name) for name in dh2urdf.__all__ if name.islower()]
    entries = [entry for entry in functions if callable(entry)]
    robot = dh2urdf.Robot
    entries += [robot.from_dh, robot.fk, robot.jacobian, robot.ik, robot.ik_batch]
    missing = [entry.__qualname__ for entry in entries if ">>> " not in entry.__doc__]
    assert missing == []
