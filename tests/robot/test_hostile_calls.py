"""Every public entry called from Python with arguments of the wrong kind, one property each."""

import functools
import warnings

import numpy as np
import pytest
from hostile import ANYTHING, hostile, outcome
from hypothesis import strategies as st

import dh2urdf
from dh2urdf import (
    DHConvention,
    JointType,
    Robot,
    figures,
    planar_reach,
    symbolic,
    transforms,
    workspace,
)

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

POSES = {"task": "pose", "within_limits": True, "locked": LOCKED, "nearest": False}

KINDS = {
    "fk": (ARM.fk, {"q": None}),
    "frames": (ARM.frames, {"q": None}),
    "jacobian": (ARM.jacobian, {"q": None}),
    "model_configuration": (ARM.model_configuration, {"q": None}),
    "chain_configuration": (ARM.chain_configuration, {"q": None}),
    "random_configuration": (ARM.random_configuration, {"rng": 3}),
    "ik": (ARM.ik, {"T": T, "seed": ARM.lower, "turns": "all", **POSES}),
    "ik of 7": (SEVEN.ik, {"T": T7, "seed": SEVEN.lower, "samples": 4, **POSES}),
    "ik_batch": (
        ARM.ik_batch,
        {"Ts": [T], "threads": 2, "progress": None, "on_bad": "skip", **POSES},
    ),
    "ik_batch of 7": (SEVEN.ik_batch, {"Ts": [T7], "samples": 4, **POSES}),
    "ik_path": (ARM.ik_path, {"Ts": [T, T], "start": ARM.lower, "max_jump": 0.5, **POSES}),
    "ik_numeric": (
        ARM.ik_numeric,
        {"T": T, "seed": ARM.lower, "solutions": 2, "starts": 5, "rng": 0, "task": "pose"}
        | {"within_limits": True, "nearest": False},
    ),
    "ik_intervals": (SEVEN.ik_intervals, {"T": T7, "within_limits": True, "nearest": False}),
    "why_unreachable": (ARM.why_unreachable, {"T": T, **POSES}),
    "solver_for": (ARM.solver_for, {"task": "pose", "locked": LOCKED}),
    "solutions.nearest": (ARM.ik(T).nearest, {"q": ARM.lower}),
    "solutions.sorted_by": (ARM.ik(T).sorted_by, {"q": ARM.lower}),
    "numeric.nearest": (ARM.ik_numeric(T).nearest, {"q": ARM.lower}),
    "Robot": (Robot, {"model": ARM.model, "base": "base_link", "tip": "tool0"}),
    "Robot.from_dh": (Robot.from_dh, {"table": TABLE}),
    "Robot.from_urdf": (Robot.from_urdf, {"path": "nowhere.urdf", "base": None, "tip": None}),
    "check_pose": (transforms.check_pose, {"T": T}),
    "nearest_rotation": (transforms.nearest_rotation, {"T": T}),
    "inverse": (transforms.inverse, {"T": T}),
    "matrix_to_rpy": (transforms.matrix_to_rpy, {"R": T}),
    "matrix_to_zyz": (transforms.matrix_to_zyz, {"R": T}),
    "rotation_angle": (transforms.rotation_angle, {"R": T}),
    "pose_error": (transforms.pose_error, {"T": T, "T_ref": T}),
    "quaternion_to_matrix": (transforms.quaternion_to_matrix, {"q": [0, 0, 0, 1.0]}),
    "origin_matrix": (transforms.origin_matrix, {"xyz": [0, 0, 0], "rpy": [0, 0, 0]}),
    "rpy_to_matrix": (transforms.rpy_to_matrix, {"rpy": [0, 0, 0]}),
    "zyz_to_matrix": (transforms.zyz_to_matrix, {"phi": 0, "theta": 0, "psi": 0}),
    "rotation": (transforms.rotation, {"axis": [0, 0, 1.0], "angle": 0.1}),
    "rot_x": (transforms.rot_x, {"angle": 0.1}),
    "rot_y": (transforms.rot_y, {"angle": 0.1}),
    "rot_z": (transforms.rot_z, {"angle": 0.1}),
    "trans": (transforms.trans, {"x": 0.0, "y": 0.0, "z": 0.0}),
    "planar_rotation": (transforms.planar_rotation, {"theta": 0.1}),
    "planar_translation": (transforms.planar_translation, {"x": 0.1, "y": 0.2}),
    "planar_reach": (planar_reach, {"l1": 1.0, "l2": 0.5}),
    "planar_rr_ik": (dh2urdf.planar_rr_ik, {"l1": 1.0, "l2": 0.5, "x": 0.6, "y": 0.7}),
    "planar_rrr_ik": (
        dh2urdf.planar_rrr_ik,
        {"l1": 1.0, "l2": 0.5, "l3": 0.2, "x": 0.6, "y": 0.7, "phi": 0.1},
    ),
    "wrist_centre": (dh2urdf.wrist_centre, {"T": T, "d6": 0.1}),
    "dh_factors": (dh2urdf.dh_factors, {"theta": 0.1, "d": 0.0, "a": 0.0, "alpha": 0.0}),
    "dh_transform": (
        dh2urdf.dh_transform,
        {"theta": 0.1, "d": 0.0, "a": 0.0, "alpha": 0.0, "convention": "standard"},
    ),
    "dh_parameters": (dh2urdf.dh_parameters, {"T": np.eye(4), "convention": "standard", "i": 1}),
    "to_convention": (dh2urdf.to_convention, {"table": TABLE, "convention": "modified"}),
    "urdf_text": (dh2urdf.urdf_text, {"table": TABLE, "options": None}),
    "write_urdf": (dh2urdf.write_urdf, {"table": TABLE, "path": "/proc/nowhere.urdf"}),
    "save_table": (dh2urdf.save_table, {"table": TABLE, "path": "/proc/nowhere.yaml"}),
    "load_table": (dh2urdf.load_table, {"path": "puma560"}),
    "extract_dh": (
        dh2urdf.extract_dh,
        {"source": "nowhere.urdf", "base": None, "tip": None, "convention": "standard"},
    ),
    "check_urdf": (dh2urdf.check_urdf, {"path": "nowhere.urdf"}),
    "DHRow": (
        dh2urdf.DHRow,
        {"theta": 0.0, "d": 0.1, "a": 0.0, "alpha": 0.0, "joint_type": JointType.REVOLUTE}
        | {"sign": 1, "name": "a", "lower": -1.0, "upper": 1.0, "mass": 1.0, "com": (0, 0, 0)}
        | {"inertia": None, "origin": None},
    ),
    "DHTable": (
        dh2urdf.DHTable,
        {"rows": TABLE.rows, "convention": DHConvention.STANDARD, "name": "a"}
        | {"base": dh2urdf.Origin(), "tool": dh2urdf.Origin(), "source": "", "checked": ""},
    ),
    "DHTable.fk": (TABLE.fk, {"q": ARM.lower}),
    "DHTable.frames": (TABLE.frames, {"q": ARM.lower}),
    "DHTable.transforms": (TABLE.transforms, {"q": ARM.lower}),
    "Origin": (dh2urdf.Origin, {"xyz": (0, 0, 0), "rpy": (0, 0, 0)}),
    "UrdfOptions": (dh2urdf.UrdfOptions, {"digits": 3, "embed_table": True}),
    "SerialChain": (
        dh2urdf.SerialChain,
        {"links": np.stack([np.eye(4)] * 2), "joint_types": (JointType.REVOLUTE,)}
        | {"names": ("a",), "lower": np.zeros(1), "upper": np.ones(1)},
    ),
    "symbolic_transforms": (symbolic.symbolic_transforms, {"table": TABLE}),
    "symbolic_product": (symbolic.symbolic_product, {"table": PLANAR.table}),
    "section": (workspace.section, {"robot": ARM, "plane": "xz", "at": 0.0, "count": 9}),
    "branch_counts": (
        workspace.branch_counts,
        {"robot": PLANAR, "grid": GRID, "R": np.eye(3), "within_limits": True, "progress": None},
    ),
    "dexterity": (
        workspace.dexterity,
        {"robot": PLANAR, "grid": GRID, "count": 3, "within_limits": True, "held": None},
    ),
    "held_values": (workspace.held_values, {"robot": SEVEN, "count": 3, "within_limits": True}),
    "planar_arm": (workspace.planar_arm, {"robot": PLANAR}),
    "reach_ball": (workspace.reach_ball, {"robot": ARM}),
    "task_of": (workspace.task_of, {"robot": ARM}),
    "common_axis": (workspace.common_axis, {"robot": ARM}),
    "figure": (
        figures.figure,
        {"robot": PLANAR, "q": [0.1, 0.2], "style": "schematic", "ghosts": (), "ghost_names": ()}
        | {"frames": False, "table": False, "view": (10.0, 20.0)},
    ),
    "workspace_figure": (
        figures.workspace_figure,
        {"robot": PLANAR, "plane": "xy", "at": 0.0, "rpy": [0, 0, 0], "points": 5}
        | {"orientations": 2, "within_limits": True, "progress": None},
    ),
    "Robot.figure": (PLANAR.figure, {"q": None, "style": "schematic", "view": None}),
    "uniform_rotations": (workspace.uniform_rotations, {"count": 5}),
}
"""Each entry, and arguments that it takes: one of them at a time is replaced by anything."""


@functools.cache
def properties():
    """One property for each entry."""

    def of(call, usual):
        replaced = {
            key: value if isinstance(value, st.SearchStrategy) else ANYTHING
            for key, value in usual.items()
        }
        plain = {
            key: None if isinstance(value, st.SearchStrategy) else value
            for key, value in usual.items()
        }

        @hostile(bad=st.one_of(*(st.tuples(st.just(k), s) for k, s in replaced.items())))
        def check(bad):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                given = {**plain, bad[0]: bad[1]}
                try:
                    outcome(call, **given)
                except AssertionError:  # kernels compile, once per installation
                    outcome(call, **given)

        return check

    return {name: of(*entry) for name, entry in KINDS.items()}


@pytest.mark.parametrize("inputs", [300, pytest.param(10_000, marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize("entry", KINDS)
def test_an_entry_answers_or_refuses_in_the_words_of_the_package(
    entry, inputs, tmp_path, monkeypatch
):
    """No foreign exception, no warning, nothing slow, whatever one of the arguments is."""
    monkeypatch.chdir(tmp_path)
    properties()[entry](inputs)
