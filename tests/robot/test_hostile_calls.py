"""Every public entry called from Python with arguments of the wrong kind, one property each."""

import functools
import warnings

import numpy as np
import pytest
from hostile import ANYTHING, SIZES, hostile, outcome
from hypothesis import strategies as st

import dh2urdf
from dh2urdf import DHConvention, JointType, Robot, figures, symbolic, transforms, workspace

ARM = Robot.from_dh("puma560")
SEVEN = Robot.from_dh("franka_fer")
PLANAR = Robot.from_dh("planar_rr")
TABLE = ARM.table
T = ARM.fk(0.3 * ARM.lower + 0.7 * ARM.upper)
T7 = SEVEN.fk(0.4 * SEVEN.lower + 0.6 * SEVEN.upper)
GRID = workspace.section(PLANAR, count=5)

LOCKED = st.one_of(
    ANYTHING,
    st.dictionaries(st.one_of(st.integers(-2, 9), st.text(max_size=3), st.booleans()), ANYTHING),
    st.dictionaries(st.integers(0, 6), st.floats(-3, 3), max_size=3),
)
"""What may be given for the joints to hold."""

FLAGS = {"within_limits": True, "nearest": False}
POSES = {"task": "pose", "locked": LOCKED, **FLAGS}
CELLS = {"theta": 0.0, "d": 0.1, "a": 0.0, "alpha": 0.0}
ROW = {"joint_type": JointType.REVOLUTE, "sign": 1, "name": "a", "lower": -1.0, "upper": 1.0}
ROW |= {"mass": 1.0}
ENDS = {"base": dh2urdf.Origin(), "tool": dh2urdf.Origin(), "source": "", "checked": ""}
MAPPED = {"robot": PLANAR, "grid": GRID, "within_limits": True}
LOOK = {"style": "schematic", "frames": False, "table": False, "view": (10.0, 20.0)}
SECTION = {"plane": "xy", "at": 0.0, "rpy": [0, 0, 0], "orientations": 2, "within_limits": True}
SECTION |= {"progress": None}
STANDING = {"region": [[0, 1], [0, 1]], "height": 0.0, "yaw": 0.0, "mount": [0, 0, 0]}
STANDING |= {"task": "position", "within_limits": True, "progress": None}
ONE = {"joint_types": (JointType.REVOLUTE,), "names": ("a",)}
ONE |= {"lower": np.zeros(1), "upper": np.ones(1)}


def takes(call, **usual):
    """An entry, and what it takes."""
    return call, usual


