"""Pinocchio's model of a table, made without a file, against the one read from the URDF."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

import dh2urdf
from dh2urdf.exceptions import TableError, VerificationError
from dh2urdf.robot import robot as module

OUT_OF_ORDER = ("z", "aa", "dh_1", "uu", "Z", "xtool")
"""Names that Pinocchio sorts before and behind those of the fixed joints."""


def awkward():
    """A UR5 with names of all kinds, losses and joints that turn the other way."""
    table = dh2urdf.load_table("ur5")
    rows = [
        replace(row, name=name, damping=0.1 * k, friction=float(k), sign=1 - 2 * (k % 2))
        for k, (row, name) in enumerate(zip(table.rows, OUT_OF_ORDER, strict=True))
    ]
    return replace(table, rows=tuple(rows))


def fields(model):
    """All arrays of numbers that a model has."""
    found = {key: getattr(model, key) for key in dir(model)}
    return {key: value for key, value in found.items() if isinstance(value, np.ndarray)}


@pytest.mark.parametrize("name", [*dh2urdf.list_tables(), "awkward"])
def test_the_model_of_a_table_is_the_one_that_pinocchio_reads_from_its_urdf(name):
    """Joints, frames in their order, limits, losses and masses are the same, places to 1e-15."""
    table = awkward() if name == "awkward" else dh2urdf.load_table(name)
    model, read = (
        dh2urdf.Robot.from_dh(table).model,
        pin.buildModelFromXML(dh2urdf.urdf_text(table)),
    )
    assert list(model.names) == list(read.names)
    assert list(model.parents) == list(read.parents)
    for joint, other in zip(model.joints, read.joints, strict=True):
        assert joint.shortname() == other.shortname()
    for frame, other in zip(model.frames, read.frames, strict=True):
        assert (frame.name, frame.type) == (other.name, other.type)
        assert (frame.parentJoint, frame.parentFrame) == (other.parentJoint, other.parentFrame)
        assert frame.placement.isApprox(other.placement, 1e-15)
        assert frame.inertia.isApprox(other.inertia, 1e-14)
    for place, other in zip(model.jointPlacements, read.jointPlacements, strict=True):
        assert place.isApprox(other, 1e-15)
    for body, other in zip(model.inertias, read.inertias, strict=True):
        assert body.isApprox(other, 1e-14)
    for key, values in fields(read).items():
        assert np.array_equal(values, fields(model)[key]), key


def test_what_gravity_asks_of_the_joints_is_that_of_the_urdf():
    """Masses that are added when the model is first asked for count in its dynamics."""
    table = dh2urdf.load_table("ur5")
    model, q = dh2urdf.Robot.from_dh(table).model, np.linspace(-1.0, 1.0, 6)
    read = pin.buildModelFromXML(dh2urdf.urdf_text(table))
    torques = [pin.computeGeneralizedGravity(m, m.createData(), q) for m in (model, read)]
    assert np.allclose(*torques, rtol=1e-12, atol=1e-12)
    assert np.abs(torques[0]).max() > 1.0


def test_a_name_that_a_urdf_cannot_have_is_refused():
    """The robot of a table has a URDF."""
    table = dh2urdf.load_table("ur5")
    first, *others = table.rows
    with pytest.raises(TableError, match="is taken by another joint of the file"):
        dh2urdf.Robot.from_dh(replace(table, rows=(replace(first, name="dh_2_fixed"), *others)))


@pytest.mark.parametrize("off", [1e-9, np.nan])
def test_a_model_that_is_not_the_chain_is_no_robot(monkeypatch, off):
    """A joint that stands a nanometre elsewhere in Pinocchio's model is found out."""

    def displaced(table, frames):
        model = made(table, frames)
        model.jointPlacements[3].translation += np.array([0.0, off, 0.0])
        return model

    made = module.table_model
    monkeypatch.setattr(module, "table_model", displaced)
    with pytest.raises(VerificationError, match="from base_link to tool0 differs from Pinocchio"):
        dh2urdf.Robot.from_dh("ur5")
