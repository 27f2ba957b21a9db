"""``dh2urdf workspace --exact``: reach as numbers, without a grid."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from dh2urdf.cli.output import emit, emit_json
from dh2urdf.cli.progress import note
from dh2urdf.exceptions import ArgumentError
from dh2urdf.grids import number

if TYPE_CHECKING:
    from dh2urdf.robot import Robot
    from dh2urdf.workspace import ExtremeReach, ReachSection, Volume

DIGITS = 9
"""Digits after the point [m]."""


def tell_exact_reach(
    arm: Robot, output: Path | None, *, limits: bool, dpi: float, force: bool, json: bool
) -> None:
    """Extremes of tip and wrist point, section and volume; a picture of the section where asked."""
    from dh2urdf.workspace import extreme_reach, reach_section, reach_volume

    tip = extreme_reach(arm, within_limits=limits)
    section = wrist = volume = None
    lacking = ""
    try:
        section = reach_section(arm, within_limits=limits)
        wrist = extreme_reach(arm, "wrist", within_limits=limits)
        volume = reach_volume(arm, section)
    except ArgumentError as reason:
        lacking = str(reason)
    if lacking and output is not None:
        raise ArgumentError(
            f"no section to draw in {output}: {lacking}; without --output the reach of its tip is "
            "told"
        )
    if output is not None and section and wrist and volume:
        from dh2urdf.figures import exact_section_figure, save_picture

        picture = exact_section_figure(arm, section, wrist, volume)
        save_picture(picture, output, dpi=dpi, force=force)
    if json:
        reach = {"tip": _reach_data(tip), "wrist": _reach_data(wrist)}
        emit_json("workspace", path=output, within_limits=limits, reach=reach,
                  section=_section_data(section), volume=_volume_data(volume))  # fmt: skip
    else:
        turns = not arm.chain.prismatic[0]
        emit("\n".join([*_lines(tip, wrist, section, volume, turns), *_named(output)]))
    if lacking:
        note(f"no section: {lacking}")


def _named(path: Path | None) -> list[str]:
    """The picture's name, where there is one."""
    return [] if path is None else [str(path)]


def _lines(
    tip: ExtremeReach,
    wrist: ExtremeReach | None,
    section: ReachSection | None,
    volume: Volume | None,
    turns: bool,
) -> list[str]:
    """A line for each fact; joint 1 turns about axis 1, or slides along it."""
    shoulder = ", ".join(_shown(v) for v in tip.centre.tolist())
    lines = [f"shoulder at {shoulder} m in the base"]
    for reach in (tip, wrist):
        if reach is None or (reach is wrist and reach.point == "tip"):
            continue
        facts = [("from the shoulder", reach.distance)]
        facts += [("from axis 1", reach.radius)] if turns else []
        if reach.above is None:
            facts.append(("along axis 1 from the shoulder", reach.height))
        else:
            facts.append(("above the shoulder", reach.above))
        for what, ends in facts:
            lines.append(f"{reach.point}: {_shown(ends[0])} to {_shown(ends[1])} m {what}")
    if section is not None and volume is not None:
        outlines, voids = len(section.rings) - len(section.voids), len(section.voids)
        kinds = sorted({kind for ring in section.rings for kind in ring.kinds} - {"axis"})
        kinds = ["folds" if kind == "fold" else kind for kind in kinds]
        counts = f"outlines: {outlines}, voids: {voids}, bounded by {', '.join(kinds)}"
        lines.append(f"section of the {section.point}: {section.area:.6g} m^2, {counts}")
        lines.append(f"volume of the {section.point}: {volume.value:.6g} m^3, "
                     f"off by {volume.bound:.1g} m^3 at most")  # fmt: skip
    return lines


def _shown(value: float) -> str:
    return number(round(value, DIGITS) + 0.0)


def _reach_data(reach: ExtremeReach | None) -> dict[str, Any] | None:
    names = ("point", "centre", "axis", "distance", "radius", "height", "q", "places")
    return None if reach is None else {name: getattr(reach, name) for name in names}


def _section_data(section: ReachSection | None) -> dict[str, Any] | None:
    if section is None:
        return None
    rings = [{"points": ring.through, "kinds": ring.kinds, "area": ring.area}
             for ring in section.rings]  # fmt: skip
    frame = {"point": section.point, "T_base_axis": section.T_base_axis}
    return {**frame, "area": section.area, "rings": rings}


def _volume_data(volume: Volume | None) -> dict[str, float] | None:
    return None if volume is None else {"value": volume.value, "bound": volume.bound}