KINDS = {
    "fk": takes(ARM.fk, q=None),
    "frames": takes(ARM.frames, q=None),
    "jacobian": takes(ARM.jacobian, q=None),
    "model_configuration": takes(ARM.model_configuration, q=None),
    "chain_configuration": takes(ARM.chain_configuration, q=None),
    "random_configuration": takes(ARM.random_configuration, rng=3),
    "ik": takes(ARM.ik, T=T, seed=ARM.lower, turns="all", **POSES),
    "ik of 7": takes(SEVEN.ik, T=T7, seed=SEVEN.lower, samples=4, **POSES),
    "ik_batch": takes(ARM.ik_batch, Ts=[T], threads=2, progress=None, on_bad="skip", **POSES),
    "ik_batch of 7": takes(SEVEN.ik_batch, Ts=[T7], samples=4, **POSES),
    "ik_path": takes(ARM.ik_path, Ts=[T, T], start=ARM.lower, max_jump=0.5, **POSES),
    "ik_numeric": takes(
        ARM.ik_numeric, T=T, seed=ARM.lower, solutions=2, starts=5, rng=0, task="pose", **FLAGS
    ),
    "ik_intervals": takes(SEVEN.ik_intervals, T=T7, **FLAGS),
    "why_unreachable": takes(ARM.why_unreachable, T=T, **POSES),
    "solver_for": takes(ARM.solver_for, task="pose", locked=LOCKED),
    "solutions.nearest": takes(ARM.ik(T).nearest, q=ARM.lower),
    "solutions.sorted_by": takes(ARM.ik(T).sorted_by, q=ARM.lower),
    "numeric.nearest": takes(ARM.ik_numeric(T).nearest, q=ARM.lower),
    "Robot": takes(Robot, model=ARM.model, base="base_link", tip="tool0"),
    "Robot.from_dh": takes(Robot.from_dh, table=TABLE),
    "Robot.from_urdf": takes(Robot.from_urdf, path="nowhere.urdf", base=None, tip=None),
    "check_pose": takes(transforms.check_pose, T=T),
    "nearest_rotation": takes(transforms.nearest_rotation, T=T),
    "inverse": takes(transforms.inverse, T=T),
    "matrix_to_rpy": takes(transforms.matrix_to_rpy, R=T),
    "matrix_to_zyz": takes(transforms.matrix_to_zyz, R=T),
    "rotation_angle": takes(transforms.rotation_angle, R=T),
    "pose_error": takes(transforms.pose_error, T=T, T_ref=T),
    "quaternion_to_matrix": takes(transforms.quaternion_to_matrix, q=[0, 0, 0, 1.0]),
    "origin_matrix": takes(transforms.origin_matrix, xyz=[0, 0, 0], rpy=[0, 0, 0]),
    "rpy_to_matrix": takes(transforms.rpy_to_matrix, rpy=[0, 0, 0]),
    "zyz_to_matrix": takes(transforms.zyz_to_matrix, phi=0, theta=0, psi=0),
    "rotation": takes(transforms.rotation, axis=[0, 0, 1.0], angle=0.1),
    "rot_x": takes(transforms.rot_x, angle=0.1),
    "rot_y": takes(transforms.rot_y, angle=0.1),
    "rot_z": takes(transforms.rot_z, angle=0.1),
    "trans": takes(transforms.trans, x=0.0, y=0.0, z=0.0),
    "planar_rotation": takes(transforms.planar_rotation, theta=0.1),
    "planar_translation": takes(transforms.planar_translation, x=0.1, y=0.2),
    "planar_reach": takes(dh2urdf.planar_reach, l1=1.0, l2=0.5),
    "planar_rr_ik": takes(dh2urdf.planar_rr_ik, l1=1.0, l2=0.5, x=0.6, y=0.7),
    "planar_rrr_ik": takes(dh2urdf.planar_rrr_ik, l1=1.0, l2=0.5, l3=0.2, x=0.6, y=0.7, phi=0.1),
    "wrist_centre": takes(dh2urdf.wrist_centre, T=T, d6=0.1),
    "dh_factors": takes(dh2urdf.dh_factors, **CELLS),
    "dh_transform": takes(dh2urdf.dh_transform, **CELLS, convention="standard"),
    "dh_parameters": takes(dh2urdf.dh_parameters, T=np.eye(4), convention="standard", i=1),
    "to_convention": takes(dh2urdf.to_convention, table=TABLE, convention="modified"),
    "urdf_text": takes(dh2urdf.urdf_text, table=TABLE, options=None),
    "write_urdf": takes(dh2urdf.write_urdf, table=TABLE, path="/proc/nowhere.urdf"),
    "write_mjcf": takes(dh2urdf.write_mjcf, table=TABLE, path="/proc/nowhere.xml"),
    "save_table": takes(dh2urdf.save_table, table=TABLE, path="/proc/nowhere.yaml"),
    "load_table": takes(dh2urdf.load_table, path="puma560"),
    "extract_dh": takes(
        dh2urdf.extract_dh, source="nowhere.urdf", base=None, tip=None, convention="standard"
    ),
    "check_urdf": takes(dh2urdf.check_urdf, path="nowhere.urdf"),
    "DHRow": takes(dh2urdf.DHRow, **CELLS, **ROW, com=(0, 0, 0), inertia=None, origin=None),
    "DHTable": takes(
        dh2urdf.DHTable, rows=TABLE.rows, **ENDS, convention=DHConvention.STANDARD, name="a"
    ),
    "DHTable.fk": takes(TABLE.fk, q=ARM.lower),
    "DHTable.frames": takes(TABLE.frames, q=ARM.lower),
    "DHTable.transforms": takes(TABLE.transforms, q=ARM.lower),
    "Origin": takes(dh2urdf.Origin, xyz=(0, 0, 0), rpy=(0, 0, 0)),
    "UrdfOptions": takes(dh2urdf.UrdfOptions, digits=3, embed_table=True),
    "SerialChain": takes(dh2urdf.SerialChain, links=np.stack([np.eye(4)] * 2), **ONE),
    "symbolic_transforms": takes(symbolic.symbolic_transforms, table=TABLE),
    "symbolic_product": takes(symbolic.symbolic_product, table=PLANAR.table),
    "section": takes(workspace.section, robot=ARM, plane="xz", at=0.0, count=9),
    "branch_counts": takes(workspace.branch_counts, **MAPPED, R=np.eye(3), progress=None),
    "dexterity": takes(workspace.dexterity, **MAPPED, count=3, held=None),
    "held_values": takes(workspace.held_values, robot=SEVEN, count=3, within_limits=True),
    "planar_arm": takes(workspace.planar_arm, robot=PLANAR),
    "reach_ball": takes(workspace.reach_ball, robot=ARM),
    "task_of": takes(workspace.task_of, robot=ARM),
    "common_axis": takes(workspace.common_axis, robot=ARM),
    "exact_section_figure": takes(
        figures.exact_section_figure, robot=ARM, section=None, reach=None, volume=None
    ),
    "placement_figure": takes(figures.placement_figure, Ts=[T], placed=[]),
    "figure": takes(figures.figure, robot=PLANAR, q=[0.1, 0.2], **LOOK, ghosts=(), ghost_names=()),
    "workspace_figure": takes(figures.workspace_figure, robot=PLANAR, **SECTION, points=5),
    "Robot.figure": takes(PLANAR.figure, q=None, style="schematic", view=None),
    "base_map": takes(workspace.base_map, robot=PLANAR, Ts=[np.eye(4)], **STANDING),
    "extreme_reach": takes(workspace.extreme_reach, robot=PLANAR, point="tip", within_limits=True),
    "uniform_rotations": takes(workspace.uniform_rotations, count=5),
}
"""Each entry, and arguments that it takes: one of them at a time is replaced by anything."""


@functools.cache
def properties():
    """One property for each entry."""

    def of(call, usual):
        own = {key: value for key, value in usual.items() if isinstance(value, st.SearchStrategy)}
        plain = {key: None if key in own else value for key, value in usual.items()}

        @hostile(bad=st.one_of(*(st.tuples(st.just(k), own.get(k, ANYTHING)) for k in usual)))
        def check(bad):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                outcome(call, **{**plain, bad[0]: bad[1]})

        return check

    return {name: of(*entry) for name, entry in KINDS.items()}


@pytest.mark.parametrize("inputs", SIZES)
@pytest.mark.parametrize("entry", KINDS)
def test_an_entry_answers_or_refuses_in_the_words_of_the_package(
    entry, inputs, tmp_path, monkeypatch
):
    """No foreign exception, no warning, nothing slow, whatever one of the arguments is."""
    monkeypatch.chdir(tmp_path)
    properties()[entry](inputs)
