"""Rules of URDF files, a module a subject: every public function of one is a rule."""

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from inspect import isfunction
from types import ModuleType

from dh2urdf.checks.columns import column
from dh2urdf.checks.document import Document
from dh2urdf.checks.findings import Finding
from dh2urdf.checks.rounding import rounded_angle
from dh2urdf.checks.rules import geometry, inertia, joints, reading, tree
from dh2urdf.conversions.read import xacro_given

Rule = Callable[[Document], Iterator[Finding]]


def _rules(module: ModuleType) -> dict[str, Rule]:
    """The public functions of a module in its order, ``limit_zero`` as ``limit-zero``."""
    own = {name: f for name, f in vars(module).items() if isfunction(f) and name[0] != "_"}
    return {n.replace("_", "-"): f for n, f in own.items() if f.__module__ == module.__name__}


RULES: dict[str, Rule] = {
    **_rules(tree),
    **_rules(reading),
    "rounded-angle": rounded_angle,
    **_rules(joints),
    **_rules(inertia),
    **_rules(geometry),
}
"""Every rule by its name; its docstring says what holds in a sound file."""


def check_urdf(
    path: str | os.PathLike[str],
    *,
    xacro_args: Mapping[str, object] | None = None,
    packages: Mapping[str, str | os.PathLike[str]] | None = None,
) -> tuple[Finding, ...]:
    """What the consumers of a URDF would break on, by rule, in the order of the file.

    No consumer needs to be installed for it; :func:`dh2urdf.checks.ask_all` asks those that are.

    Parameters
    ----------
    path : path
        Any URDF, or a xacro.
    xacro_args, packages : dict, optional
        Arguments of a xacro, and folders of ROS packages by name.

    Returns
    -------
    tuple of Finding
        Empty for a file that every consumer takes.

    Raises
    ------
    UrdfError
        No such file, not XML, a document type or entities, or no ``<robot>``.

    Examples
    --------
    >>> import os, tempfile
    >>> from dh2urdf import check_urdf, write_urdf
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "rr.urdf")
    ...     check_urdf(write_urdf("planar_rr", path).path)
    ()
    """
    doc = Document.read(path, xacro_given(xacro_args, packages))
    found = [
        replace(item, rule=name, column=column(item, doc.lines))
        for name, rule in RULES.items()
        for item in rule(doc)
    ]
    return tuple(sorted(found, key=lambda finding: finding.line))
