"""Tables from what Python programs hold: arrays, structured arrays, data frames."""

import itertools
import math

import numpy as np
import pytest

from dh2urdf import DHConvention, DHTable, JointType, list_tables, load_table
from dh2urdf.exceptions import TableError, TableFileError

KEYS = ("theta", "d", "a", "alpha")


class PandasLike:
    """The part of a pandas DataFrame that is relied upon."""

    def __init__(self, columns):
        self._columns = {name: list(values) for name, values in columns.items()}
        self.columns = list(columns)

    def __getitem__(self, name):
        return self._columns[name]

    def itertuples(self, index, name):
        """Rows as plain tuples."""
        assert (index, name) == (False, None)
        return zip(*self._columns.values(), strict=True)


class PolarsLike:
    """The part of a polars DataFrame that is relied upon."""

    def __init__(self, columns):
        self._columns = {name: list(values) for name, values in columns.items()}
        self.columns = list(columns)

    def __getitem__(self, name):
        return self._columns[name]

    def iter_rows(self):
        """Rows as tuples."""
        return zip(*self._columns.values(), strict=True)


def structured(columns):
    """A structured array with a field a column."""
    kinds = [(name, "U40" if isinstance(next(iter(v)), str) else float) for name, v in
             columns.items()]  # fmt: skip
    return np.array(list(zip(*columns.values(), strict=True)), dtype=kinds)


def records(columns):
    """A dictionary a row."""
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


HOLDERS = [PandasLike, PolarsLike, structured, dict]
ARMS = [name for name in list_tables() if all(r.origin is None for r in load_table(name).rows)]


@pytest.mark.parametrize("holder", HOLDERS)
@pytest.mark.parametrize("order", list(itertools.permutations(KEYS)))
def test_named_columns_in_any_order_are_the_array(holder, order):
    """The names count, never the order: an array without them has the stated one."""
    table = load_table("puma560")
    numbers = {key: [getattr(row, key) for row in table.rows] for key in order}
    made = DHTable.from_array(holder(numbers), "standard", name="puma560")
    plain = DHTable.from_array(np.array([numbers[key] for key in KEYS]).T, "standard")
    assert made.rows == plain.rows


@pytest.mark.parametrize("holder", [*HOLDERS, records])
@pytest.mark.parametrize("arm", ARMS)
def test_a_frame_with_kinds_names_and_limits_is_the_table(holder, arm):
    """Every shipped table through a frame whose headings tell the units."""
    table = load_table(arm)
    columns = {
        "name": list(table.joint_names),
        "type": [str(row.joint_type) for row in table.rows],
        "theta [rad]": [row.theta for row in table.rows],
        "d [m]": [row.d for row in table.rows],
        "a [m]": [row.a for row in table.rows],
        "alpha [rad]": [row.alpha for row in table.rows],
        "sign": [float(row.sign) for row in table.rows],
        "lower": [math.nan if row.lower is None else row.lower for row in table.rows],
        "upper": [math.nan if row.upper is None else row.upper for row in table.rows],
    }
    made = load_table(holder(columns), table.convention)
    keys = (*KEYS, "joint_type", "sign", "lower", "upper")
    for one, other in zip(made.rows, table.rows, strict=True):
        assert [getattr(one, k) for k in keys] == [getattr(other, k) for k in keys]
    assert made.joint_names == table.joint_names


def test_a_frame_in_millimetres_and_degrees_with_flags():
    """Units told, kinds by true and false, a variable in a cell, an empty cell."""
    frame = PandasLike(
        {"Joint": [1, 2, 3], "R": [True, np.True_, False], "θ": [None, 90.0, 0],
         "d": [np.float32(89.1), 0, "q"], "a": [0, 425, 0], "α": ["pi/2", 0, np.int64(0)]}
    )  # fmt: skip
    rows = load_table(frame, "modified", "mm,deg").rows
    assert [r.joint_type for r in rows] == ["revolute", "revolute", JointType.PRISMATIC]
    assert rows[0].d == 0.0891
    assert rows[1].theta == rows[0].alpha == math.pi / 2


@pytest.mark.parametrize(
    ("frame", "words", "says"),
    [
        ({"theta": [0], "d": [0], "a": [0], "alpha": [0]}, {}, 'give convention="standard"'),
        ({"theta": [0], "d": [0], "a": [0], "alpha": [0]}, {}, 'give units="mm,deg"'),
        ({"x": [0], "y": [0]}, {"convention": "standard"}, "no columns theta, d, a and alpha"),
        ({}, {"convention": "standard"}, "among none"),
        ([{"theta": 0, "d": 0, "a": 0, "alpha": 0}, {"theta": 0}],
         {"convention": "standard", "units": "m,rad"}, r"joints\[2\].d: missing"),
        ([{"x": 1}, 3], {}, "no columns theta, d, a and alpha among 'x'"),
        ({"theta": ["x"], "d": [0], "a": [0], "alpha": [0]},
         {"convention": "standard", "units": "m,rad"}, r"joints\[1\].theta: found 'x'"),
        ({"theta": [0] * 501, "d": [0], "a": [0], "alpha": [0]},
         {"convention": "standard", "units": "m,rad"}, "a table has at most 500"),
        ({"theta": [math.inf], "d": [0], "a": [0], "alpha": [0]},
         {"convention": "standard", "units": "m,rad"}, "not a finite number"),
    ],
)  # fmt: skip
def test_a_bad_frame_is_refused(frame, words, says):
    """With the row and the column, and what to give."""
    with pytest.raises(TableFileError, match=says):
        load_table(frame, **words)


def test_other_columns_are_not_guessed_by_from_array():
    """The four parameters only, in metres and radians; other frames have their door."""
    with pytest.raises(TableError, match="load_table"):
        DHTable.from_array(PandasLike({key: [0] for key in [*KEYS, "type"]}), DHConvention.STANDARD)
