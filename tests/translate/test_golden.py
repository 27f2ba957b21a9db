import pytest

from tests.translate import golden, workload
from tests.translate.record import interpreted

FAMILIES = "puma560", "ur5", "stanford", "omron_cobra600", "fanuc_crx10ia", "franka_fer"

SLICE = {"numbers": None, "planar_rr": 3, "three slides": 2, **dict.fromkeys(FAMILIES, 2)}
"""An arm a family, and how many of its tasks are answered by the kernels as they are written."""


@pytest.mark.parametrize("arm", workload.arms())
def test_answers_are_the_golden_ones(arm):
    """Every bit of every answer is what the file says: ``python -m tests.translate.golden``."""
    assert list(golden.lines(arm)) == golden.kept()[arm]


@pytest.mark.parametrize("arm", SLICE)
def test_interpreted_kernels_give_the_golden_answers(arm):
    """The kernels as they are written give the bits that compiled ones gave."""
    with interpreted():
        assert list(golden.lines(arm, SLICE[arm])) == golden.kept()[arm][: SLICE[arm]]


def test_file_names_all_arms():
    """No arm is left out, none is there that is gone."""
    assert list(golden.kept()) == workload.arms()
