"""Where the bodies of a link run: from joint to joint."""

import numpy as np
import pytest

from dh2urdf.conversions.write.link_paths import link_paths
from dh2urdf.conversions.write.table_chain import dh_to_chain, link_frames
from dh2urdf.dh import DHRow, DHTable


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_link_goes_on_through_the_fixed_rows_after_its_joint(convention):
    """To the frame that the last of them ends in, where the next joint begins."""
    rows = (
        (0, 0.1, 0.3, 0.2, "revolute"),
        (0.4, 0.2, 0.1, 1.0, "fixed"),
        (0, 0.3, 0.2, 0, "revolute"),
    )
    table = DHTable(tuple(DHRow(*row) for row in rows), convention)
    frames = link_frames(table)
    path, end = np.array(link_paths(table, dh_to_chain(table), frames)[1]), frames.dh[1][:3, 3]
    assert np.linalg.norm(end) > 0.2
    assert np.linalg.norm(path - end, axis=1).min() < 1e-15
