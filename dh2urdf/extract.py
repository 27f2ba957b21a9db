"""From a robot description back to its DH table: the entry point."""

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from dh2urdf.conversions.assign import (
    Change,
    FrameStep,
    XRule,
    chain_to_dh,
    explain_frames,
    flip_signs,
    near_misses,
    references,
    snap_chain,
    snap_table,
    snap_tolerance,
)
from dh2urdf.dh import DHConvention, DHTable, JointType
from dh2urdf.dh.motions import convention_of
from dh2urdf.dh_io.files import shown
from dh2urdf.exceptions import VerificationError
from dh2urdf.transforms import pose_error

SIGNATURE = "extracted by dh2urdf"
"""Begins the source of every extracted table; a file that says so may be written over."""

CONFIGURATIONS = 64
"""Configurations at which a table is compared with its source."""

LARGEST_ERROR = 1e-9
"""Largest difference [rad, and m per m of arm] of an extraction that changed nothing."""


@dataclass(frozen=True)
class Extraction:
    """A table found by frame assignment, and the proof that it is the same arm.

    Parameters
    ----------
    table : DHTable
        q of the source is q of the table.
    base, tip : str
        The two frames that the table spans.
    max_error : float
        Largest difference [m and rad] between the table's FK and Pinocchio's FK of the source,
        over ``configurations`` configurations; what snapping cost is in it.
    steps : tuple of FrameStep
        The frames explained, 0 to n.
    changes : tuple of Change
        What snapping set right, each with its measured cost.
    warnings : tuple of str
    """

    table: DHTable
    base: str
    tip: str
    max_error: float
    configurations: int
    steps: tuple[FrameStep, ...] = field(repr=False)
    changes: tuple[Change, ...] = ()
    warnings: tuple[str, ...] = ()

    def explain(self) -> str:
        """The assignment like a worked solution, a paragraph a frame, then the table."""
        head = (
            f"DH frames of {self.table.name} from {shown(self.base)} to {shown(self.tip)}, "
            f"{self.table.convention} convention."
        )
        steps = list(map(str, self.steps)) or [
            "The file carries the table that it was written from; embedded=False assigns frames."
        ]
        return "\n\n".join([head, *steps, str(self)])

    def __str__(self) -> str:
        lines = [str(self.table)]
        lines += [f"set right: {change}" for change in self.changes]
        largest = _largest(self.max_error, self.configurations)
        lines.append(f"{shown(self.base)} to {shown(self.tip)}: {largest} (Pinocchio)")
        return "\n".join(lines)


