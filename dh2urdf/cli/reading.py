"""Options by which files are read that leave something to be told, and tables are written."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from dh2urdf.dh import DHTable
from dh2urdf.dh_io import Told, Units, told, usual_units
from dh2urdf.doors import found
from dh2urdf.exceptions import ArgumentError


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class Description:
    """How a robot description is read."""

    xacro_arg: Annotated[tuple[str, ...], Parameter(show_default=False)] = ()
    """Argument of a xacro, name:=value; repeat for several."""

    package: Annotated[tuple[str, ...], Parameter(show_default=False)] = ()
    """Folder of a ROS package, name=DIR; others by ROS_PACKAGE_PATH and beside the file."""

    @property
    def given(self) -> dict[str, Any]:
        """Arguments and packages, as `Robot.from_urdf` takes them."""
        return {
            "xacro_args": _named(self.xacro_arg, ":=", "--xacro-arg"),
            "packages": _named(self.package, "=", "--package"),
        }


def _named(options: Iterable[str], sign: str, what: str) -> dict[str, str]:
    """Names and values of an option that is given again and again."""
    out: dict[str, str] = {}
    for option in options:
        name, found_sign, value = option.partition(sign)
        if not found_sign or not name:
            raise ArgumentError(f"{what}: expected NAME{sign}VALUE, got {found(option)}")
        if name in out:
            raise ArgumentError(f"{what}: {name} is given twice")
        out[name] = value
    return out


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class Reading(Description):
    """How a table or a robot description is read."""

    convention: Literal["standard", "modified"] | None = None
    """Convention of a table file that does not say it."""

    units: str | None = None
    """Units of a table file that does not say them, such as mm,deg."""

    model: str | None = None
    """The UR that a calibration.conf belongs to, such as ur5e."""

    @property
    def told(self) -> Told:
        """What a table file is told."""
        return told(self.convention, self.units, model=self.model)


DEFAULT = Reading()
PLAIN = Description()


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class Writing(Reading):
    """What is written of a table; a file that does not say so itself is read so, too."""

    convention: Literal["standard", "modified"] | None = None
    """Convention to write; that of the file if it does not say its own. Default: the file's."""

    units: str | None = None
    """Units to write, such as mm,deg; those of the file if it says none. Default: the file's."""

    @property
    def told(self) -> Told:
        """What a table file is told that may say otherwise."""
        return told(self.convention, self.units, model=self.model, may_differ=True)

    def units_of(self, table: DHTable, format: str, given: Units | None) -> Units:
        """Units to write a table in, read from a file in the units given."""
        usual = Units("m", "deg") if format == "text" else usual_units(table, format, given)
        return Units(self.told.length or usual.length, self.told.angle or usual.angle)


AS_READ = Writing()
