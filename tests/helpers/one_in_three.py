"""A plugin (``-p tests.helpers.one_in_three``): of the tests of the families one in three runs.

All of them run as they are installed; what they solve differs between processors in kernels that
tests of all forms compare to the bit.
"""

SAMPLED = "tests/ik/families"


def pytest_collection_modifyitems(config, items):
    """Leave out two of three, whichever process collects them."""
    sampled = [item for item in items if item.nodeid.startswith(SAMPLED)]
    left = set(sampled) - set(sampled[::3])
    config.hook.pytest_deselected(items=list(left))
    items[:] = [item for item in items if item not in left]
