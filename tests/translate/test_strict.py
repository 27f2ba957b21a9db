"""Kernels keep to their arrays, where these refuse what C would follow."""

from itertools import islice

import numpy as np
import pytest

from tests.translate import strict, workload


def first(values, k):
    return values[k]


def stretch(values, k):
    return values[0:k].sum()


@pytest.mark.parametrize("kernel", [first, stretch])
def test_an_index_outside_is_refused_in_kernels_alone(kernel, monkeypatch):
    """Negative ones and those beyond the end, of entries and of views."""
    values = np.arange(3.0).view(strict.Strict)
    assert values[-1] == 2.0
    monkeypatch.setattr(strict, "is_kernel", lambda _: True)
    assert kernel(values, 2) >= 1.0
    for k in (-1, 4):
        with pytest.raises(strict.OutsideError):
            kernel(values, k)


ARMS = [(workload.NUMBERS, None), ("three slides", 10), ("planar_rr", None)]
"""Arms, and how many of their tasks the daily suite asks: the others, without limits, reach no
other line."""

WHOLE = [
    pytest.param(arm, None, marks=pytest.mark.exhaustive) for arm in ("three slides", "puma560")
]


@pytest.mark.parametrize(("arm", "tasks"), [*ARMS, *WHOLE])
def test_kernels_stay_inside_their_arrays(arm, tasks):
    """What they are asked for their golden answers never leads outside; scratch begins as NaN."""
    with np.errstate(all="ignore"), strict.strict_kernels():
        assert sum(1 for _ in islice(workload.answers(arm, 5), tasks)) >= (tasks or 1)
