"""A map of reach in the view: a surface that the panel's share moves."""

import numpy as np
import pytest

from dh2urdf import Robot
from dh2urdf.exceptions import ArgumentError, UnreachedError
from dh2urdf.viewer.tabs.table_tab import new_table
from dh2urdf.workspace import map_surface, reach_map

pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def found():
    """A coarse map of the Puma."""
    return reach_map(Robot.from_dh("puma560"), step=0.15, orientations=20)


def test_the_surface_follows_the_share_and_opens(found):
    """Corners are those of the level; half has fewer triangles; an edited arm takes it away."""
    with Robot.from_dh("puma560").view(port=0) as view:
        view.show_reach(found)
        scene = view._reach
        corners, triangles = map_surface(found, scene.level.value)
        assert 0.2 < len(scene._mesh.faces) / len(triangles) < 0.6
        scene.half.value = False
        scene.draw()
        np.testing.assert_allclose(scene._mesh.vertices, corners, atol=1e-6)
        assert len(scene._mesh.faces) == len(triangles)
        scene.level.value = 1.0
        scene.draw()  # where all orientations are reached
        assert 0 < len(scene._mesh.faces) < len(triangles)
        view.show_reach(found)
        assert view._reach is not scene
        view._edited(new_table())
        assert view._reach is None


def test_no_map_and_an_empty_one_are_refused(found):
    """And what was shown stays."""
    with Robot.from_dh("puma560").view(port=0) as view:
        view.show_reach(found)
        before = view._reach
        with pytest.raises(ArgumentError, match="no such map"):
            view.show_reach("nowhere.zarr")
        with pytest.raises(UnreachedError):
            view.show_reach(found * 0)
        assert view._reach is before