def extract_dh(
    source: Any,
    base: str | None = None,
    tip: str | None = None,
    convention: DHConvention | str | None = DHConvention.STANDARD,
    snap: float | bool | None = None,
    *,
    x_axis: XRule | str = XRule.AUTO,
    compact: bool = True,
    flip: Sequence[str] = (),
    embedded: bool = True,
    joint_types: str | Sequence[JointType | str] | None = None,
    tool: Any = None,
    names: Sequence[str] | None = None,
    xacro_args: Mapping[str, object] | None = None,
    packages: Mapping[str, str | os.PathLike[str]] | None = None,
    model: str | None = None,
) -> Extraction:
    """The DH table of a chain, by the frame assignment of lecture notes section 4.

    Parameters
    ----------
    source : path, pinocchio.Model, SerialChain or array_like
        A URDF, xacro or MJCF file (the last two with their extras), the text of a URDF, a model,
        or joint axes typed by hand: (n, 6) screw axes, (n, 2, 3) directions and points, (n, 4, 4)
        joint frames, all in base at q = 0, or a YAML or JSON file of them.
    base, tip : str, optional
        Links anywhere in the tree. Without them the root and the end of the longest chain.
    convention : DHConvention
        None for that of the table that a file carries, standard where it carries none.
    snap : float or True, optional
        Set angles [rad] and lengths [m] right that miss a multiple of 15 degrees or zero by no
        more than this; True for 2e-5. Nothing is changed without it.
    x_axis : {"auto", "away"}
        ``away`` keeps every x pointing away from the axis before it (a >= 0), as the notes do;
        ``auto`` turns it round where that spares theta a half turn, as data sheets do.
    compact : bool
        Give axes that are nearly parallel a fixed step in place of a common normal that lies
        far outside the arm.
    flip : sequence of str
        Joints whose z is to point against their positive direction; their rows get sign -1.
    embedded : bool
        Return the table that a URDF of this package carries, where it still fits its joints and
        is in the convention asked for; there are no steps then.
    joint_types, tool, names
        For typed axes only: ``"RRPR"``, ``T_base_tool`` at q = 0, joint names.
    xacro_args, packages : dict, optional
        Arguments of a xacro, and folders of ROS packages by name.
    model : str, optional
        The UR that a ``calibration.conf`` belongs to, as ``"ur5e"``.

    Returns
    -------
    Extraction

    Raises
    ------
    UrdfError, NameNotFoundError
        The source cannot be read, or has no such chain.
    VerificationError
        The table differs from the source by more than rounding (only with ``compact=False``,
        where a common normal is too far away for sixteen digits).

    Examples
    --------
    >>> from dh2urdf import extract_dh, urdf_text
    >>> found = extract_dh(urdf_text("planar_rr"), embedded=False)
    >>> [round(row.a, 9) for row in found.table.rows], found.max_error < 1e-9
    ([1.0, 0.7], True)
    """
    from dh2urdf.conversions.chains import (
        carry,
        configurations,
        following,
        following_alike,
        read_source,
        table_poses,
    )
    from dh2urdf.conversions.read import xacro_given

    wanted = None if convention is None else convention_of(convention)
    tolerance = snap_tolerance(snap)
    xacro = xacro_given(xacro_args, packages)
    typed: dict[str, Any] = {"joint_types": joint_types, "tool": tool, "names": names}
    given = read_source(source, base, tip, xacro, model, **typed)
    found, chain = given.found, given.found.chain
    size = references(chain.links).size
    qs = configurations(chain, CONFIGURATIONS, size)
    truth = given.referee(qs)
    allowed = LARGEST_ERROR * max(1.0, size)
    warnings = list(found.warnings)
    written = given.embedded if embedded and tolerance == 0 and not flip else None
    if written is not None and wanted in (None, written.convention):
        fits = written.n == chain.n
        error = pose_error(table_poses(written, qs), truth) if fits else math.inf
        follow = fits and following_alike(written, found.mimics)
        if error <= allowed and follow:
            return Extraction(written, found.base, found.tip, error, len(qs), ())
        warnings.append(_assigned_anew(written, error, follow))
    convention = wanted or DHConvention.STANDARD
    signs = flip_signs(chain, flip)
    changes: list[Change] = []
    if tolerance > 0:
        chain, changes = snap_chain(chain, tolerance, qs)
    assigned = chain_to_dh(
        chain, convention, name=found.name, x_rule=x_axis, compact=compact, signs=signs
    )
    if tolerance > 0:
        table, rounded = snap_table(assigned.table, tolerance, qs)
        changes += rounded
        assigned = replace(assigned, table=table)
    else:
        warnings += near_misses(assigned, chain, qs)
    assigned = replace(assigned, table=following(assigned.table, found.mimics))
    table = carry(assigned.table, found)
    error = pose_error(table_poses(table, qs), truth)
    if tolerance == 0 and not error <= allowed:
        raise VerificationError(_refusal(found.name, error, allowed, compact))
    origin = f"{SIGNATURE} from {found.origin}, {found.base} to {found.tip}"
    checked = f"against Pinocchio, {_largest(error, len(qs))}"
    table = replace(table, source=origin, checked=checked)
    steps, ends = explain_frames(assigned, chain), (found.base, found.tip)
    return Extraction(table, *ends, error, len(qs), steps, tuple(changes), tuple(warnings))


def _assigned_anew(written: DHTable, error: float, follow: bool) -> str:
    """Why a table that a file carries is not taken."""
    differs = f"differs from its joints by {error:.2g}" if follow else "has joints follow otherwise"
    misfit = f"has {written.n} joints" if error == math.inf else differs
    return f"the table that the file carries {misfit}; frames are assigned anew"


def _refusal(name: str, error: float, allowed: float, compact: bool) -> str:
    """Why a table that was found is not given."""
    hint = "" if compact else "; leave compact on, or snap"
    return (
        f"{name}: the table differs from Pinocchio's reading of the source by {error:.3g} "
        f"(allowed {allowed:.1g}){hint}"
    )


def _largest(error: float, count: int) -> str:
    return f"largest FK difference {error:.2g} m or rad over {count} configurations"
