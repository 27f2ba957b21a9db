"""A robot like another one, of a table that differs little."""

from dataclasses import replace

import numpy as np
import pytest

import dh2urdf
from dh2urdf import Robot


def moved(table, rng, size):
    """The table with all lengths and angles off by a little."""
    off = iter(rng.normal(0.0, size, (len(table.rows), 4)).tolist())
    keys = ("theta", "d", "a", "alpha")
    changes = (dict(zip(keys, next(off), strict=True)) for _ in table.rows)
    rows = (
        replace(row, **{key: getattr(row, key) + by for key, by in change.items()})
        for row, change in zip(table.rows, changes, strict=True)
    )
    return replace(table, rows=tuple(rows))


@pytest.mark.parametrize("name", ["puma560", "ur5", "franka_fer", "planar_rr"])
@pytest.mark.parametrize("size", [0.0, 1e-4])
def test_it_is_the_robot_of_that_table(name, size):
    """Kinematics and solutions are those of a robot made from the table, and the model, too."""
    rng, first = np.random.default_rng(0), Robot.from_dh(name)
    table = moved(first.table, rng, size)
    other, direct = first.with_table(table), Robot.from_dh(table)
    q = rng.uniform(-1.0, 1.0, (20, first.n))
    np.testing.assert_array_equal(other.fk(q), direct.fk(q))
    assert str(other.solver) == str(direct.solver)
    T = direct.fk(np.clip(0.3, direct.lower, direct.upper))
    np.testing.assert_array_equal(other.ik(T).q, direct.ik(T).q)
    assert other.model == direct.model
    assert first.table == dh2urdf.load_table(name)


def test_a_longer_link_keeps_the_solver():
    """A length that differs is no reason for another family."""
    first = Robot.from_dh("ur5e")
    rows = tuple(replace(row, d=row.d + 1e-4, a=row.a * 1.001) for row in first.table.rows)
    assert str(first.with_table(replace(first.table, rows=rows)).solver) == str(first.solver)


def test_other_joints_are_refused():
    """The message has the joints that were found and those that are allowed."""
    with pytest.raises(dh2urdf.exceptions.ArgumentError, match=r"joint_2 \(revolute\); those of"):
        Robot.from_dh("puma560").with_table("planar_rr")


def test_joints_that_follow_others_are_other_joints():
    """A joint that moves by itself in one table and follows in the other is no small difference."""
    first = dh2urdf.load_table("planar_rrr")
    *others, last = first.rows
    follows = replace(last, mimic=dh2urdf.Mimic(others[-1].name or "joint_2", -1.0))
    with pytest.raises(dh2urdf.exceptions.ArgumentError, match=r"q is .*that of this robot is"):
        Robot.from_dh(first).with_table(replace(first, rows=(*others, follows)))
