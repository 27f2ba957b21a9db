"""Licences of what users install with the package."""

from licences import licences


def test_all_that_users_install_goes_with_bsd():
    """Each dependency of the extra `all` that is installed has a licence known to allow it."""
    found = licences("all")
    assert {"pin", "numpy", "lxml"} <= {one.name for one in found}
    assert [one for one in found if not one.compatible] == []
