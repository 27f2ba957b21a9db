"""The table of rules, and the check that walks it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Finding
from dh2urdf.checks.report import Found
from dh2urdf.checks.rounding import rounded_angle
from dh2urdf.checks.rules import geometry, inertia, joints, names, numbers, reading, tree

__all__ = ["RULES", "check_urdf"]

RULES: dict[str, Callable[[Document], Iterator[Found]]] = {
    "robot-name": names.robot_name,
    "version": names.version,
    "no-links": tree.no_links,
    "no-name": names.no_name,
    "duplicate-link": names.duplicate_link,
    "duplicate-joint": names.duplicate_joint,
    "joint-named-as-link": names.joint_named_as_link,
    "joint-ends": tree.joint_ends,
    "unknown-child": tree.unknown_child,
    "unknown-parent": tree.unknown_parent,
    "joins-itself": tree.joins_itself,
    "two-parents": tree.two_parents,
    "loop": tree.loop,
    "several-roots": tree.several_roots,
    "joint-type": tree.joint_type,
    "many-degrees": tree.many_degrees,
    "name-characters": names.name_characters,
    "side-frame-first": tree.side_frame_first,
    "repeated-element": reading.repeated_element,
    "fused-frames": reading.fused_frames,
    "xacro": numbers.xacro,
    "number": numbers.number,
    "number-count": numbers.number_count,
    "not-finite": numbers.not_finite,
    "negative-zero": numbers.negative_zero,
    "rounded-angle": rounded_angle,
    "limit-missing": joints.limit_missing,
    "limit-incomplete": joints.limit_incomplete,
    "limit-without-bounds": joints.limit_without_bounds,
    "limit-reversed": joints.limit_reversed,
    "limit-zero": joints.limit_zero,
    "continuous": joints.continuous,
    "axis-missing": joints.axis_missing,
    "axis-zero": joints.axis_zero,
    "axis-not-unit": joints.axis_not_unit,
    "mimic-leader": reading.mimic_leader,
    "mimic": reading.mimic,
    "damping-negative": joints.damping_negative,
    "massless": inertia.massless,
    "massless-part": inertia.massless_part,
    "massless-frame": inertia.massless_frame,
    "mass-negative": inertia.mass_negative,
    "inertial-incomplete": inertia.inertial_incomplete,
    "inertia-zero": inertia.inertia_zero,
    "inertia-not-positive": inertia.inertia_not_positive,
    "inertia-triangle": inertia.inertia_triangle,
    "root-inertia": inertia.root_inertia,
    "geometry-empty": geometry.geometry_empty,
    "geometry-unknown": geometry.geometry_unknown,
    "geometry-size": geometry.geometry_size,
    "mesh-missing": geometry.mesh_missing,
    "mesh-path": geometry.mesh_path,
    "mesh-package": geometry.mesh_package,
    "mesh-format": geometry.mesh_format,
    "mesh-scale": geometry.mesh_scale,
    "mesh-units": geometry.mesh_units,
    "material-undefined": geometry.material_undefined,
    "material-name": geometry.material_name,
    "material-twice": geometry.material_twice,
}
"""Every rule by its name; its docstring says what holds in a sound file."""


def check_urdf(path: str | os.PathLike[str]) -> tuple[Finding, ...]:
    """What the consumers of a URDF would break on, by rule, in the order of the file.

    No consumer needs to be installed for it; :func:`dh2urdf.checks.ask_all` asks those that are.

    Parameters
    ----------
    path : path
        Any URDF.

    Returns
    -------
    tuple of Finding
        Empty for a file that every consumer takes.

    Raises
    ------
    UrdfError
        No such file, not XML, a document type or entities, or no ``<robot>``.
    """
    doc = Document.read(path)
    found = [item.placed(name) for name, rule in RULES.items() for item in rule(doc)]
    return tuple(sorted(found, key=lambda finding: finding.line))
